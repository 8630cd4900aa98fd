// Panels of a vehicle, and how hard each is to a person. Names are those of reports and of `head_impact_panel`.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/triangle_mesh.h"

namespace engine {

enum class Panel : std::uint8_t {
  unknown,
  front,
  bonnet,
  windscreen,
  a_pillar,
  roof_edge,
  roof,
  side,
  side_window,
  rear,
  rear_window,
  underside
};

const char* name_of(Panel);

/// Panel of each triangle of a collision mesh, in its order.
using Panels = std::vector<Panel>;

/// Stiffness [N/m] of a panel under a headform, and taken for all parts of a person. Bonnet 50 to 150 kN/m and windscreen 30 to 80
/// kN/m, the middle taken: Exploration of the stiffness profiles of modern cars in pedestrian impacts, Proc. IMechE D 227, 2013,
/// from 139 Euro NCAP headform and legform tests, and the studies it compares with. Pillars and edges, stiffer by some times in the
/// same tests, and the other panels are estimates.
double stiffness_of(Panel);

/// Force [N] at which a panel yields to a head, and presses no harder while that stops the head within its room. Infinite but for a
/// windscreen: its glass breaks, and its film stretches. In the centre of windscreens a headform stays below HIC 500, and comes to
/// more towards the frame (K. Mizuno, H. Yonezawa, J. Kajzer, ESV 2001). One of 4.8 kg at 40 km/h comes to 940 on the spring above,
/// to 620 on one of 30 kN/m, to 480 where the film yields at 3 kN, and to 630 at 3.5 kN. The last is taken for the whole pane.
/// Other parts, wider, meet more film; for them none is known.
double yield_of(Panel);

/// A pane: it gives way until a head has gone through it whole. Behind sheet metal lies something before that.
bool is_glass(Panel);

/// The panel nearest to `point` among triangles that face like `normal` (mesh frame, unit); unknown where there is none within 0.1
/// m.
Panel panel_at(const TriangleMesh&, const Panels&, const Vec3& point, const Vec3& normal);

}  // namespace engine
