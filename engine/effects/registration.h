// What an effect's file ends with: its name, finding, section and hooks read off its class.
#pragma once

#include "engine/effects/effect.h"

namespace engine {

namespace detail {

/// The hooks that E has of its own.
template <class E>
constexpr unsigned hooks_of() {
  unsigned out = 0;
  const auto note = [&out](Hook hook, auto own, auto inherited) {
    if (!std::is_same_v<decltype(own), decltype(inherited)>) out |= static_cast<unsigned>(hook);
  };
  note(Hook::begin, &E::begin, &Effect::begin);
  note(Hook::before_step, &E::before_step, &Effect::before_step);
  note(Hook::find_contacts, &E::find_contacts, &Effect::find_contacts);
  note(Hook::find_limits, &E::find_limits, &Effect::find_limits);
  note(Hook::find, &E::find, &Effect::find);
  note(Hook::add_forces, &E::add_forces, &Effect::add_forces);
  note(Hook::resist, &E::resist, &Effect::resist);
  note(Hook::gave_way, &E::gave_way, &Effect::gave_way);
  note(Hook::stored, &E::stored, &Effect::stored);
  note(Hook::after_step, &E::after_step, &Effect::after_step);
  return out;
}

template <class E>
constexpr EffectKind describe() {
  EffectKind kind;
  kind.name = E::kName;
  kind.look = E::look;
  if constexpr (requires { E::left_out; }) kind.left_out = E::left_out;
  if constexpr (requires { E::gives; }) kind.gives = E::gives;
  if constexpr (requires { E::kPassive; }) kind.passive = E::kPassive;
  if constexpr (requires { E::not_before; }) kind.not_before = E::not_before;
  if constexpr (requires { E::staged; }) kind.staged = E::staged;
  if constexpr (requires { E::kSection; }) kind.section = E::kSection;
  kind.make = [](World& world, int self) -> std::unique_ptr<Effect> { return std::make_unique<E>(world, self); };
  kind.first_memory = [] {
    if constexpr (requires { typename E::Memory; }) return EffectMemory(typename E::Memory{});
    return EffectMemory();
  };
  kind.hooks = hooks_of<E>();
  return kind;
}

}  // namespace detail

template <class E>
const EffectKind Registered<E>::kind = detail::describe<E>();

}  // namespace engine
