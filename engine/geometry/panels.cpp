#include "engine/geometry/panels.h"
#include "engine/geometry/point_mesh.h"

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
      const auto corner = [&](int k) -> const Vec3& {
        return mesh.vertices()[static_cast<std::size_t>(mesh.triangles()[i][static_cast<std::size_t>(k)])];
      };
      const double d = (point - nearest_in_triangle(point, corner(0), corner(1), corner(2))).norm();
      if (d < least) least = d, best = panels[i];
    }
    if (least < reach) return best;
  }
  return Panel::unknown;
}

}  // namespace engine
