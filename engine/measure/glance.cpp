#include "engine/measure/glance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/math/functions.h"

namespace engine {
namespace {

// [m] a quarter of a car's width, as tests of small overlap have it. Below it rigid corners hook: two sedans at 70 km/h on 0.1 to
// 0.3 m exchange 10 to 17 m/s where crushed ones exchange 1 to 4. On 0.5 m and more both laws agree within a fifth.
constexpr double kSmall = 0.45;
constexpr double kSlab = 0.2;   // [m] above and below the point: mirrors are none of a bumper's width
constexpr double kSlow = 3;     // [m/s] slower ones crush little
constexpr double kTold = 1;     // [m/s] of the lighter one along the way
constexpr double kSpringy = 5;  // [m/s] relative speed below which cars are seen to part again
constexpr double kScratch = 1;  // [m/s] closing below which nobody asks

/// Unit direction in the plane of the road in which a nears b at the point, and how fast [m/s].
std::pair<Vec3, double> way_of(const Snapshot& s, int a, int b, const Vec3& point) {
  const auto velocity = [&](int body) {
    const BodyState& state = s.bodies[body];
    return Vec3(state.V_WB.v + state.V_WB.w.cross(point - state.X_WB.p));
  };
  Vec3 way = velocity(a) - velocity(b);
  way.z() = 0;
  const double speed = way.norm();
  return {speed > 0 ? Vec3(way / speed) : Vec3(Vec3::UnitX()), speed};
}

/// Least and most [m] of a mesh along a level axis, of its triangles near the height of `point`.
std::pair<double, double> extent(const Model& model, const Snapshot& s, int body, const Vec3& point, const Vec3& axis) {
  const auto& shape = std::get<MeshShape>(model.bodies[body].shape);
  const Pose X_WM = s.bodies[body].X_WB * shape.X_BM;
  double least = 1e300, most = -1e300;
  for (const Triangle& t : shape.mesh->triangles()) {
    double low = 1e300, high = -1e300, first = 1e300, last = -1e300;
    for (const int v : t) {
      const Vec3 p = X_WM * shape.mesh->vertices()[v] - point;
      low = std::min(low, p.z()), high = std::max(high, p.z());
      first = std::min(first, p.dot(axis)), last = std::max(last, p.dot(axis));
    }
    if (low > kSlab || high < -kSlab) continue;
    least = std::min(least, first), most = std::max(most, last);
  }
  return {least, most};
}

bool is_meshed(const Model& model, const Party& party) {
  return party.person < 0 && std::holds_alternative<MeshShape>(model.bodies[party.bodies.front()].shape);
}

std::string centimetres(double metres) {
  return std::to_string(std::max(0L, std::lround(100 * metres))) + " cm";
}

/// Low-speed collisions of cars give back 0.2 to 0.4 of the closing speed (Howard, Bomar and Bare, SAE 931843; Antonetti, SAE
/// 980551), and what is asked of them is the delta-v of the one struck.
std::string unsprung(const Model& model, const Recording& recording, const Impact& i) {
  const Party &a = i.a.party, &b = i.b.party;
  if (a.vehicle < 0 || b.vehicle < 0 || is_two_wheeler(model, a) || is_two_wheeler(model, b) ||
      joined_until(model, recording, a, b))
    return "";
  // who grazes another at speed closes slowly too; that is no bump
  if (!(i.closing_speed > kScratch && i.relative_speed < kSpringy) || std::string(i.law) == "compliant") return "";
  const Body &A = model.bodies[a.bodies.front()], &B = model.bodies[b.bodies.front()];
  if (std::max(A.surface.restitution_body.at(i.time), B.surface.restitution_body.at(i.time)) > 0) return "";
  const bool given = std::any_of(model.impacts.begin(), model.impacts.end(), [&](const ImpactSettings& s) {
    return std::minmax(s.body_a, s.body_b) == std::minmax(a.bodies.front(), b.bodies.front()) && s.restitution.has_value();
  });
  if (given || A.fixed || B.fixed) return "";
  return i.a.name + " and " + i.b.name +
         " met at low speed without restitution: staged collisions of cars give back 0.2 to 0.4 of the closing speed there, and "
         "the delta-v is that much larger; give restitution_body";
}

std::string glance_of(const Model& model, const Recording& recording, const Impact& i) {
  if (is_two_wheeler(model, i.a.party) || is_two_wheeler(model, i.b.party)) return "";  // narrower than any corner
  const int a = i.a.party.bodies.front(), b = i.b.party.bodies.front();
  const Snapshot& before = recording.snapshots[i.span.first > 0 ? i.span.first - 1 : 0];
  const auto [way, speed] = way_of(before, a, b, i.point);
  double lighter = 1e300;
  for (const int body : {a, b})
    if (!model.bodies[body].fixed) lighter = std::min(lighter, model.bodies[body].mass);
  const Vec3 level(i.impulse.x(), i.impulse.y(), 0);
  const double along = std::abs(level.dot(way)), across = std::abs(level.dot(Vec3::UnitZ().cross(way)));
  if (speed < kSlow || along < kTold * lighter) return "";
  const double overlap = overlap_across(model, before, a, b, i.point);
  if (std::string(i.law) != "default_auto" || overlap >= kSmall || along <= across) return "";
  return i.a.name + " and " + i.b.name + " met on " + centimetres(overlap) +
         " of their widths and hooked: rigid bodywork does, where a crushed corner goes by; compare the delta-v by "
         "collision = \"kudlich_slibar\" of both";
}

}  // namespace

double overlap_across(const Model& model, const Snapshot& s, int a, int b, const Vec3& point) {
  const Vec3 across = Vec3::UnitZ().cross(way_of(s, a, b, point).first);
  const auto of_a = extent(model, s, a, point, across), of_b = extent(model, s, b, point, across);
  return std::min(of_a.second, of_b.second) - std::max(of_a.first, of_b.first);
}

std::vector<std::string> doubtful_glances(const Model& model, const Recording& recording) {
  std::vector<std::string> out;
  const auto meshes = std::count_if(model.bodies.begin(), model.bodies.end(), [](const Body& body) {
    return body.person < 0 && std::holds_alternative<MeshShape>(body.shape);
  });
  if (meshes < 2) return out;
  for (const Impact& i : impacts_of(model, recording))
    if (i.phase == 1 && is_meshed(model, i.a.party) && is_meshed(model, i.b.party))
      for (std::string told : {glance_of(model, recording, i), unsprung(model, recording, i)})
        if (!told.empty()) out.push_back(std::move(told));
  return out;
}

}  // namespace engine
