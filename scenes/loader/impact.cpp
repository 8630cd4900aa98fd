// [[impact]]: what the user settles about the Kudlich-Slibar impact of two bodies.
#include "scenes/loader/builder.h"

namespace scenes {
namespace {

const Key kImpactKeys[] = {
    {"a", Type::text, Dimension::none, kRequired, "A vehicle or a body with a mesh."},
    {"b", Type::text, Dimension::none, kRequired, "The other."},
    bound<&engine::ImpactSettings::penetration_time>(
        {"penetration_time", Type::number, Dimension::time, "'0.03 s'",
         "From the first touch to the exchange of the impulse: the depth of penetration.", kNotNegative}),
    bound<&engine::ImpactSettings::point_W>(
        {"point", Type::vector3, Dimension::length, "",
         "Where the first impulse acts, in the world. Left out: the centroid of the overlap at that moment."}),
    bound<&engine::ImpactSettings::normal_W>({"normal", Type::vector3, Dimension::none, "",
                                              "Of the contact plane of the first impulse, in the world, either sign. Left out: "
                                              "from the line in which the surfaces cut 0.15 m after they met."}),
    bound<&engine::ImpactSettings::friction>({"friction", Type::number, Dimension::none, "",
                                              "In the contact plane. Left out: 0.6, as crushed bodywork has, or the "
                                              "smaller of the two bodies' if that is more.",
                                              kNotNegative}),
    bound<&engine::ImpactSettings::restitution>({"restitution", Type::number, Dimension::none, "",
                                                 "Multiplies the whole impulse. Left out: the larger of the two bodies'.", kShare}),
};

}  // namespace

const Section kImpactSection{"impact", "[[impact]]",
                             "Settles what is otherwise found in the impact of two bodies that both ask for Kudlich-Slibar.",
                             kImpactKeys};

void read_impact(Builder& builder, Reader r) {
  engine::ImpactSettings impact;
  impact.body_a = find_body(builder, r, "a");
  impact.body_b = find_body(builder, r, "b");
  if (impact.body_a < 0 || impact.body_b < 0) return;
  if (impact.body_a == impact.body_b) r.fail("b", "must be another body than a");
  for (const char* key : {"a", "b"}) {
    const int body = builder.body_index(r.text(key));
    if (builder.scene.model.bodies[static_cast<std::size_t>(body)].collision_model != engine::CollisionModel::kudlich_slibar)
      r.fail(key, "must ask for Kudlich-Slibar, with collision = \"kudlich_slibar\"; Default-Auto has no settings of a pair");
  }
  r.fill(impact);
  if (auto& normal = impact.normal_W) {
    if (normal->norm() < 1e-9) r.fail("normal", "must have a direction");
    normal->normalize();
  }
  builder.scene.model.impacts.push_back(impact);
}

}  // namespace scenes
