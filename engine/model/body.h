// Bodies, their shapes and the coefficients of their surfaces. Plain data, SI units.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "engine/geometry/hyper_ellipsoid.h"
#include "engine/geometry/panels.h"
#include "engine/geometry/triangle_mesh.h"
#include "engine/math/types.h"
#include "engine/model/schedule.h"

namespace engine {

/// Which collision model an object asks for. Default-Auto is used if either of two objects asks for it, Kudlich-Slibar only if both
/// do.
enum class CollisionModel { default_auto, kudlich_slibar };

/// Of a pair of objects.
inline CollisionModel model_between(CollisionModel a, CollisionModel b) {
  const bool both = a == CollisionModel::kudlich_slibar && b == CollisionModel::kudlich_slibar;
  return both ? CollisionModel::kudlich_slibar : CollisionModel::default_auto;
}

/// Coefficients come in two kinds: `ground` against the ground, `body` against every other object (source 002).
struct SurfaceProperties {
  Schedule friction_body = 0.3;       // [-] Coulomb
  Schedule friction_ground = 0.6;     // [-]
  Schedule restitution_body = 0.0;    // [-] 0..1, ratio of separating to closing normal speed
  Schedule restitution_ground = 0.0;  // [-]
  // [N/m] S of eq. (68), compliant law only. Person and bodywork in series then yield 200 kN/m: a leg struck at 40 km/h goes in by
  // 4 cm, less than half its thickness, a head of 4.6 kg that meets the bonnet at 40 km/h by 5 cm.
  Schedule stiffness = 400e3;
  bool stiffness_given = false;  // by the scene: it stands for all panels
};

/// A triangle mesh carried by a body; X_BM places the mesh frame in the body frame (origin: centre of mass).
struct MeshShape {
  std::shared_ptr<const TriangleMesh> mesh;
  Pose X_BM;
  double tolerance = 0;                            // [m] it may be this far from the surface it stands for
  std::shared_ptr<const Panels> panels = nullptr;  // null: not told apart
};

/// A hyper-ellipsoid sits with its centre at the centre of mass, axes along the body's.
using Shape = std::variant<std::monostate, HyperEllipsoid, MeshShape>;

struct Body {
  std::string name;                   // "pedestrian/head", "sedan", "puck"
  double mass = 1;                    // [kg] > 0
  Mat3 inertia_B = Mat3::Identity();  // [kg m^2] about the centre of mass, body axes, eq. (67)
  Shape shape;
  SurfaceProperties surface;
  CollisionModel collision_model = CollisionModel::default_auto;
  Pose X_WB;           // at t = 0
  Twist V_WB;          // at t = 0
  int person = -1;     // index into Model::persons
  int vehicle = -1;    // index into Model::vehicles
  bool fixed = false;  // part of the world: never moves
};

inline bool is_round(const Body& body) {
  return std::holds_alternative<HyperEllipsoid>(body.shape);
}

inline bool is_mesh(const Body& body) {
  return std::holds_alternative<MeshShape>(body.shape);
}

}  // namespace engine
