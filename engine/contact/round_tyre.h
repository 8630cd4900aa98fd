// Wheels and the round bodies they may run over or into. The body (a) beside the tyre (b), where the strut has moved it to, is the
// row of the pair table; beneath it, it is what the suspension stands on.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/contact/contact.h"
#include "engine/geometry/hyper_ellipsoid_tyre.h"

namespace engine {

/// All wheels with all segments and free bodies that do not ride on them.
std::vector<TyrePair> tyre_pairs(const Model&);

/// The tyre of a wheel of State::wheels, its strut `lift` [m] up from static ride.
Tyre tyre_of(const Outlook&, int wheel, double lift);

/// How the rim of a wheel that turns freely moves at a point besides its vehicle's motion: (roll V) way, with V the vehicle's
/// twist.
struct RollingRim {
  Eigen::Matrix<double, 1, 6> roll;  // speed of the hub along the wheel, by the vehicle's twist
  Vec3 way = Vec3::Zero();           // axle x (p - hub) / R
  double grip = 0;                   // [-] friction at the road; none in the air
};
RollingRim rim_at(const Outlook&, const TyrePair&, const Vec3& p);

/// [m] by which rubber gives where it is pinched: 200 kN/m (vertical stiffness of a passenger car's tyre) under its 3.7 kN by
/// 19 mm, in a blow by more.
constexpr double kTyreGives = 0.03;
/// The gap to a tyre pressed in: none as long as the rubber gives.
inline double given(double gap) {
  return gap < 0 ? std::min(0.0, gap + kTyreGives) : gap;
}

/// Beside a tyre: does that yield to the body where neither does by the law? Rigid both, a wheel that squeezes a limb to the road
/// leaves it no place.
bool yields_as_rubber(const Model&, int body);

/// Where the hub of the pair's wheel is [m], at static ride.
Vec3 hub_of(const Outlook&, const TyrePair&);

/// Spheres about the two, with the ways of the strut: near enough to look? `hub` is that of the pair's wheel.
bool near(const Outlook&, const TyrePair&, const Vec3& hub, double margin);

/// The suspension's compression [m], from static ride, at which the tyre just stands on the body: beneath it, no higher than the
/// stop lets it. Nothing where the two meet sideways, or that is below `least` [m].
std::optional<TyreTouch> stands_on(const Outlook&, const TyrePair&, double least);

}  // namespace engine
