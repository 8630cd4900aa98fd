// Sections of the scene file that physical effects bring with them: made from the engine's table, so that a new effect needs no
// change here.
#include <deque>

#include "engine/effects/effect.h"
#include "scenes/loader/builder.h"

namespace scenes {
namespace {

/// A section with what its views look at; it does not move.
struct OwnSection {
  std::string header, doc;
  std::vector<Key> keys;
  Section section;
};

const std::deque<OwnSection>& own_sections() {
  static const std::deque<OwnSection> sections = [] {
    std::deque<OwnSection> out;
    for (const engine::EffectKind* effect : engine::effect_table()) {
      if (effect->section.keys.empty()) continue;
      OwnSection& own = out.emplace_back();
      own.header = "[" + std::string(effect->section.name) + "]";
      own.doc = "For the effect " + std::string(effect->name) + ".";
      for (const engine::SceneKey& key : effect->section.keys)
        own.keys.push_back({key.name, key.components == 3 ? Type::vector3 : Type::number, dimension_of(key.unit), key.fallback,
                            key.doc, at_least(key.lower)});
      own.section = {effect->section.name, own.header, effect->section.doc, own.keys};
    }
    return out;
  }();
  return sections;
}

}  // namespace

std::vector<Key> keys_of_effects() {
  std::vector<Key> out;
  for (const OwnSection& own : own_sections())
    out.push_back({own.section.name, Type::table, Dimension::none, "", own.doc, kAny, {}, &own.section});
  return out;
}

void read_inputs_of_effects(Builder& builder, Reader& scene) {
  for (const OwnSection& own : own_sections()) {
    std::optional<Reader> r = scene.table(own.section.name);
    if (!r) continue;
    for (const Key& key : own.keys) {
      if (key.fallback.empty() && !r->has(key.name)) continue;
      builder.scene.model.inputs[r->path(key.name)] =
          key.type == Type::vector3 ? r->vector(key.name) : engine::Vec3(r->number(key.name), 0, 0);
    }
  }
}

}  // namespace scenes
