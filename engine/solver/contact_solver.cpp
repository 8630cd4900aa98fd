#include "engine/solver/contact_solver.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/solver/one_contact.h"
#include "engine/solver/wide_products.h"

namespace engine {
namespace {

constexpr double kLeastResponse = 0.01;  // [-] of the free response of a contact's bodies
constexpr int kFirstSweeps = 1;          // before Newton is tried; twice as many before it is tried again, and so on
constexpr double kFirstGoal = 1e-3;      // [-] of the tolerance
constexpr int kPlainSweeps = 1000;       // before the friction bounds are followed
constexpr int kBoundedSweeps = 200;      // in each
constexpr int kBoundSteps = 40;          // of the fixed point on the friction bounds
constexpr int kMostSweeps = 2000;        // of all in one solve: what is not solved by then gets a shorter step instead
constexpr double kHeld = 1e9;            // [N s] a friction bound that nothing reaches
constexpr double kNearBound = 1e-2;      // [m/s] change of a step after which Newton on the whole is tried
constexpr double kTinyImpulse = 1e-14;   // [N s]

// Newton: steps in a row, and how many of them may find no new best. The first round keeps its matrix while no contact changes its
// kind. Redundant contacts leave impulses undetermined: a share of a row's own response is added, which falls with every step that
// succeeds. Chosen by the time that all solves of a person coming to rest (up to 17 contacts on 43 freedoms) take together.
constexpr int kQuickSteps = 8, kQuickPatience = 4;
constexpr int kNewtonSteps = 20, kPatience = 6;
constexpr double kRegularQuick = 1e-3;  // [-]
constexpr double kRegularFirst = 1e-2;  // [-]
constexpr double kRegularFalls = 0.3;
constexpr double kRegularLast = 1e-10;
constexpr double kRegularJammed = 1e-8;  // where impulses are large and well determined

}  // namespace

void ContactSolver::reserve(std::size_t constraints, std::size_t bodies) {
  const std::size_t rows = 3 * constraints;
  G_.reserve(rows * rows);
  newton_.reserve(rows);
  for (std::vector<Row>* list : {&rule_, &factored_rule_}) list->reserve(rows);
  L_start_.reserve(constraints);
  L_sliding_.reserve(constraints);
  Y_.reserve(bodies);
  for (std::vector<double>* list : {&u_, &L_, &u_kept_, &L_kept_, &u_start_, &u_sliding_, &bound_, &softened_}) list->reserve(rows);
  for (std::vector<int>* list : {&offset_, &unknown_}) list->reserve(rows);
  runs_.reserve(rows);
}

void ContactSolver::assemble(const Topology& topology, const Response& response, const std::vector<Constraint>& all,
                             const std::vector<int>& members) {
  const int count = static_cast<int>(members.size());
  offset_.resize(count);
  size_ = 0;
  for (int i = 0; i < count; ++i) {
    offset_[i] = size_;
    size_ += all[members[i]].rows;
  }
  G_.resize(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_));  // all of it is written
  u_.resize(size_);

  // bodies stand in the order in which the constraints name them: only those up to i are asked for
  const std::vector<int>& bodies = response.touched();
  std::size_t named = 0;
  auto name_until = [&](int body) {
    if (body < 0) return;
    const auto place = std::find(bodies.begin(), bodies.end(), body);
    named = std::max(named, static_cast<std::size_t>(place - bodies.begin()) + 1);
  };
  Y_.resize(topology.tree_of_body.size());
  for (int i = 0; i < count; ++i) {
    const Constraint& ci = all[members[i]];
    name_until(ci.body_a);
    name_until(ci.body_b);
    // Y_t = rows of i through the joints to body t, as columns
    for (std::size_t n = 0; n < named; ++n) {
      const int t = bodies[n];
      const int tree = topology.tree_of_body[t];
      const bool via_a = ci.body_a >= 0 && topology.tree_of_body[ci.body_a] == tree;
      const bool via_b = ci.body_b >= 0 && topology.tree_of_body[ci.body_b] == tree;
      if (via_a) Y_[t].noalias() = response.between(topology, t, ci.body_a) * ci.J_a.transpose();
      if (via_a && via_b) Y_[t].noalias() += response.between(topology, t, ci.body_b) * ci.J_b.transpose();
      if (!via_a && via_b) Y_[t].noalias() = response.between(topology, t, ci.body_b) * ci.J_b.transpose();
      if (!via_a && !via_b) Y_[t].setZero();
    }
    for (int k = 0; k <= i; ++k) {
      const Constraint& ck = all[members[k]];
      Mat3 g = Mat3::Zero();
      if (ck.body_a >= 0) g.noalias() += Y_[ck.body_a].transpose() * ck.J_a.transpose();
      if (ck.body_b >= 0) g.noalias() += Y_[ck.body_b].transpose() * ck.J_b.transpose();
      for (int r = 0; r < ci.rows; ++r)
        for (int q = 0; q < ck.rows; ++q) {
          G_[static_cast<std::size_t>(offset_[k] + q) * size_ + offset_[i] + r] = g(r, q);
          G_[static_cast<std::size_t>(offset_[i] + r) * size_ + offset_[k] + q] = g(r, q);
        }
    }
  }
  soften_dead_centres(all, members);
}

/// Two segments that press on each other along a chain of joints between them (chin on chest, through the neck) can stand at a dead
/// centre, where no joint lets the contact give way: its bodies would answer like thousands of kilograms and a slip of millimetres
/// a second would ask for the impulse of a crash. Such a contact yields a little: it answers no stiffer than a stated multiple of
/// its bodies' mass. Contacts that are not at a dead centre are not touched.
void ContactSolver::soften_dead_centres(const std::vector<Constraint>& all, const std::vector<int>& members) {
  softened_.assign(members.size(), 0.0);
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    if (c.kind != ConstraintKind::contact) continue;
    const double least = kLeastResponse * c.free_response;
    const Mat3 A = own_response(i, 3);
    // det/(product of the two larger) bounds the smallest eigenvalue cheaply; exact only when it matters
    const double trace = A.trace();
    if (A.determinant() > least * trace * trace) continue;
    // not the closed form of the roots: it is good to 1e-8 of the largest, which would come back as noise in the impulse
    const double smallest = Eigen::SelfAdjointEigenSolver<Mat3>(A, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (smallest >= least) continue;
    softened_[i] = least - smallest;
    for (int r = 0; r < 3; ++r) G_[static_cast<std::size_t>(offset_[i] + r) * static_cast<std::size_t>(size_ + 1)] += softened_[i];
  }
}

void ContactSolver::add_to_velocity(int column, int rows, const Vec3& change) {
  const auto size = static_cast<std::size_t>(size_);
  const double* g = G_.data() + static_cast<std::size_t>(column) * size;
  if (rows == 3) {
    add_three_columns(g, change.data(), u_.data(), size);
  } else {  // limits and closed loops
    for (std::size_t r = 0; r < size; ++r) u_[r] += g[r] * change[0];
  }
}

Mat3 ContactSolver::own_response(int member, int rows) const {
  Mat3 A = Mat3::Identity();
  for (int q = 0; q < rows; ++q)
    for (int r = 0; r < rows; ++r) A(r, q) = G(offset_[member] + r, offset_[member] + q);
  return A;
}

Vec3 ContactSolver::velocity(int member, int rows) const {
  Vec3 u = Vec3::Zero();
  for (int r = 0; r < rows; ++r) u[r] = u_[static_cast<std::size_t>(offset_[member] + r)];
  return u;
}

double ContactSolver::residual(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  double largest = 0;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    const double r = natural_residual(c, velocity(i, c.rows), own_response(i, c.rows), bounded_ ? bound_[i] : -1.0);
    if (!(r <= largest)) largest = r;  // what is not a number stays visible
  }
  return largest;
}

/// One Gauss-Seidel sweep; returns the largest change of velocity it made.
double ContactSolver::sweep(std::vector<Constraint>& all, const std::vector<int>& members) {
  double largest = 0;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    Constraint& c = all[members[i]];
    const Mat3 A = own_response(i, c.rows);
    const Vec3 u = velocity(i, c.rows);
    Vec3 next = Vec3::Zero();
    double scale = 1;
    switch (c.kind) {
      case ConstraintKind::contact: {
        if (bounded_) {
          next = solve_bounded_contact(A, u, c.target, c.softness, bound_[i], c.impulse);
          break;
        }
        Mat3 soft = A;
        soft(0, 0) += c.softness;
        next = solve_one_contact(soft, u - A * c.impulse, c.target, c.friction, c.impulse);
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
          scale = kLimitArm;
        }
        break;
      }
    }
    const Vec3 change = next - c.impulse;
    if (change.squaredNorm() == 0) continue;
    add_to_velocity(offset_[i], c.rows, change);
    c.impulse = next;
    largest = std::max(largest, scale * (A * change).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// The conditions at the present impulses as linear equations in their change; returns the number of unknowns.
int ContactSolver::linearise(const std::vector<Constraint>& all, const std::vector<int>& members) {
  unknown_.clear();
  rule_.clear();
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const Constraint& c = all[members[i]];
    const Mat3 A = own_response(i, c.rows);
    const Vec3 u = velocity(i, c.rows);
    const double miss = u[0] + c.softness * c.impulse[0] - c.target;
    const double active = c.impulse[0] - miss / (A(0, 0) + c.softness);
    if (c.kind != ConstraintKind::bilateral && active <= 0) {
      // opens: its impulse goes to zero with the others' knowledge
      for (int r = 0; r < c.rows; ++r)
        if (c.impulse[r] != 0) unknown_.push_back(offset_[i] + r), rule_.push_back({Row::let_go, i, r});
      continue;
    }
    unknown_.push_back(offset_[i]);
    rule_.push_back({Row::normal, i, 0});
    if (c.rows < 3) continue;
    Row::Kind kind = Row::stick;
    if (c.kind == ConstraintKind::wheel) {
      // brake or grip at its bound stays there for this step; the sweeps move it
      const double held = length_of(c.impulse[1], c.impulse[2]);
      if (held > 0.999999 * c.friction * c.impulse[0]) continue;
      if (std::abs(c.impulse[1] - c.rolling_drive) < 0.999999 * c.rolling_bound)
        unknown_.push_back(offset_[i] + 1), rule_.push_back({Row::stick, i, 1});
      unknown_.push_back(offset_[i] + 2), rule_.push_back({Row::stick, i, 2});
      continue;
    }
    const double rho = 1 / std::max(A(1, 1), A(2, 2));
    const Eigen::Vector2d wanted = c.impulse.tail<2>() - rho * u.tail<2>();
    const double most = bounded_ ? bound_[i] : c.friction * active;
    if (wanted.norm() > std::max(most, kTinyImpulse)) kind = Row::slip;
    for (int r = 1; r < 3; ++r) unknown_.push_back(offset_[i] + r), rule_.push_back({kind, i, r});
  }
  return static_cast<int>(unknown_.size());
}

/// The matrix of the conditions linearised; false if it has no inverse.
bool ContactSolver::factor_linearised(const std::vector<Constraint>& all, const std::vector<int>& members) {
  const int n = static_cast<int>(unknown_.size());
  factored_rule_.clear();
  newton_.resize(n);
  // neighbours among the rows are copied together
  runs_.clear();
  for (const int row : unknown_) {
    if (!runs_.empty() && row == runs_.back().first + runs_.back().length) {
      ++runs_.back().length;
    } else {
      runs_.push_back({row, 1});
    }
  }
  for (int m = 0; m < n; ++m) {
    const double* response = G_.data() + static_cast<std::size_t>(unknown_[m]) * static_cast<std::size_t>(size_);
    double* column = newton_.column(m);
    for (const Run& run : runs_) column = std::copy_n(response + run.first, run.length, column);
  }
  for (int k = 0; k < n; ++k) {
    const auto [kind, member, r] = rule_[k];
    const Constraint& c = all[members[member]];
    if (kind == Row::let_go) {
      for (int m = 0; m < n; ++m) newton_.A(k, m) = 0;
      newton_.A(k, k) = 1;
    } else if (kind != Row::slip) {
      newton_.A(k, k) += regular_ * G(unknown_[k], unknown_[k]) + (r == 0 ? c.softness : (r == 2 ? c.grip_softness : 0));
    } else if (r == 1) {
      // L_t - mu L_n x/|x| = 0 with x = L_t - rho u_t: its two rows, which stand together after that of the normal
      const Slip slip = slipping(c, member);
      for (int m = 0; m < n; ++m) {
        const Eigen::Vector2d u{newton_.A(k, m), newton_.A(k + 1, m)};
        const Eigen::Vector2d a = slip.rho * (slip.across * u);
        newton_.A(k, m) = a[0];
        newton_.A(k + 1, m) = a[1];
      }
      for (int q = 0; q < 2; ++q) {
        if (!bounded_) newton_.A(k + q, k - 1) -= c.friction * slip.direction[q];
        for (int p = 0; p < 2; ++p) newton_.A(k + q, k + p) += (p == q ? 1 : 0) - slip.across(q, p);
      }
    }
  }
  if (!newton_.factor()) return false;
  factored_rule_ = rule_;
  return true;
}

/// How a sliding contact's tangential impulse follows its slip.
ContactSolver::Slip ContactSolver::slipping(const Constraint& c, int member) const {
  const Mat3 A = own_response(member, 3);
  Slip slip;
  slip.rho = 1 / std::max(A(1, 1), A(2, 2));
  const Eigen::Vector2d x = c.impulse.tail<2>() - slip.rho * velocity(member, 3).tail<2>();
  const double length = x.norm();
  slip.direction = x / length;
  slip.most = bounded_ ? bound_[member] : c.friction * std::max(0.0, c.impulse[0]);
  slip.across = std::min(1.0, slip.most / length) * (Eigen::Matrix2d::Identity() - slip.direction * slip.direction.transpose());
  return slip;
}

/// Moves the impulses to the solution of the linearised conditions, with the last matrix while they are of the same kind and
/// `again` allows it; false if there is none.
bool ContactSolver::newton_step(std::vector<Constraint>& all, const std::vector<int>& members, bool again) {
  const int n = linearise(all, members);
  if (n == 0) return false;
  if (!(again && rule_ == factored_rule_) && !factor_linearised(all, members)) return false;
  for (int k = 0; k < n; ++k) {
    const auto [kind, member, r] = rule_[k];
    const Constraint& c = all[members[member]];
    const double u = u_[static_cast<std::size_t>(unknown_[k])];
    if (kind == Row::let_go) {
      newton_.b(k) = -c.impulse[r];
    } else if (kind != Row::slip) {
      newton_.b(k) = r == 0 ? c.target - u - c.softness * c.impulse[0] : -u - (r == 2 ? c.grip_softness * c.impulse[2] : 0);
    } else if (r == 1) {
      const Slip slip = slipping(c, member);
      for (int q = 0; q < 2; ++q) newton_.b(k + q) = slip.most * slip.direction[q] - c.impulse[1 + q];
    }
  }
  newton_.solve();

  L_.resize(static_cast<std::size_t>(size_));
  for (int i = 0; i < static_cast<int>(members.size()); ++i)
    for (int r = 0; r < all[members[i]].rows; ++r) L_[static_cast<std::size_t>(offset_[i] + r)] = all[members[i]].impulse[r];
  for (int k = 0; k < n; ++k) L_[static_cast<std::size_t>(unknown_[k])] += newton_.b(k);
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    Constraint& c = all[members[i]];
    Vec3 next = Vec3::Zero();
    for (int r = 0; r < c.rows; ++r) next[r] = L_[static_cast<std::size_t>(offset_[i] + r)];
    if (c.kind == ConstraintKind::contact && bounded_) next.tail<2>() = shortened(next.tail<2>(), bound_[i]);
    if (c.kind == ConstraintKind::contact && !bounded_) next = project_to_cone(next, c.friction);
    if (c.kind != ConstraintKind::bilateral) next[0] = std::max(0.0, next[0]);
    const Vec3 change = next - c.impulse;
    c.impulse = next;
    add_to_velocity(offset_[i], c.rows, change);
  }
  return true;
}

void ContactSolver::keep(const std::vector<Constraint>& all, const std::vector<int>& members) {
  u_kept_ = u_;
  L_kept_.resize(static_cast<std::size_t>(size_));
  for (int i = 0; i < static_cast<int>(members.size()); ++i)
    for (int r = 0; r < all[members[i]].rows; ++r) L_kept_[static_cast<std::size_t>(offset_[i] + r)] = all[members[i]].impulse[r];
}

void ContactSolver::go_back(std::vector<Constraint>& all, const std::vector<int>& members) {
  u_ = u_kept_;
  for (int i = 0; i < static_cast<int>(members.size()); ++i)
    for (int r = 0; r < all[members[i]].rows; ++r) all[members[i]].impulse[r] = L_kept_[static_cast<std::size_t>(offset_[i] + r)];
}

/// Newton steps at full length: the set of open, sticking and slipping contacts settles on the way, so the residual may rise for a
/// while; the best of them is kept.
void ContactSolver::newton(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, Care care,
                           SolveReport& report) {
  keep(all, members);
  double best = report.residual;
  bool at_best = true;
  int worse = 0;
  const bool quick = care == Care::none;
  regular_ = quick ? kRegularQuick : care == Care::redundant ? kRegularFirst : kRegularJammed;
  factored_rule_.clear();
  for (int k = 0; k < (quick ? kQuickSteps : kNewtonSteps) && report.residual > tolerance; ++k) {
    ++report.newton_steps;
    if (!newton_step(all, members, quick)) break;
    if (care == Care::redundant) {
      sweep(all, members);  // contacts on the edge between sticking and slipping, where Newton alone goes to and fro
      ++report.sweeps;
    }
    report.residual = residual(all, members);
    at_best = report.residual < best;
    if (!std::isfinite(report.residual)) break;
    if (!quick) regular_ = std::max(kRegularLast, (at_best ? kRegularFalls : 1.0) * regular_);
    if (!at_best && ++worse == (quick ? kQuickPatience : kPatience)) break;
    if (!at_best) continue;
    best = report.residual;
    keep(all, members);
  }
  if (!at_best) go_back(all, members);
  report.residual = best;
}

/// Sweeps and Newton in turns; stops at the tolerance or after the sweeps given.
void ContactSolver::iterate(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, int sweeps,
                            SolveReport& report) {
  const int last = report.sweeps + sweeps;
  int round = kFirstSweeps;
  Care care = Care::none;
  // the first rounds ask for more than the tolerance: Newton gives it for a step or two, and resting bodies creep by what is left
  double goal = kFirstGoal * tolerance;
  while (report.residual > goal && report.sweeps < last) {
    double change = 0;
    for (int k = 0; k < round; ++k) {
      ++report.sweeps;
      change = sweep(all, members);
      if (change < 0.1 * goal) break;
    }
    report.residual = residual(all, members);
    if (report.residual > goal) newton(all, members, goal, care, report);
    if (change == 0) break;
    if (care == Care::none) {
      if (report.residual <= tolerance) return;
      care = Care::redundant;
      continue;
    }
    // redundant or jammed: the two ask for different care, and one cannot tell before
    care = care == Care::redundant ? Care::jammed : Care::redundant;
    round *= 2;
    goal = tolerance;
  }
}

/// Fixed point on the friction bounds (Haslinger 1983): with every bound held the conditions are those of a convex problem, which
/// sweeps and Newton always solve; then the bounds follow the normal impulses found. Where friction jams a chain of limits
/// (Painleve's rod) the bounds climb from the sliding solution that no longer holds to the one that does. Where a limb is wedged
/// between two vehicles, or between one and the ground, the climb does not end; from above, where all are held, it comes down to
/// the solution that holds the wedge.
void ContactSolver::follow_bounds(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance, Bounds from,
                                  SolveReport& report) {
  const std::size_t count = members.size();
  bound_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    bound_[i] = from == Bounds::held ? kHeld : all[members[i]].friction * all[members[i]].impulse[0];
  double share = 1, last = std::numeric_limits<double>::infinity();
  const int last_sweep = report.sweeps + kMostSweeps;
  for (int k = 0; k < kBoundSteps && report.sweeps < last_sweep; ++k) {
    bounded_ = true;
    report.residual = residual(all, members);
    iterate(all, members, 0.1 * tolerance, kBoundedSweeps, report);
    bounded_ = false;
    double change = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Constraint& c = all[members[i]];
      if (c.kind != ConstraintKind::contact) continue;
      const double difference = c.friction * c.impulse[0] - bound_[i];
      change = std::max(change, std::abs(difference) * G(offset_[i] + 1, offset_[i] + 1));
      bound_[i] += share * difference;
    }
    report.residual = residual(all, members);
    if (report.residual <= tolerance) return;
    if (change < kNearBound || k % 4 == 3) {
      newton(all, members, tolerance, Care::jammed, report);
      if (report.residual <= tolerance) return;
    }
    if (change > 0.9 * last) share = std::max(0.25, 0.7 * share);
    last = change;
  }
}

SolveReport ContactSolver::solve(std::vector<Constraint>& all, const std::vector<int>& members, double tolerance) {
  const int count = static_cast<int>(members.size());
  for (int i = 0; i < count; ++i)
    for (int r = 0; r < all[members[i]].rows; ++r) u_[static_cast<std::size_t>(offset_[i] + r)] = all[members[i]].u_free[r];
  for (int i = 0; i < count; ++i) add_to_velocity(offset_[i], all[members[i]].rows, all[members[i]].impulse);

  SolveReport report;
  report.residual = residual(all, members);
  u_start_ = u_;
  L_start_.clear();
  for (const int m : members) L_start_.push_back(all[m].impulse);
  iterate(all, members, tolerance, kPlainSweeps, report);
  auto begin_again = [&] {  // where the sweeps went may be far off
    u_ = u_start_;
    for (int i = 0; i < count; ++i) all[members[i]].impulse = L_start_[i];
  };
  if (!(report.residual <= tolerance)) {
    begin_again();
    follow_bounds(all, members, tolerance, Bounds::sliding, report);
  }
  if (!(report.residual <= tolerance)) {
    const double sliding = report.residual;
    u_sliding_ = u_;
    L_sliding_.clear();
    for (const int m : members) L_sliding_.push_back(all[m].impulse);
    begin_again();
    follow_bounds(all, members, tolerance, Bounds::held, report);
    if (!(report.residual < sliding)) {
      report.residual = sliding;
      u_ = u_sliding_;
      for (int i = 0; i < count; ++i) all[members[i]].impulse = L_sliding_[i];
    }
  }
  for (int i = 0; i < count; ++i) {
    Constraint& c = all[members[i]];
    c.u_after = velocity(i, c.rows) - softened_[i] * c.impulse;  // what the bodies do, as the books have it
  }
  return report;
}

void ContactSolver::push_apart(std::vector<Constraint>& all, const std::vector<int>& members, const std::vector<double>& wanted) {
  constexpr int kSweeps = 60;
  constexpr double kTight = 1e-14;  // [m], [rad] a looser bound is met by chance in one run and missed in its neighbour
  const int count = static_cast<int>(members.size());
  for (int k = 0; k < kSweeps; ++k) {
    double largest = 0;
    for (int i = 0; i < count; ++i) {
      Constraint& c = all[members[i]];
      if (!std::isfinite(wanted[i])) continue;
      double moved = 0;
      for (int j = 0; j < count; ++j)
        if (all[members[j]].push != 0) moved += G(offset_[i], offset_[j]) * all[members[j]].push;
      const double own = G(offset_[i], offset_[i]);
      const double next = std::max(0.0, c.push + (wanted[i] - moved) / own);
      largest = std::max(largest, own * std::abs(next - c.push));
      c.push = next;
    }
    if (largest < kTight) return;
  }
}

double ContactSolver::kinetic_energy_change(const std::vector<Constraint>& all, const std::vector<int>& members) const {
  double change = 0;
  for (const int m : members) {
    const Constraint& c = all[m];
    for (int r = 0; r < c.rows; ++r) change += c.impulse[r] * 0.5 * (c.u_after[r] + c.u_free[r]);
  }
  return change;
}

}  // namespace engine
