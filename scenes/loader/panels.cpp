#include "scenes/loader/panels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace scenes {
namespace {

using engine::Panel;
using engine::Vec3;

/// A drawn triangle, for finding what a place of the collision mesh is made of.
struct Drawn {
  Vec3 centre, normal;
  bool glass;
};

std::vector<Drawn> drawn_of(const render::Mesh& look) {
  std::vector<Drawn> out;
  const auto corner = [&](std::uint32_t i) {
    const std::size_t k = 3 * static_cast<std::size_t>(look.indices[i]);
    return Vec3(look.positions[k], look.positions[k + 1], look.positions[k + 2]);
  };
  for (const render::Mesh::Part& part : look.parts) {
    const bool glass = look.materials[static_cast<std::size_t>(part.material)].kind == render::MaterialKind::glass;
    for (std::uint32_t i = part.first; i + 2 < part.first + part.count; i += 3) {
      const Vec3 a = corner(i), b = corner(i + 1), c = corner(i + 2), across = (b - a).cross(c - a);
      if (across.norm() > 0) out.push_back({(a + b + c) / 3, across.normalized(), glass});
    }
  }
  std::sort(out.begin(), out.end(), [](const Drawn& a, const Drawn& b) { return a.centre.x() < b.centre.x(); });
  return out;
}

/// Of what is drawn nearest and faces the same way; `drawn` in order of x.
bool is_glass(const std::vector<Drawn>& drawn, const Vec3& p, const Vec3& n) {
  double least = 0.15;  // [m] farther off it says nothing
  bool glass = false;
  // false where all beyond are farther along x than the nearest so far
  const auto look_at = [&](const Drawn& d) {
    const Vec3 away = d.centre - p;
    if (std::abs(away.x()) >= least) return false;
    if (std::abs(away.y()) >= least || std::abs(away.z()) >= least) return true;  // nearly all: before the root
    const double distance = away.norm();
    if (distance < least && d.normal.dot(n) > 0.5) least = distance, glass = d.glass;
    return true;
  };
  const auto middle =
      std::lower_bound(drawn.begin(), drawn.end(), p.x(), [](const Drawn& d, double x) { return d.centre.x() < x; });
  for (auto at = middle; at != drawn.end() && look_at(*at);) ++at;
  for (auto at = middle; at != drawn.begin() && look_at(*std::prev(at));) --at;
  return glass;
}

/// Box around the glass that faces forwards; empty where there is none.
engine::Aabb windscreen_of(const std::vector<Drawn>& drawn) {
  constexpr double kForwards = 0.25;  // [-]
  engine::Aabb box;
  for (const Drawn& d : drawn) {
    if (!d.glass || d.normal.x() < kForwards) continue;
    box.lower = box.lower.cwiseMin(d.centre);
    box.upper = box.upper.cwiseMax(d.centre);
  }
  return box;
}

Panel by_normal(const Vec3& n) {
  if (n.z() < -0.5) return Panel::underside;
  if (n.z() > 0.6) return Panel::roof;
  if (std::abs(n.y()) > 0.7) return Panel::side;
  return n.x() > 0 ? Panel::front : Panel::rear;
}

Panel panel_of(const Vec3& p, const Vec3& n, bool glass, const engine::Aabb& screen) {
  constexpr double kFrame = 0.12;  // [m] around the glass
  if (glass) return n.x() > 0.25 ? Panel::windscreen : n.x() < -0.25 ? Panel::rear_window : Panel::side_window;
  if (screen.lower.x() > screen.upper.x() || n.z() < -0.5) return by_normal(n);
  if (p.x() > screen.upper.x() && p.z() < screen.upper.z()) {
    if (n.z() > 0.5) return Panel::bonnet;
    return std::abs(n.y()) > 0.7 ? Panel::side : Panel::front;
  }
  const bool beside = p.x() > screen.lower.x() - kFrame && p.z() > screen.lower.z() && p.z() < screen.upper.z() + kFrame;
  if (beside && n.x() > 0.1) {
    const double edge = std::max(std::abs(screen.lower.y()), std::abs(screen.upper.y())) - 2 * kFrame;
    if (p.z() > screen.upper.z() - 0.02 && std::abs(p.y()) < edge) return Panel::roof_edge;
    return std::abs(p.y()) > edge ? Panel::a_pillar : Panel::windscreen;
  }
  const Panel by_itself = by_normal(n);
  // what faces up below the middle of the windscreen is no roof: the wings beside its foot, and behind it the lid of a boot
  const bool low = p.z() < (screen.lower.z() + screen.upper.z()) / 2;
  if (by_itself != Panel::roof || !low) return by_itself;
  return p.x() > screen.lower.x() ? Panel::bonnet : Panel::rear;
}

}  // namespace

std::shared_ptr<const engine::Panels> panels_of(const engine::TriangleMesh& solid, const render::Mesh& look) {
  const std::vector<Drawn> drawn = drawn_of(look);
  const engine::Aabb screen = windscreen_of(drawn);
  auto out = std::make_shared<engine::Panels>();
  out->reserve(solid.triangles().size());
  for (std::size_t t = 0; t < solid.triangles().size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const std::int32_t v : solid.triangles()[t]) centre += solid.vertices()[static_cast<std::size_t>(v)] / 3;
    const Vec3& n = solid.face_normals()[t];
    out->push_back(panel_of(centre, n, is_glass(drawn, centre, n), screen));
  }
  return out;
}

}  // namespace scenes
