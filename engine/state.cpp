#include "engine/state.h"

#include <algorithm>

namespace engine {
namespace {

constexpr std::uint64_t kMark = 0x3530455441545343;  // "CSTATE05"

/// All but the motion and what effects keep to themselves.
template <class S>
auto parts(S& s) {
  return std::tie(s.released, s.broken, s.asleep, s.wheel_spin, s.wheels, s.warm, s.contacts, s.contact_memory, s.phases, s.pace,
                  s.energy);
}

/// Sizes that the model and its plan settle.
bool same_model(const State& a, const State& b) {
  return a.X_WB.size() == b.X_WB.size() && a.V_WB.size() == b.V_WB.size() && a.released.size() == b.released.size() &&
         a.broken.size() == b.broken.size() && a.asleep.size() == b.asleep.size() && a.wheel_spin.size() == b.wheel_spin.size() &&
         a.wheels.size() == b.wheels.size() && a.pace.heads.size() == b.pace.heads.size() &&
         a.pace.in_vain.size() == b.pace.in_vain.size() && a.contact_memory.mesh.size() == b.contact_memory.mesh.size() &&
         a.contact_memory.round.size() == b.contact_memory.round.size() &&
         a.contact_memory.bodywork.size() == b.contact_memory.bodywork.size() &&
         a.energy.dissipated.size() == b.energy.dissipated.size();
}

/// FNV-1a over the first `count` bytes.
std::uint64_t checksum(const Bytes& bytes, std::size_t count) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (std::size_t i = 0; i < count; ++i) value = (value ^ bytes[i]) * 0x100000001b3;
  return value;
}

/// Ends with the sum of what stands before it?
bool is_whole(const Bytes& bytes) {
  std::uint64_t told = 0;
  if (bytes.size() < sizeof told) return false;
  const std::size_t count = bytes.size() - sizeof told;
  std::memcpy(&told, bytes.data() + count, sizeof told);
  return told == checksum(bytes, count);
}

}  // namespace

Bytes to_bytes(const State& state) {
  ByteWriter out;
  out.put(kMark);
  out.put(static_cast<const Motion&>(state));
  std::apply([&out](const auto&... part) { (out.put(part), ...); }, parts(state));
  out.put(static_cast<std::uint64_t>(state.memory.size()));
  for (const EffectMemory& memory : state.memory) memory.write(out);
  out.put(checksum(out.bytes, out.bytes.size()));
  return std::move(out.bytes);
}

std::optional<State> from_bytes(const Bytes& bytes, const State& like) {
  if (!is_whole(bytes)) return std::nullopt;
  State state;
  state.memory = like.memory;  // for their types
  ByteReader in(bytes);
  std::uint64_t mark = 0;
  in.get(mark);
  in.get(static_cast<Motion&>(state));
  std::apply([&in](auto&... part) { (in.get(part), ...); }, parts(state));
  const std::size_t effects = in.size();
  if (mark != kMark || !in.good || effects != state.memory.size() || !same_model(state, like)) return std::nullopt;
  for (EffectMemory& memory : state.memory) memory.read(in);
  std::uint64_t sum = 0;
  in.get(sum);
  if (!in.at_end()) return std::nullopt;
  return state;
}

bool operator==(const State& a, const State& b) {
  return to_bytes(a) == to_bytes(b);
}

std::uint64_t hash(const State& state) {
  const Bytes bytes = to_bytes(state);
  return checksum(bytes, bytes.size() - sizeof(std::uint64_t));
}

}  // namespace engine
