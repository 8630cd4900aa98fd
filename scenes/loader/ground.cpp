// [ground]: the plane, a terrain mesh, or nothing.
#include "scenes/loader/builder.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/mesh_frame.h"

namespace scenes {
namespace {

const Key kPatchKeys[] = {
    bound<&engine::GroundPatch::lower>({"from", Type::vector2, Dimension::length, kRequired, "World x, y of a corner."}),
    bound<&engine::GroundPatch::upper>({"to", Type::vector2, Dimension::length, kRequired, "World x, y of the opposite corner."}),
    bound<&engine::GroundPatch::friction>(
        {"friction", Type::schedule, Dimension::none, kRequired, "Coulomb coefficient: 0.8 dry, 0.5 wet, 0.1 ice.", kNotNegative}),
};
const Section kPatchSection{"ground.patch", "[[ground.patch]]",
                            "A rectangle with a friction of its own; later ones lie over earlier ones.", kPatchKeys};

const Key kGroundKeys[] = {
    bound_to_first_word<&engine::Ground::plane>({"kind", Type::choice, Dimension::none, "'plane'",
                                                 "An infinite plane z = height, or none (free fall, or terrain only).", kAny,
                                                 "plane|none"}),
    bound<&engine::Ground::height>({"height", Type::number, Dimension::length, "'0 m'", "Height of the plane."}),
    bound_to_both<&engine::SurfaceProperties::friction_body, &engine::SurfaceProperties::friction_ground>(
        {"friction", Type::schedule, Dimension::none, "1",
         "Coulomb coefficient of the ground. Of two objects the smaller acts, so 1 leaves it to the other.", kNotNegative}),
    bound_to_both<&engine::SurfaceProperties::restitution_body, &engine::SurfaceProperties::restitution_ground>(
        {"restitution", Type::schedule, Dimension::none, "0", "Restitution of the ground. Of two objects the larger acts.",
         kShare}),
    bound<&engine::SurfaceProperties::stiffness>({"stiffness", Type::schedule, Dimension::stiffness, "'1000 MN/m'",
                                                  "S of the compliant contact law; two surfaces act in series.", kPositive}),
    {"patch", Type::tables, Dimension::none, "", "Where the road is wet or icy.", kAny, {}, &kPatchSection},
    {"terrain", Type::path, Dimension::none, "", "A mesh file in world axes (z up), besides or in place of the plane."},
    CRASHREEL_MESH_KEYS,
};

}  // namespace

const Section kGroundSection{"ground", "[ground]", "What everything stands on.", kGroundKeys};

void read_ground(Builder& builder, std::optional<Reader> reader) {
  Reader r = reader ? *reader : Reader(empty_table(), kGroundSection, "ground", builder.errors);
  engine::Ground& ground = builder.scene.model.ground;
  r.fill(ground);
  r.fill(ground.surface);
  for (Reader& corners : r.tables("patch")) {
    engine::GroundPatch& patch = ground.patches.emplace_back();
    corners.fill(patch);
    const engine::Vec3 p = patch.lower, q = patch.upper;
    if (p.x() == q.x() || p.y() == q.y()) corners.fail("to", "must differ from the other corner in x and in y");
    patch.lower = p.cwiseMin(q);
    patch.upper = p.cwiseMax(q);
  }
  if (r.has("terrain")) {
    if (const auto mesh = in_frame(builder, import_mesh(builder, r, "terrain"), given_frame(r))) {
      ground.terrain = mesh->solid->mesh();
      builder.scene.stage.road.terrain = mesh->look;
      builder.scene.stage.road.terrain_surface = mesh->solid->mesh();
    }
  }
}

}  // namespace scenes
