#include "engine/solver/contact_solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "engine/solver/one_contact.h"

namespace engine {
namespace {

constexpr double kLeastResponse = 0.003;          // [-] of the free response of a contact's bodies
constexpr int kFirstSweeps = 1;                   // before Newton is tried; twice as many before it is tried again, and so on
constexpr int kSweepsAfter = 20;                  // a quick round of Newton that has not helped
constexpr int kSweepsFirst = 100;                 // where Newton has not helped for long
constexpr int kManyRows = 64;                     // of an island: with fewer a step of Newton's costs no more than a few sweeps
constexpr double kFirstGoal = 1e-3;               // [-] of the tolerance
constexpr int kPlainSweeps = 50;                  // before the conditions are smoothed
constexpr double kSharper[] = {0.8, 0.95, 0.99};  // [-] from step to step there: slowly where it fails quickly
constexpr int kLastSweeps = 100;                  // of what is left then

}  // namespace

void ContactSolver::reserve(const Topology& topology, std::size_t constraints) {
  response_.reset(topology, constraints);
  const std::size_t rows = whole_rows(3 * constraints);
  G_.reserve(rows * rows);
  newton_.reserve(rows);
  elimination_.reserve(topology.trees.size(), constraints);
  for (std::vector<Row>* list : {&rule_, &factored_rule_}) list->reserve(rows);
  slips_.reserve(constraints);
  for (std::vector<Vec3>* list : {&L_start_, &L_nothing_, &L_best_}) list->reserve(constraints);
  own_.reserve(constraints);
  for (std::vector<double>* list : {&L_, &L_kept_, &softened_, &L_along_, &u_along_}) list->reserve(rows);
  for (Answer& answer : answers_) answer.rows.reserve(rows);
  for (AlignedVector* list : {&u_, &u_kept_}) list->reserve(rows);
  for (std::vector<int>* list : {&assembled_, &offset_, &unknown_, &opens_, &met_picks_}) list->reserve(rows);
  picks_.reserve(rows);
}

void ContactSolver::assemble(const Topology& topology, const Articulation& articulation, const std::vector<Constraint>& all,
                             const std::vector<int>& members, const std::vector<char>* anew) {
  const int count = static_cast<int>(members.size());
  const bool known = anew && members == assembled_;
  assembled_ = members;
  offset_.resize(count);
  size_ = 0;
  for (int i = 0; i < count; ++i) {
    offset_[i] = size_;
    size_ += all[members[i]].rows;
  }
  stride_ = whole_rows(static_cast<std::size_t>(size_));
  // all of it is written; never smaller: growing again would write zeros for nothing
  if (const std::size_t room = stride_ * static_cast<std::size_t>(size_); G_.size() < room) G_.resize(room);
  u_.assign(stride_, 0.0);
  if (known) {
    const Response::Changed since{*anew, softened_};
    response_.compute(topology, articulation, all, members, offset_, stride_, G_, &since);
  } else {
    response_.compute(topology, articulation, all, members, offset_, stride_, G_);
  }
  note_own_responses(all, members);
  soften_dead_centres(all, members);
  elimination_.find(topology, all, members);
}

void ContactSolver::note_own_responses(const std::vector<Constraint>& all, const std::vector<int>& members) {
  own_.assign(members.size(), Mat3::Identity());
  for (std::size_t i = 0; i < members.size(); ++i)
    for (int q = 0; q < all[members[i]].rows; ++q)
      for (int r = 0; r < all[members[i]].rows; ++r) own_[i](r, q) = G(offset_[i] + r, offset_[i] + q);
}

/// Two segments that press on each other along a chain of joints between them (chin on chest, through the neck) can stand at a dead
/// centre, where no joint lets the contact give way: its bodies would answer like thousands of kilograms and a slip of millimetres
/// a second would ask for the impulse of a crash. Such a contact yields a little: it answers no stiffer than a stated multiple of
/// its bodies' mass, or than all that hangs on them moving as one, which a light foot under a heavy body does. Contacts that are
/// not at a dead centre are not touched. More than a little is too much: at a hundredth of the free response a wheel pressed a
/// trunk 9.6 mm into a forearm, which could only roll out of the way.
void ContactSolver::soften_dead_centres(const std::vector<Constraint>& all, const std::vector<int>& members) {
  softened_.assign(members.size(), 0.0);
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    if (c.kind != ConstraintKind::contact) continue;
    const double least = std::min(kLeastResponse * c.response.free, c.response.whole);
    const Mat3& A = own_[i];
    // det/(product of the two larger) bounds the smallest eigenvalue cheaply; exact only when it matters
    const double trace = A.trace();
    if (A.determinant() > least * trace * trace) continue;
    // not the closed form of the roots: it is good to 1e-8 of the largest, which would come back as noise in the impulse
    const double smallest = Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (smallest >= least) continue;
    softened_[i] = least - smallest;
    for (int r = 0; r < 3; ++r) own_[i](r, r) = G_[static_cast<std::size_t>(offset_[i] + r) * (stride_ + 1)] += softened_[i];
  }
}

void ContactSolver::add_to_velocity(int member, int rows, const Vec3& change) {
  const Rows reach = response_.reach(static_cast<std::size_t>(member));
  const double* g = G_.data() + static_cast<std::size_t>(offset_[member]) * stride_;
  if (rows == 3) {
    add_three_columns(g + reach.begin, stride_, change.data(), u_.data() + reach.begin, reach.end - reach.begin);
  } else {  // limits and closed loops
    for (std::size_t r = reach.begin; r < reach.end; ++r) u_[r] += g[r] * change[0];
  }
}

Vec3 ContactSolver::velocity(int member, int rows) const {
  Vec3 u = Vec3::Zero();
  for (int r = 0; r < rows; ++r) u[r] = u_[static_cast<std::size_t>(offset_[member] + r)];
  return u;
}

ContactSolver::Miss ContactSolver::largest_miss(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  Miss largest;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    const double r = natural_residual(c, velocity(i, c.rows), own_[i]);
    if (!(r <= largest.residual)) largest = {r, members[i]};
    if (!std::isfinite(r)) break;  // what is not a number stays visible
  }
  return largest;
}

double ContactSolver::residual(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  return largest_miss(all, members).residual;
}

/// One Gauss-Seidel sweep; returns the largest change of velocity it made.
double ContactSolver::sweep(std::vector<Constraint>& all, const std::vector<int>& members) {
  double largest = 0;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    Constraint& c = all[members[i]];
    const Mat3& A = own_[i];
    const Vec3 u = velocity(i, c.rows);
    Vec3 next = Vec3::Zero();
    double scale = 1;
    switch (c.kind) {
      case ConstraintKind::contact: {
        Mat3 soft = A;
        soft(0, 0) += c.softness;
        next = solve_one_contact(soft, u - A * c.impulse, c.target, c.surface.friction, c.impulse);
        break;
      }
      case ConstraintKind::wheel:
        next = solve_wheel(A, u, c.impulse, c);
        break;
      case ConstraintKind::limit:
      case ConstraintKind::bilateral: {
        next[0] = c.impulse[0] + (c.target - u[0] - c.softness * c.impulse[0]) / (A(0, 0) + c.softness);
        if (c.kind == ConstraintKind::limit) {
          next[0] = std::max(0.0, next[0]);
          scale = c.slides ? 1 : kLimitArm;
        }
        break;
      }
    }
    const Vec3 change = next - c.impulse;
    if (change.squaredNorm() == 0) continue;
    add_to_velocity(i, c.rows, change);
    c.impulse = next;
    largest = std::max(largest, scale * (A * change).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// Sweeps and Newton in turns; stops at the tolerance or after the sweeps given.
void ContactSolver::iterate(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, int sweeps,
                            SolveReport& report) {
  const int last = report.sweeps + sweeps;
  int round = kFirstSweeps;
  Care care = Care::none;
  // the first rounds ask for more than the tolerance: Newton gives it for a step or two, and resting bodies creep by what is left
  Aim aim{kFirstGoal * tolerance, tolerance};
  while (report.residual > aim.wanted && report.sweeps < last) {
    double change = 0;
    for (int k = 0; k < round; ++k) {
      ++report.sweeps;
      change = sweep(all, members);
      if (change < 0.1 * aim.wanted) break;
    }
    report.residual = residual(all, members);
    const bool closing_in = report.residual <= aim.wanted || newton(all, members, aim, care, report);
    if (change == 0) break;
    if (care == Care::none) {
      if (report.residual > tolerance && !closing_in) sweep_on(all, members, aim, kSweepsAfter, report);
      if (report.residual <= tolerance) return;
      care = Care::redundant;
      continue;
    }
    // redundant or jammed: the two ask for different care, and one cannot tell before
    care = care == Care::redundant ? Care::jammed : Care::redundant;
    round = std::min(2 * round, sweeps);  // a round that ends early doubles it too: one went on for minutes
    aim.wanted = tolerance;
  }
}

/// The velocities that the impulses given leave.
void ContactSolver::begin(std::vector<Constraint>& all, const std::vector<int>& members, const std::vector<Vec3>& impulses) {
  const int count = static_cast<int>(members.size());
  for (int i = 0; i < count; ++i) {
    const Constraint& c = all[members[i]];
    for (int r = 0; r < c.rows; ++r) u_[static_cast<std::size_t>(offset_[i] + r)] = c.u.free[r];
  }
  for (int i = 0; i < count; ++i) {
    all[members[i]].impulse = impulses[i];
    add_to_velocity(i, all[members[i]].rows, impulses[i]);
  }
}

void ContactSolver::note_best(const std::vector<Constraint>& all, const std::vector<int>& members) {
  L_best_.clear();
  for (const int m : members) L_best_.push_back(all[m].impulse);
}

/// For an island that goes round in circles: from nothing, then from the impulses it began with, if any. The best of all is taken.
void ContactSolver::solve_smoothed(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance,
                                   SolveReport& report) {
  double best = report.residual;
  note_best(all, members);
  const auto note_if_best = [&] {
    if (report.residual < best) best = report.residual, note_best(all, members);
  };
  L_nothing_.assign(members.size(), Vec3::Zero());
  for (const double sharper : kSharper)
    for (const std::vector<Vec3>* from : {&L_nothing_, &L_start_}) {
      if (best <= tolerance || (from == &L_start_ && L_start_ == L_nothing_)) continue;
      begin(all, members, *from);
      follow_smoothing(all, members, tolerance, sharper, report);
      note_if_best();
      iterate(all, members, tolerance, kLastSweeps, report);
      note_if_best();
    }
  begin(all, members, L_best_);
  report.residual = best;
}

SolveReport ContactSolver::solve(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, Begin by) {
  const int count = static_cast<int>(members.size());
  L_start_.clear();
  for (const int m : members) L_start_.push_back(all[m].impulse);
  SolveReport report;
  begin(all, members, L_start_);
  report.residual = residual(all, members);
  const bool sweeps_first = by == Begin::sweeps && size_ >= kManyRows;
  if (sweeps_first) sweep_on(all, members, {kFirstGoal * tolerance, tolerance}, kSweepsFirst, report);
  if (!(sweeps_first && report.residual <= tolerance)) iterate(all, members, tolerance, kPlainSweeps, report);
  if (!(report.residual <= tolerance)) solve_smoothed(all, members, tolerance, report);
  if (!(report.residual <= tolerance)) report.worst = largest_miss(all, members).constraint;
  for (int i = 0; i < count; ++i) {
    Constraint& c = all[members[i]];
    c.u.after = velocity(i, c.rows) - softened_[i] * c.impulse;  // what the bodies do, as the books have it
  }
  return report;
}

/// push_apart where sweeps creep, as at a foot between a car, the road and its own stop. From whom they push: those pushes are
/// solved at once, who would be pulled leaves, who is in too deep joins. False, and nothing changed, where that comes to no end.
bool ContactSolver::push_who_must(std::vector<Constraint>& all, const std::vector<int>& members, const std::vector<double>& wanted,
                                  double tight) {
  constexpr int kMost = 30;
  constexpr double kRegular = 1e-10;  // [-] of a row's own response, where several hold the same
  constexpr double kJoins = 1e-9;     // [-] of the most wanted: more than that leaves
  constexpr double kLargest = 1e5;    // [-] times what the most wanted would need by itself: what nothing can lift
  const int count = static_cast<int>(members.size());
  const double most_wanted = *std::max_element(wanted.begin(), wanted.end());
  const double most = kLargest * most_wanted, joins = std::max(tight, kJoins * most_wanted);
  std::vector<int>& pushed = unknown_;
  pushed.clear();
  for (int i = 0; i < count; ++i)
    if (all[members[i]].push > 0) pushed.push_back(i);
  for (int k = 0; k < kMost; ++k) {
    const int n = static_cast<int>(pushed.size());
    newton_.resize(n);
    for (int c = 0; c < n; ++c) {
      for (int r = 0; r < n; ++r) newton_.A(r, c) = G(offset_[pushed[r]], offset_[pushed[c]]);
      newton_.A(c, c) *= 1 + kRegular;
      newton_.b(c) = wanted[pushed[c]];
    }
    if (!newton_.factor()) return false;
    newton_.solve();
    L_.assign(static_cast<std::size_t>(count), 0);
    bool settled = true;
    for (int c = 0; c < n; ++c) {
      const double push = newton_.b(c);
      if (!(G(offset_[pushed[c]], offset_[pushed[c]]) * push < most)) return false;
      if (push < 0) settled = false;
      L_[static_cast<std::size_t>(pushed[c])] = std::max(0.0, push);
    }
    pushed.clear();
    for (int i = 0; i < count; ++i) {
      if (L_[i] > 0) {
        pushed.push_back(i);
        continue;
      }
      if (!std::isfinite(wanted[i])) continue;
      double moved = 0;
      for (int j = 0; j < count; ++j) moved += G(offset_[i], offset_[j]) * L_[j];
      if (wanted[i] - moved > joins) settled = false, pushed.push_back(i);
    }
    if (!settled) continue;
    for (int i = 0; i < count; ++i) all[members[i]].push = L_[i];
    return true;
  }
  return false;
}

void ContactSolver::push_apart(std::vector<Constraint>& all, const std::vector<int>& members, const std::vector<double>& wanted) {
  constexpr int kSweeps = 60;
  constexpr double kTight = 1e-14;  // [m], [rad] a looser bound is met by chance in one run and missed in its neighbour
  constexpr double kMissed = 1e-6;  // [m], [rad] a last sweep that moves more has not come near the answer
  const int count = static_cast<int>(members.size());
  const auto sweep = [&](bool vehicles) {
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      Constraint& c = all[members[i]];
      if (!std::isfinite(wanted[i]) || (!vehicles && is_contact(c) && c.shapes.between_vehicles())) continue;
      double moved = 0;
      for (int j = 0; j < count; ++j)
        if (all[members[j]].push != 0) moved += G(offset_[i], offset_[j]) * all[members[j]].push;
      const double own = G(offset_[i], offset_[i]);
      const double next = std::max(0.0, c.push + (wanted[i] - moved) / own);
      largest = std::max(largest, own * std::abs(next - c.push));
      c.push = next;
    }
    return largest;
  };
  double last = 1;
  for (int k = 0; k < kSweeps && last > kTight; ++k) last = sweep(true);
  if (last <= kTight || push_who_must(all, members, wanted, kTight) || last <= kMissed) return;
  // something light between a vehicle and the ground, which sweeps do not lift the vehicle off: vehicles in each other can wait
  for (const int m : members) all[m].push = 0;
  for (int k = 0; k < kSweeps && sweep(false) > kTight; ++k) {
  }
}

double ContactSolver::kinetic_energy_change(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  double change = 0;
  for (const int m : members) {
    const Constraint& c = all[m];
    for (int r = 0; r < c.rows; ++r) change += c.impulse[r] * 0.5 * (c.u.after[r] + c.u.free[r]);
  }
  return change;
}

}  // namespace engine
