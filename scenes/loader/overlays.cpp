// [overlays]: what is drawn over the picture.
#include <fmt/format.h>

#include "scenes/loader/builder.h"

namespace scenes {
namespace {

const Key kDimensionKeys[] = {
    bound<&render::Dimension::label>({"label", Type::text, Dimension::none, "''", "Stands before the number."}),
    {"body", Type::text, Dimension::none, "''", "How far this body, vehicle or person has come, level, since a time."},
    bound<&render::Dimension::since>({"since", Type::number, Dimension::time, "'0 s'", "That time.", kNotNegative}),
    bound<&render::Dimension::from>({"from", Type::vector3, Dimension::length, "", "Without body: one end."}),
    bound<&render::Dimension::to>({"to", Type::vector3, Dimension::length, "", "Without body: the other end."}),
};
const Section kDimensionSection{"overlays.dimension", "[[overlays.dimension]]", "A line with its length in numbers.",
                                kDimensionKeys};

const Key kOverlayKeys[] = {
    bound<&render::Overlays::contacts>({"contacts", Type::boolean, Dimension::none, "true", "Contact points and normals."}),
    bound<&render::Overlays::forces>({"forces", Type::boolean, Dimension::none, "true", "Arrows, long by force."}),
    bound<&render::Overlays::caption>({"caption", Type::boolean, Dimension::none, "true", "Time, speeds, camera."}),
    bound<&render::Overlays::traces>({"traces", Type::boolean, Dimension::none, "false", "Paths of the bodies in trace_bodies."}),
    bound<&render::Overlays::vehicle_paths>(
        {"vehicle_paths", Type::boolean, Dimension::none, "false", "The way of each vehicle, on the ground."}),
    bound<&render::Overlays::wheel_traces>({"wheel_traces", Type::boolean, Dimension::none, "false",
                                            "Where each wheel rolled. (Skid marks, where tyres slid, are always drawn.)"}),
    bound<&render::Overlays::trace_bodies>({"trace_bodies", Type::texts, Dimension::none, "[]",
                                            "Bodies whose paths are drawn; empty: head and hips of every person."}),
    bound<&render::Overlays::disclaimer>(
        {"disclaimer", Type::boolean, Dimension::none, "true", "\"Simulation, not footage\" and the provenance at the foot."}),
    bound<&render::Overlays::scale_bar>({"scale_bar", Type::boolean, Dimension::none, "true", "A bar of metres in top views."}),
    bound<&render::Overlays::legend>(
        {"legend", Type::boolean, Dimension::none, "false", "What colours and lengths of arrows and marks mean."}),
    bound<&render::Overlays::contact_history>(
        {"contact_history", Type::boolean, Dimension::none, "false", "Marks on vehicles and persons where they touched so far."}),
    bound<&render::Overlays::contact_colour>({"contact_colour", Type::choice, Dimension::none, "'time'",
                                              "Their colours: when it touched, or how hard.", kAny, "time|impulse"}),
    bound<&render::Overlays::ghost_interval>({"ghost_interval", Type::number, Dimension::time, "",
                                              "Pale figures of persons and free bodies at equal times.", between(0.005, 60)}),
    bound<&render::Overlays::ghost_distance>(
        {"ghost_distance", Type::number, Dimension::length, "", "Pale figures at equal distances travelled.", between(0.02, 1000)}),
    bound<&render::Overlays::velocities>(
        {"velocities", Type::boolean, Dimension::none, "false", "Velocity arrows of vehicles and persons, with numbers."}),
    bound<&render::Overlays::velocity_scale>(
        {"velocity_scale", Type::number, Dimension::speed, "'8 m/s'", "Speed that one metre of arrow stands for.", kPositive}),
    bound<&render::Overlays::speed_chart>(
        {"speed_chart", Type::boolean, Dimension::none, "false", "Speeds over time, running with the film."}),
    bound<&render::Overlays::energy_chart>(
        {"energy_chart", Type::boolean, Dimension::none, "false", "Energies over time, running with the film."}),
    {"dimension", Type::tables, Dimension::none, "", "Lengths with their numbers.", kAny, {}, &kDimensionSection},
    bound<&render::Overlays::newtons_per_metre>(
        {"force_scale", Type::number, Dimension::stiffness, "'10 kN/m'", "Force that one metre of arrow stands for.", kPositive}),
};

/// Body of the Model that a body, vehicle or person goes by; -1: none.
int body_of(const Builder& builder, const std::string& name) {
  const engine::Model& model = builder.scene.model;
  for (const engine::Person& person : model.persons)
    if (person.name == name) return person.hips;
  for (const engine::Vehicle& vehicle : model.vehicles)
    if (vehicle.name == name) return vehicle.body;
  return builder.body_index(name);
}

void read_dimension(Builder& builder, Reader& r) {
  render::Dimension d;
  r.fill(d);
  const std::string name = r.text("body");
  if (name.empty()) {
    if (!r.has("from") || !r.has("to")) r.fail_here("needs a body, or from and to");
  } else {
    d.body = body_of(builder, name);
    const bool told = !builder.errors.empty() && builder.is_declared(name);
    if (d.body < 0 && !told) r.fail("body", "is no body, vehicle or person of the scene");
    if (r.has("from") || r.has("to")) r.fail("body", "needs no from and to; it is measured from where it was at since");
  }
  builder.scene.stage.overlays.dimensions.push_back(d);
}

}  // namespace

const Section kOverlaysSection{"overlays", "[overlays]", "What is drawn over the picture.", kOverlayKeys};

void read_overlays(Builder& builder, Reader r) {
  render::Overlays& o = builder.scene.stage.overlays;
  r.fill(o);
  for (Reader& dimension : r.tables("dimension")) read_dimension(builder, dimension);
  for (const std::string& name : o.trace_bodies) {
    const bool told = !builder.errors.empty() && builder.is_declared(name);
    if (builder.body_index(name) >= 0 || told) continue;
    const std::string guess = nearest(name, builder.body_names());
    r.fail("trace_bodies", fmt::format("must name bodies of the scene; \"{}\" is none{}", name,
                                       guess.empty() ? "" : fmt::format(", did you mean \"{}\"?", guess)));
  }
  if (o.trace_bodies.empty()) {
    for (const engine::Person& person : builder.scene.model.persons) {
      for (int body : {person.head, person.hips})
        if (body >= 0) o.trace_bodies.push_back(builder.scene.model.bodies[static_cast<std::size_t>(body)].name);
    }
  }
}

}  // namespace scenes
