// A part's cross-section is widened and narrowed along its length, then mounds are put on (a nose) and hollows taken out (the
// eyes). All in shares of the semi-axes, so that children and tall people get theirs. The figures are drawn by eye after the usual
// proportions of anatomy for artists; none departs from the hyper-ellipsoid by more than a finger's breadth but wrist and hand,
// where the hyper-ellipsoid stands for both.
#include "render/surface/anatomy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace render {
namespace {

constexpr double kFar = 0.12;  // [m] beyond this the box around a segment stands for it, which is the quicker to tell

/// The cross-section at a height, in shares of the semi-axes.
struct Ring {
  double at;       // along the part, -1 (below, or the heel) to 1
  double depth;    // factor along x (a foot: along z)
  double width;    // factor along y
  double forward;  // its middle, in shares of the semi-axis x (a foot: none)
};

/// A rod with round ends; radius and fillet in shares of the least semi-axis.
struct Mound {
  Vec3 from, to;
  double radius, fillet;
  bool both_sides = false;  // also at -y
  bool hollow = false;
};

}  // namespace

struct Anatomy {
  std::string_view part;
  std::span<const Ring> rings;
  std::span<const Mound> mounds;
  bool lengthwise = false;  // rings along x
};

namespace {

constexpr Ring kHead[] = {{-1, 0.80, 0.70, 0.12},  {-0.75, 0.84, 0.74, 0.11}, {-0.45, 0.92, 0.84, 0.06},
                          {0, 0.985, 0.95, 0.005}, {0.4, 1, 1, -0.02},        {1, 1, 1, -0.02}};
// relief only, eyes closed: a likeness of nobody
const Mound kFace[] = {{{0.88, 0.20, 0.20}, {0.80, 0.54, 0.19}, 0.10, 0.25, true},          // brow
                       {{0.64, 0.52, -0.22}, {0.40, 0.74, -0.14}, 0.14, 0.50, true},        // cheekbones
                       {{0.68, 0, -0.88}, {0.68, 0, -0.88}, 0.20, 0.35},                    // chin
                       {{0.40, 0.36, -0.85}, {-0.05, 0.66, -0.55}, 0.14, 0.4, true},        // jaw
                       {{0.99, 0.36, 0.03}, {0.94, 0.50, 0.02}, 0.15, 0.35, true, true},    // sockets
                       {{0.81, 0.38, 0.01}, {0.78, 0.46, 0.01}, 0.13, 0.10, true},          // lids
                       {{0.87, 0, 0.10}, {1.07, 0, -0.28}, 0.10, 0.20},                     // nose
                       {{1.09, 0, -0.31}, {1.09, 0, -0.31}, 0.11, 0.15},                    // its tip
                       {{0.97, 0.12, -0.36}, {0.95, 0.13, -0.36}, 0.08, 0.12, true},        // its wings
                       {{0.90, 0, -0.53}, {0.82, 0.22, -0.56}, 0.075, 0.08, true},          // upper lip
                       {{0.87, 0, -0.645}, {0.80, 0.17, -0.635}, 0.085, 0.08, true},        // lower lip
                       {{0.97, 0, -0.588}, {0.88, 0.27, -0.588}, 0.035, 0.04, true, true},  // mouth
                       {{-0.12, 0.97, 0.14}, {-0.02, 0.96, -0.25}, 0.12, 0.1, true}};       // ears

constexpr Ring kTorso[] = {{-1, 0.95, 0.94, 0.02}, {-0.7, 0.90, 0.91, 0.03}, {-0.3, 0.93, 0.93, 0.02},
                           {0.2, 1.02, 1.03, 0},   {0.5, 0.99, 1.10, -0.04}, {1, 0.86, 0.94, -0.08}};
const Mound kShoulders[] = {{{-0.10, 0.18, 0.885}, {-0.04, 1.05, 0.71}, 0.36, 0.36, true},  // from the neck to the shoulder
                            {{0.62, 0.42, 0.38}, {0.70, 0.36, 0.30}, 0.22, 0.5, true},
                            {{0.02, -0.44, -0.87}, {0.02, 0.44, -0.87}, 0.74, 0.5}};  // waist

constexpr Ring kHips[] = {{-1, 1, 1, 0}, {-0.3, 1.0, 0.99, -0.02}, {0.4, 0.95, 0.96, 0}, {1, 0.93, 0.94, 0}};
const Mound kCrotch[] = {{{-0.25, 0, -1.45}, {0.2, 0, -1.45}, 0.45, 0.6}};

constexpr Ring kUpperArm[] = {
    {-1, 0.84, 0.84, 0}, {-0.5, 0.89, 0.88, 0}, {0, 0.99, 0.95, 0.03}, {0.5, 1.03, 1.02, 0}, {1, 1, 1, 0}};

constexpr Ring kForearm[] = {{-1, 0.86, 0.60, 0}, {-0.72, 1.02, 0.42, 0}, {-0.46, 1.04, 0.43, 0}, {-0.24, 0.72, 0.53, 0},
                             {0, 0.80, 0.76, 0},  {0.35, 1.0, 1.0, 0},    {0.7, 1.04, 1.03, 0},   {1, 0.92, 0.92, 0}};
const Mound kThumb[] = {{{0.62, -0.06, -0.38}, {1.25, -0.28, -0.60}, 0.26, 0.45}};

constexpr Ring kThigh[] = {
    {-1, 0.82, 0.82, 0.02}, {-0.6, 0.84, 0.84, 0.03}, {-0.1, 0.97, 0.97, 0.05}, {0.4, 1.04, 1.03, 0.03}, {1, 1.02, 1.02, 0}};

constexpr Ring kKnee[] = {{-1, 0.86, 0.82, -0.02}, {1, 0.86, 0.82, 0.02}};

constexpr Ring kCalf[] = {{-1, 0.74, 0.70, 0},       {-0.6, 0.74, 0.72, 0.02}, {-0.1, 0.92, 0.90, -0.08},
                          {0.35, 1.12, 1.05, -0.20}, {0.7, 1.02, 1.0, -0.06},  {1, 0.98, 0.98, 0}};

constexpr Ring kFoot[] = {{-1, 1.05, 0.84, 0}, {-0.6, 1.0, 0.80, 0}, {0, 0.95, 0.88, 0}, {0.5, 0.95, 1.04, 0}, {1, 0.80, 0.92, 0}};
const Mound kInstep[] = {{{-0.44, 0, 0.75}, {0.22, 0, 0.10}, 0.88, 0.8}};

constexpr std::array<Anatomy, 15> kAnatomy{{{"head", kHead, kFace},
                                            {"torso", kTorso, kShoulders},
                                            {"hips", kHips, kCrotch},
                                            {"waist", kHips, kCrotch},
                                            {"upper_arm", kUpperArm, {}},
                                            {"forearm", kForearm, kThumb},
                                            {"lower_arm", kForearm, kThumb},
                                            {"thigh", kThigh, {}},
                                            {"femur", kThigh, {}},
                                            {"knee", kKnee, {}},
                                            {"calf", kCalf, {}},
                                            {"lower_leg", kCalf, {}},
                                            {"foot", kFoot, kInstep, true}}};

/// Cubic through the rings, slopes of their neighbours.
Ring ring_at(std::span<const Ring> rings, double at) {
  if (at <= rings.front().at) return rings.front();
  if (at >= rings.back().at) return rings.back();
  std::size_t k = 1;
  while (rings[k].at < at) ++k;
  const Ring &a = rings[k - 1], &b = rings[k];
  const Ring &before = rings[k > 1 ? k - 2 : 0], &after = rings[std::min(k + 1, rings.size() - 1)];
  const double width = b.at - a.at, s = (at - a.at) / width;
  auto value = [&](double Ring::*what) {
    const double slope_a = (b.*what - before.*what) / (b.at - before.at), slope_b = (after.*what - a.*what) / (after.at - a.at);
    const double h = s * s * (3 - 2 * s);
    return (1 - h) * (a.*what) + h * (b.*what) + width * s * (1 - s) * ((1 - s) * slope_a - s * slope_b);
  };
  return {at, value(&Ring::depth), value(&Ring::width), value(&Ring::forward)};
}

double rod_distance(const Vec3& x, const Vec3& from, const Vec3& to, double radius) {
  const Vec3 along = to - from;
  const double length = along.squaredNorm();
  const double s = length > 0 ? std::clamp((x - from).dot(along) / length, 0.0, 1.0) : 0;
  return (x - from - s * along).norm() - radius;
}

/// [m] from the box around it, zero inside.
double box_distance(const engine::HyperEllipsoid& e, const Vec3& x) {
  return (x.cwiseAbs() - e.semi_axes).cwiseMax(0).norm();
}

}  // namespace

double radial_distance(const engine::HyperEllipsoid& e, const Vec3& x) {
  if (const double away = box_distance(e, x); away > kFar) return away;
  const double r = x.norm();
  if (r < 1e-9) return -e.semi_axes.minCoeff();
  return r - r / engine::gauge(e, x);
}

double smooth_minimum(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * h * h * k;
}

double beyond_hairline(const Vec3& x, const Vec3& head_axes) {
  constexpr double kHairline = 0.14, kRise = 0.55;  // [-] of the head's height over its middle; from back to front
  return x.z() - head_axes.z() * (kHairline + kRise * x.x() / head_axes.x());
}

const Anatomy* anatomy_of(std::string_view segment) {
  if (const auto slash = segment.rfind('/'); slash != segment.npos) segment.remove_prefix(slash + 1);
  for (const std::string_view side : {"left_", "right_"})
    if (segment.starts_with(side)) segment.remove_prefix(side.size());
  for (const Anatomy& a : kAnatomy)
    if (!a.part.empty() && a.part == segment) return &a;
  return nullptr;
}

double anatomical_distance(const Anatomy& anatomy, const engine::HyperEllipsoid& e, bool mirrored, const Vec3& x) {
  constexpr double kHair = 0.005;   // [m] thick ...
  constexpr double kRising = 0.02;  // [m] ... from so far beyond the hairline
  const Vec3& axes = e.semi_axes;
  if (const double away = box_distance(e, x); away > kFar) return away;
  const int along = anatomy.lengthwise ? 0 : 2;
  const Ring ring = ring_at(anatomy.rings, x[along] / axes[along]);
  Vec3 in_ellipsoid = x;
  if (!anatomy.lengthwise) in_ellipsoid.x() -= ring.forward * axes.x();
  in_ellipsoid[anatomy.lengthwise ? 2 : 0] /= ring.depth;
  in_ellipsoid.y() /= ring.width;
  double d = std::min(ring.depth, ring.width) * radial_distance(e, in_ellipsoid);
  const double unit = axes.minCoeff();
  for (const Mound& m : anatomy.mounds)
    for (const double side : {mirrored ? -1.0 : 1.0, mirrored ? 1.0 : -1.0}) {
      const Vec3 flip(1, side, 1);
      const double mound = rod_distance(x, m.from.cwiseProduct(axes).cwiseProduct(flip), m.to.cwiseProduct(axes).cwiseProduct(flip),
                                        m.radius * unit);
      d = m.hollow ? -smooth_minimum(-d, mound, m.fillet * unit) : smooth_minimum(d, mound, m.fillet * unit);
      if (!m.both_sides) break;
    }
  if (anatomy.part == "head") {
    const double s = std::clamp(beyond_hairline(x, axes) / kRising, 0.0, 1.0);
    d -= kHair * s * s * (3 - 2 * s);
  }
  return d;
}

}  // namespace render
