// Newton on all contacts, limits and wheels of an island at once (semi-smooth, after Alart and Curnier 1991).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "engine/solver/contact_solver.h"
#include "engine/solver/one_contact.h"

namespace engine {
namespace {

constexpr double kTinyImpulse = 1e-14;  // [N s]

// Newton: steps in a row, and how many of them may find no new best. The first round keeps its matrix while no contact changes its
// kind and the residual falls fast: the directions of slip turn. Redundant contacts leave impulses undetermined: a share of a row's
// own response is added, which falls with every step that succeeds. Chosen by the time that all solves of a person coming to rest
// (up to 17 contacts on 43 freedoms) take together.
constexpr int kQuickSteps = 8, kQuickPatience = 4;
constexpr double kFalls = 0.3;       // [-]
constexpr double kNearEnough = 0.1;  // [-] of the tolerance: from there a step that leads away is the last
constexpr int kNewtonSteps = 20, kPatience = 6;
constexpr double kRegularQuick = 1e-3;  // [-]
constexpr double kRegularFirst = 1e-2;  // [-]
constexpr double kRegularFalls = 0.3;
constexpr double kRegularLast = 1e-10;
constexpr double kRegularJammed = 1e-8;  // where impulses are large and well determined

/// [1/kg] by which a row that does not slide gives way.
double softness_of(const Constraint& c, int row) {
  return row == 0 ? c.softness : row == 2 ? c.wheel.grip_softness : 0;
}

}  // namespace

/// L_t = mu L_n x/|x| with x = L_t - rho u_t, made linear about the present x. Along x: L_t is mu L_n. Across it:
/// (1 - t) L_t + t rho u_t = 0 with t = mu L_n/|x|, at most 1. So two unknowns are left, L_n with the friction it drags along and
/// L_t across.
ContactSolver::Slip ContactSolver::slipping(const Constraint& c, double rho, const Eigen::Vector2d& x) {
  const double length = x.norm();
  Slip slip;
  slip.along = x / length;
  slip.across = {-slip.along[1], slip.along[0]};
  slip.most = c.surface.friction * std::max(0.0, c.impulse[0]);
  slip.by_velocity = std::min(1.0, slip.most / length);
  slip.by_impulse = (1 - slip.by_velocity) / rho;
  return slip;
}

/// The conditions at the present impulses as linear equations in their change; returns the number of unknowns.
int ContactSolver::linearise(const std::vector<Constraint>& all, const std::vector<int>& members) {
  unknown_.clear();
  rule_.clear();
  opens_.clear();
  slips_.resize(members.size());
  for (const int i : elimination_.order()) {
    const Constraint& c = all[members[i]];
    const Mat3& A = own_[i];
    const Vec3 u = velocity(i, c.rows);
    const double miss = u[0] + c.softness * c.impulse[0] - c.target;
    const double active = c.impulse[0] - miss / (A(0, 0) + c.softness);
    if (c.kind != ConstraintKind::bilateral && active <= 0) {
      if (c.impulse != Vec3::Zero()) opens_.push_back(i);
      continue;
    }
    unknown_.push_back(offset_[i]);
    rule_.push_back({Row::normal, i, 0});
    if (c.rows < 3) continue;
    if (c.kind == ConstraintKind::wheel) {
      // brake or grip at its bound stays there for this step; the sweeps move it
      const double held = length_of(c.impulse[1], c.impulse[2]);
      if (held > 0.999999 * c.surface.friction * c.impulse[0]) continue;
      if (std::abs(c.impulse[1] - c.wheel.driving) < 0.999999 * c.wheel.braking)
        unknown_.push_back(offset_[i] + 1), rule_.push_back({Row::stick, i, 1});
      unknown_.push_back(offset_[i] + 2), rule_.push_back({Row::stick, i, 2});
      continue;
    }
    const double rho = 1 / std::max(A(1, 1), A(2, 2));
    const Eigen::Vector2d wanted = c.impulse.tail<2>() - rho * u.tail<2>();
    const double most = c.surface.friction * active;
    if (wanted.norm() > std::max(most, kTinyImpulse)) {
      rule_.back().kind = Row::sliding;
      unknown_.push_back(offset_[i] + 1), rule_.push_back({Row::across, i, 1});
      slips_[static_cast<std::size_t>(i)] = slipping(c, rho, wanted);
    } else {
      for (int r = 1; r < 3; ++r) unknown_.push_back(offset_[i] + r), rule_.push_back({Row::stick, i, r});
    }
  }
  return static_cast<int>(unknown_.size());
}

/// Which rows of a column of G the unknowns ask for: neighbours of the same trees are copied together, and who slides asks across
/// its slip.
void ContactSolver::choose_rows() {
  picks_.clear();
  for (int k = 0; k < static_cast<int>(unknown_.size()); ++k) {
    const int row = unknown_[k], member = rule_[k].member;
    const std::uint64_t trees = elimination_.trees(member);
    if (rule_[k].kind == Row::across) {
      const Slip& slip = slips_[static_cast<std::size_t>(member)];
      picks_.push_back({row, 0, k, trees, slip.by_velocity * slip.across});
    } else if (!picks_.empty() && picks_.back().length > 0 && row == picks_.back().first + picks_.back().length &&
               trees == picks_.back().trees) {
      ++picks_.back().length;
    } else {
      picks_.push_back({row, 1, k, trees, {}});
    }
  }
}

/// Of the rows that the unknowns ask for, those of conditions that share one of these trees: few in a heap. The others are zero.
void ContactSolver::leave_zeros_out(std::uint64_t trees) {
  met_picks_.resize(picks_.size());
  std::size_t met = 0;
  for (std::size_t k = 0; k < picks_.size(); ++k) {  // without a branch, which nobody could foretell
    met_picks_[met] = static_cast<int>(k);
    met += (picks_[k].trees & trees) != 0;
  }
  met_picks_.resize(met);
}

/// Of two columns at once: what decides how rows are taken is asked half as often. A heap of ten takes 4 % less time.
void ContactSolver::pick(const std::array<const double*, 2>& from, const std::array<double*, 2>& to) const {
  const double *a = from[0], *b = from[1];
  double *x = to[0], *y = to[1];
  int at = 0;
  const auto fill = [&](int end) {
    for (; at < end; ++at) x[at] = y[at] = 0;
  };
  for (const int k : met_picks_) {
    const Pick& pick = picks_[static_cast<std::size_t>(k)];
    fill(pick.at);
    const double *p = a + pick.first, *q = b + pick.first;
    if (pick.length == 0) {
      x[at] = pick.weights[0] * p[0] + pick.weights[1] * p[1];
      y[at++] = pick.weights[0] * q[0] + pick.weights[1] * q[1];
      continue;
    }
    // by fours: a library's call to copy takes longer
    const auto take = [&](auto count) {
      std::memcpy(x + at, p, count * sizeof(double)), p += count;
      std::memcpy(y + at, q, count * sizeof(double)), q += count;
      at += static_cast<int>(count);
    };
    int left = pick.length;
    for (; left >= 4; left -= 4) take(std::integral_constant<std::size_t, 4>());
    if (left & 2) take(std::integral_constant<std::size_t, 2>());
    if (left & 1) take(std::integral_constant<std::size_t, 1>());
  }
  fill(static_cast<int>(unknown_.size()));
}

/// How all velocities answer an unknown of a contact that slides.
const double* ContactSolver::answer_of_slip(const Constraint& c, const Row& row, Answer& answer) {
  const Slip& slip = slips_[static_cast<std::size_t>(row.member)];
  Vec3 unit(0, slip.across[0], slip.across[1]);
  if (row.kind == Row::sliding) unit << 1, c.surface.friction * slip.along;
  const Rows reach = response_.reach(static_cast<std::size_t>(row.member));
  const double* g = G_.data() + static_cast<std::size_t>(offset_[row.member]) * stride_;
  if (answer.rows.size() != stride_) answer.rows.assign(stride_, 0.0), answer.reach = {};
  std::fill(answer.rows.data() + answer.reach.begin, answer.rows.data() + answer.reach.end, 0.0);
  answer.reach = reach;
  add_three_columns(g + reach.begin, stride_, unit.data(), answer.rows.data() + reach.begin, reach.end - reach.begin);
  return answer.rows.data();
}

/// The matrix of the conditions linearised.
void ContactSolver::write_linearised(const std::vector<Constraint>& all, const std::vector<int>& members) {
  const auto answer_of = [&](int k) {
    const Row& row = rule_[static_cast<std::size_t>(k)];
    const bool slides = row.kind == Row::sliding || row.kind == Row::across;
    return slides ? answer_of_slip(all[members[row.member]], row, answers_[static_cast<std::size_t>(k % 2)])
                  : G_.data() + static_cast<std::size_t>(unknown_[k]) * stride_;
  };
  const auto trees_of = [this](int k) { return elimination_.trees(rule_[static_cast<std::size_t>(k)].member); };
  const int n = static_cast<int>(unknown_.size());
  std::uint64_t met = 0;
  for (int k = 0; k < n; k += 2) {
    const int next = std::min(k + 1, n - 1);  // the last may be written twice
    if (const std::uint64_t trees = trees_of(k) | trees_of(next); trees != met) leave_zeros_out(trees), met = trees;
    const double* from = answer_of(k);
    pick({from, next > k ? answer_of(next) : from}, {newton_.column(k), newton_.column(next)});
  }
  for (int k = 0; k < n; ++k) {
    const Row& row = rule_[k];
    if (row.kind == Row::across) {
      newton_.A(k, k) += slips_[static_cast<std::size_t>(row.member)].by_impulse;
    } else {
      newton_.A(k, k) += regular_ * G(unknown_[k], unknown_[k]) + softness_of(all[members[row.member]], row.r);
    }
  }
}

/// Factorises that matrix; false if it has no inverse.
bool ContactSolver::factor_linearised(const std::vector<Constraint>& all, const std::vector<int>& members) {
  factored_rule_.clear();
  newton_.resize(static_cast<int>(unknown_.size()));
  choose_rows();
  write_linearised(all, members);
  // answers to impulses with such a share added are positive definite; friction that slips is seldom enough to change that
  const bool in_order = regular_ >= kRegularQuick;
  if (!(in_order && newton_.factor_in_order())) {
    if (in_order) write_linearised(all, members);
    if (!newton_.factor()) return false;
  }
  factored_rule_ = rule_;
  return true;
}

/// What is known before the system is solved: who opens lets go, who slides has all that its normal impulse bears along x.
void ContactSolver::take_known(std::vector<Constraint>& all, const std::vector<int>& members) {
  const auto change = [&](int i, const Vec3& by) {
    Constraint& c = all[members[i]];
    c.impulse += by;
    if (by != Vec3::Zero()) add_to_velocity(i, c.rows, by);
  };
  for (const int i : opens_) change(i, -all[members[i]].impulse);
  for (const Row& row : rule_) {
    if (row.kind != Row::sliding) continue;
    const Slip& slip = slips_[static_cast<std::size_t>(row.member)];
    const double missing = slip.most - slip.along.dot(all[members[row.member]].impulse.tail<2>());
    change(row.member, {0, missing * slip.along[0], missing * slip.along[1]});
  }
}

/// Moves the impulses to the solution of the linearised conditions, with the last matrix while they are of the same kind and
/// `again` allows it; false if there is none.
bool ContactSolver::newton_step(std::vector<Constraint>& all, const std::vector<int>& members, bool again) {
  const int n = linearise(all, members);
  if (n == 0 && opens_.empty()) return false;
  if (!(again && rule_ == factored_rule_) && !factor_linearised(all, members)) return false;
  take_known(all, members);
  for (int k = 0; k < n; ++k) {
    const auto [kind, member, r] = rule_[k];
    const Constraint& c = all[members[member]];
    const double* u = u_.data() + unknown_[k];
    if (kind == Row::across) {
      const Slip& slip = slips_[static_cast<std::size_t>(member)];
      const double u_across = slip.across[0] * u[0] + slip.across[1] * u[1];
      newton_.b(k) = -slip.by_impulse * slip.across.dot(c.impulse.tail<2>()) - slip.by_velocity * u_across;
    } else {
      newton_.b(k) = (r == 0 ? c.target : 0) - u[0] - softness_of(c, r) * c.impulse[r];
    }
  }
  newton_.solve();

  for (int k = 0; k < n;) {
    const int member = rule_[k].member;
    Constraint& c = all[members[member]];
    Vec3 next = c.impulse;
    for (; k < n && rule_[k].member == member; ++k) {
      const Slip& slip = slips_[static_cast<std::size_t>(member)];
      const double by = newton_.b(k);
      if (rule_[k].kind == Row::across) {
        next.tail<2>() += by * slip.across;
      } else {
        next[rule_[k].r] += by;
        if (rule_[k].kind == Row::sliding) next.tail<2>() += c.surface.friction * by * slip.along;
      }
    }
    if (c.kind == ConstraintKind::contact) next = project_to_cone(next, c.surface.friction);
    if (c.kind != ConstraintKind::bilateral) next[0] = std::max(0.0, next[0]);
    const Vec3 change = next - c.impulse;
    c.impulse = next;
    if (change != Vec3::Zero()) add_to_velocity(member, c.rows, change);
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
/// while; the best of them is kept. Was it the last?
bool ContactSolver::newton(std::vector<Constraint>& all, const std::vector<int>& members, Aim aim, Care care, SolveReport& report) {
  keep(all, members);
  double best = report.residual;
  bool at_best = true;
  int worse = 0;
  const bool quick = care == Care::none;
  regular_ = quick ? kRegularQuick : care == Care::redundant ? kRegularFirst : kRegularJammed;
  factored_rule_.clear();
  bool falling = true;  // fast enough for the matrix to be kept
  for (int k = 0; k < (quick ? kQuickSteps : kNewtonSteps) && report.residual > aim.wanted; ++k) {
    ++report.newton_steps;
    const double before = report.residual;
    if (!newton_step(all, members, quick && falling)) break;
    if (care == Care::redundant) {
      sweep(all, members);  // contacts on the edge between sticking and slipping, where Newton alone goes to and fro
      ++report.sweeps;
    }
    report.residual = residual(all, members);
    at_best = report.residual < best;
    falling = report.residual < kFalls * before;
    if (!std::isfinite(report.residual)) break;
    if (!quick) regular_ = std::max(kRegularLast, (at_best ? kRegularFalls : 1.0) * regular_);
    if (!at_best && best <= kNearEnough * aim.tolerated) break;
    if (!at_best && ++worse == (quick ? kQuickPatience : kPatience)) break;
    if (!at_best) continue;
    best = report.residual;
    keep(all, members);
  }
  if (!at_best) go_back(all, members);
  report.residual = best;
  return at_best;
}

}  // namespace engine
