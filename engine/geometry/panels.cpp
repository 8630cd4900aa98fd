#include "engine/geometry/panels.h"
#include "engine/math/functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace engine {
namespace {

struct Entry {
  const char* name;
  double stiffness;  // [N/m]
};

constexpr std::array<Entry, 12> kPanels{{{"unknown", 150e3},
                                         {"front", 250e3},
                                         {"bonnet", 100e3},
                                         {"windscreen", 55e3},
                                         {"a_pillar", 400e3},
                                         {"roof_edge", 300e3},
                                         {"roof", 100e3},
                                         {"side", 150e3},
                                         {"side_window", 55e3},
                                         {"rear", 150e3},
                                         {"rear_window", 55e3},
                                         {"underside", 400e3}}};

/// Distance [m] of p from a triangle's plane, and from the line of the edge it is farthest beyond: too little beyond a sharp
/// corner.
double distance_to(const TriangleMesh& mesh, int t, const Vec3& p) {
  const Triangle& corner = mesh.triangles()[static_cast<std::size_t>(t)];
  const Vec3& a = mesh.vertices()[static_cast<std::size_t>(corner[0])];
  const Vec3& b = mesh.vertices()[static_cast<std::size_t>(corner[1])];
  const Vec3& c = mesh.vertices()[static_cast<std::size_t>(corner[2])];
  const Vec3& n = mesh.face_normals()[static_cast<std::size_t>(t)];
  double beside = 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
    beside = std::max(beside, (p - from).dot((to - from).normalized().cross(n)));
  return math::hypot((p - a).dot(n), beside);
}

}  // namespace

const char* name_of(Panel panel) {
  return kPanels[static_cast<std::size_t>(panel)].name;
}

double yield_of(Panel panel) {
  return panel == Panel::windscreen ? 3500 : std::numeric_limits<double>::infinity();
}

double stiffness_of(Panel panel) {
  return kPanels[static_cast<std::size_t>(panel)].stiffness;
}

bool is_glass(Panel panel) {
  return panel == Panel::windscreen || panel == Panel::side_window || panel == Panel::rear_window;
}

Panel panel_at(const TriangleMesh& mesh, const Panels& panels, const Vec3& point, const Vec3& normal) {
  constexpr double kFacing = 0.25;          // [-] a contact on an edge faces between its two sides
  constexpr std::size_t kTriangles = 4096;  // that near; no step allocates
  thread_local std::vector<int> near;
  near.reserve(kTriangles);
  for (const double reach : {1e-3, 0.1}) {  // [m] as a rule it lies on one of them
    near.clear();
    mesh.query({(point.array() - reach).matrix(), (point.array() + reach).matrix()}, near);
    Panel best = Panel::unknown;
    double least = reach;
    for (const int t : near) {
      const auto i = static_cast<std::size_t>(t);
      if (i >= panels.size() || mesh.face_normals()[i].dot(normal) < kFacing) continue;
      const double d = distance_to(mesh, t, point);
      if (d < least) least = d, best = panels[i];
    }
    if (least < reach) return best;
  }
  return Panel::unknown;
}

}  // namespace engine
