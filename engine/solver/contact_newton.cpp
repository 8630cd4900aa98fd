// Newton on all contacts, limits and wheels of an island at once (semi-smooth, after Alart and Curnier 1991).
#include <algorithm>
#include <cmath>

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
constexpr double kFalls = 0.3;  // [-]
constexpr int kNewtonSteps = 20, kPatience = 6;
constexpr double kRegularQuick = 1e-3;  // [-]
constexpr double kRegularFirst = 1e-2;  // [-]
constexpr double kRegularFalls = 0.3;
constexpr double kRegularLast = 1e-10;
constexpr double kRegularJammed = 1e-8;  // where impulses are large and well determined

}  // namespace

/// How a sliding contact's tangential impulse follows its slip, x = L_t - rho u_t.
ContactSolver::Slip ContactSolver::slipping(const Constraint& c, double rho, const Eigen::Vector2d& x) {
  const double length = x.norm();
  Slip slip;
  slip.rho = rho;
  slip.direction = x / length;
  slip.most = c.surface.friction * std::max(0.0, c.impulse[0]);
  slip.across = std::min(1.0, slip.most / length) * (Eigen::Matrix2d::Identity() - slip.direction * slip.direction.transpose());
  return slip;
}

/// The conditions at the present impulses as linear equations in their change; returns the number of unknowns.
int ContactSolver::linearise(const std::vector<Constraint>& all, const std::vector<int>& members) {
  unknown_.clear();
  rule_.clear();
  slips_.resize(members.size());
  for (const int i : elimination_.order()) {
    const Constraint& c = all[members[i]];
    const Mat3& A = own_[i];
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
      kind = Row::slip;
      slips_[static_cast<std::size_t>(i)] = slipping(c, rho, wanted);
    }
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
  // column by column, as they lie: of who opens nothing, of who slides L_t - mu L_n x/|x| = 0 with x = L_t - rho u_t, whose two
  // rows stand together after that of the normal
  const auto changes_rows = [this](int k) {
    return rule_[k].kind == Row::let_go || (rule_[k].kind == Row::slip && rule_[k].r == 1);
  };
  changed_.clear();
  for (int k = 0; k < n; ++k)
    if (changes_rows(k)) changed_.push_back(k);
  for (int m = 0; m < n; ++m) {
    const double* response = G_.data() + static_cast<std::size_t>(unknown_[m]) * stride_;
    double* end = newton_.column(m);
    for (const Run& run : runs_) end = std::copy_n(response + run.first, run.length, end);
    double* column = newton_.column(m);
    for (const int k : changed_) {
      if (rule_[k].kind == Row::let_go) {
        column[k] = 0;
        continue;
      }
      const Slip& slip = slips_[static_cast<std::size_t>(rule_[k].member)];
      const Eigen::Vector2d a = slip.rho * (slip.across * Eigen::Vector2d(column[k], column[k + 1]));
      column[k] = a[0];
      column[k + 1] = a[1];
    }
  }
  for (int k = 0; k < n; ++k) {
    const auto [kind, member, r] = rule_[k];
    const Constraint& c = all[members[member]];
    if (kind == Row::let_go) {
      newton_.A(k, k) = 1;
    } else if (kind != Row::slip) {
      newton_.A(k, k) += regular_ * G(unknown_[k], unknown_[k]) + (r == 0 ? c.softness : (r == 2 ? c.wheel.grip_softness : 0));
    } else if (r == 1) {
      const Slip& slip = slips_[static_cast<std::size_t>(member)];
      for (int q = 0; q < 2; ++q) {
        newton_.A(k + q, k - 1) -= c.surface.friction * slip.direction[q];
        for (int p = 0; p < 2; ++p) newton_.A(k + q, k + p) += (p == q ? 1 : 0) - slip.across(q, p);
      }
    }
  }
  if (!newton_.factor()) return false;
  factored_rule_ = rule_;
  return true;
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
      newton_.b(k) = r == 0 ? c.target - u - c.softness * c.impulse[0] : -u - (r == 2 ? c.wheel.grip_softness * c.impulse[2] : 0);
    } else if (r == 1) {
      const Slip& slip = slips_[static_cast<std::size_t>(member)];
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
    if (c.kind == ConstraintKind::contact) next = project_to_cone(next, c.surface.friction);
    if (c.kind != ConstraintKind::bilateral) next[0] = std::max(0.0, next[0]);
    const Vec3 change = next - c.impulse;
    c.impulse = next;
    if (change != Vec3::Zero()) add_to_velocity(i, c.rows, change);
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
  bool falling = true;  // fast enough for the matrix to be kept
  for (int k = 0; k < (quick ? kQuickSteps : kNewtonSteps) && report.residual > tolerance; ++k) {
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
    if (!at_best && ++worse == (quick ? kQuickPatience : kPatience)) break;
    if (!at_best) continue;
    best = report.residual;
    keep(all, members);
  }
  if (!at_best) go_back(all, members);
  report.residual = best;
}

}  // namespace engine
