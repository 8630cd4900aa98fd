#include "engine/solver/kudlich_slibar.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <limits>

namespace engine {

Mat3 impact_matrix(double mass_1, const Mat3& inertia_1, const Vec3& r_1, double mass_2, const Mat3& inertia_2, const Vec3& r_2) {
  const Mat3 R_1 = skew(r_1), R_2 = skew(r_2);
  return (1 / mass_1 + 1 / mass_2) * Mat3::Identity() - R_1 * inertia_1.inverse() * R_1 - R_2 * inertia_2.inverse() * R_2;
}

PlaneImpact kudlich_slibar(const Mat3& K, const Vec3& u, const Vec3& normal, double friction, double restitution) {
  assert(std::abs(normal.norm() - 1) < 1e-9 && "the contact plane has a unit normal");
  PlaneImpact out;
  out.u_after = u;
  if (u.dot(normal) >= 0) return out;

  const Vec3 P_c = -K.ldlt().solve(u);
  const double P_cn = P_c.dot(normal);
  const Vec3 P_ct = P_c - P_cn * normal;
  out.required_friction = P_cn > 0 ? P_ct.norm() / P_cn : std::numeric_limits<double>::infinity();
  out.impulse = (1 + restitution) * P_c;
  out.sliding = out.required_friction > friction;
  if (out.sliding) {
    const Vec3 d = normal + friction * P_ct.normalized();
    const double P_n = -(1 + restitution) * u.dot(normal) / normal.dot(K * d);
    out.impulse = P_n * d;
  }
  out.u_after = u + K * out.impulse;
  out.energy_lost = -0.5 * out.impulse.dot(u + out.u_after);
  return out;
}

}  // namespace engine
