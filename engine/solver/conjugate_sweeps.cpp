// Sweeps along conjugate directions (Silcowitz, Niebe and Erleben 2010): what a sweep changes stands for the gradient, and the way
// of the sweeps before is gone on along it. The norm is the energy of the change. Against plain sweeps a third fewer are asked for
// where persons lie on each other.
#include "engine/solver/contact_solver.h"

namespace engine {
namespace {

constexpr double kStillFalls = 0.7;  // [-] of the residual that a sweep leaves: as long as it is less, more is had for little

}  // namespace

/// Where Newton goes to and fro: contacts of persons who have come to rest on each other stand on the edges of their cones, stick
/// or slip by what little is left, and no step of Newton's is better than where it began. Sweeps close in on the tolerance at once.
void ContactSolver::sweep_on(std::vector<Constraint>& all, const std::vector<int>& members, Aim aim, int most,
                             SolveReport& report) {
  L_along_.assign(static_cast<std::size_t>(size_), 0.0);
  u_along_.assign(stride_, 0.0);
  double energy = 0;
  for (int k = 0; report.residual > aim.wanted; ++k) {
    const double before = report.residual;
    keep(all, members);
    sweep(all, members);
    ++report.sweeps;
    report.residual = residual(all, members);
    if (report.residual <= aim.tolerated && report.residual > kStillFalls * before) return;
    if (k + 1 >= most) return;
    if (report.residual > aim.wanted) energy = move_along(all, members, energy);
  }
}

/// Goes on along the direction so far, and turns it by the change of the last sweep, whose energy it returns; `last` is that of the
/// sweep before. Impulses may leave their cones: the next sweep brings them back.
double ContactSolver::move_along(std::vector<Constraint>& all, const std::vector<int>& members, double last) {
  double energy = 0;
  std::size_t at = 0;
  for (const int m : members)
    for (int r = 0; r < all[m].rows; ++r, ++at) energy += (all[m].impulse[r] - L_kept_[at]) * (u_[at] - u_kept_[at]);
  const double share = energy < last ? energy / last : 0;  // else begun anew
  at = 0;
  for (const int m : members)
    for (int r = 0; r < all[m].rows; ++r, ++at) {
      const double by_L = all[m].impulse[r] - L_kept_[at], by_u = u_[at] - u_kept_[at];
      all[m].impulse[r] += share * L_along_[at];
      u_[at] += share * u_along_[at];
      L_along_[at] = share * L_along_[at] + by_L;
      u_along_[at] = share * u_along_[at] + by_u;
    }
  return energy;
}

}  // namespace engine
