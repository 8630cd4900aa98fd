// [overlays]: what is drawn over the picture.
#include <fmt/format.h>

#include <deque>

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

const Key kListKeys[] = {
    bound<&render::Overlays::trace_bodies>({"trace_bodies", Type::texts, Dimension::none, "[]",
                                            "Bodies whose paths are drawn; empty: head and hips of every person."}),
    bound<&render::Overlays::contact_colour>({"contact_colour", Type::choice, Dimension::none, "'time'",
                                              "Colours of the marks of contact_history: when it touched, or how hard.", kAny,
                                              "time|impulse"}),
    {"dimension", Type::tables, Dimension::none, "", "Lengths with their numbers.", kAny, {}, &kDimensionSection},
};

/// As in a scene file.
std::string fallback_of(const render::OverlayKey& key) {
  if (*key.unit == 0) return key.fallback > 0 ? "true" : "false";
  return key.fallback > 0 ? fmt::format("'{} {}'", key.fallback, key.unit) : "";
}

/// Keys of the overlays' own files, from their table, and lists.
const std::vector<Key>& section_keys() {
  static std::deque<std::string> texts;  // that the keys look at; they do not move
  static const std::vector<Key> keys = [] {
    std::vector<Key> out;
    for (const render::OverlayKey& key : render::overlay_keys())
      out.push_back({key.name, *key.unit == 0 ? Type::boolean : Type::number, dimension_of(key.unit),
                     texts.emplace_back(fallback_of(key)), key.doc,
                     *key.unit == 0 ? kAny : Range{key.lower, key.upper, key.lower == 0}});
    out.insert(out.end(), std::begin(kListKeys), std::end(kListKeys));
    return out;
  }();
  return keys;
}

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

const Section kOverlaysSection{"overlays", "[overlays]", "What is drawn over the picture.", section_keys()};

void read_overlays(Builder& builder, Reader r) {
  render::Overlays& o = builder.scene.stage.overlays;
  r.fill(o);
  for (const Key& key : section_keys())
    if ((key.type == Type::boolean || key.type == Type::number) && (r.has(key.name) || !key.fallback.empty()))
      o.set(key.name, key.type == Type::boolean ? r.boolean(key.name) : r.number(key.name));
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
