#include "cli/output/recording_file.h"

#include <algorithm>
#include <concepts>
#include <fstream>
#include <iterator>
#include <tuple>

#include "cli/build_id.h"
#include "engine/bytes.h"
#include "engine/contact/pair_table.h"
#include "scenes/loader/sha256.h"

namespace cli {
namespace {

using engine::Recording;

/// What of a recording is kept; `T` is const where it is written.
template <class T, class Of>
concept Is = std::same_as<std::remove_const_t<T>, Of>;

auto fields(Is<engine::BodyState> auto& s) {
  return std::tie(s.X_WB, s.V_WB);
}
auto fields(Is<engine::ContactRecord> auto& c) {
  return std::tie(c.shapes, c.body_a, c.body_b, c.point, c.normal, c.depth, c.force, c.normal_force, c.tangential_force,
                  c.normal_impulse, c.tangential_impulse, c.friction_limit, c.impulse, c.energy_lost, c.slip, c.begun, c.state,
                  c.exchange);
}
auto fields(Is<engine::WheelRecord> auto& w) {
  return std::tie(w.vehicle, w.wheel, w.hub, w.contact, w.steer, w.spin, w.load, w.longitudinal, w.lateral, w.slip);
}
auto fields(Is<engine::Energies> auto& e) {
  return std::tie(e.kinetic, e.potential, e.dissipated, e.added, e.residual);
}
auto fields(Is<engine::Snapshot> auto& s) {
  return std::tie(s.time, s.bodies, s.contacts, s.wheels, s.tyre_impulse, s.energies);
}
auto fields(Is<engine::Event> auto& e) {
  return std::tie(e.time, e.kind, e.body_a, e.body_b, e.point, e.value, e.normal, e.velocity);
}
auto fields(Is<engine::PlanLine::Acted> auto& a) {
  return std::tie(a.told, a.in_reach, a.first, a.last);
}
auto fields(Is<engine::PlanLine> auto& p) {
  return std::tie(p.effect, p.active, p.forced, p.reason, p.left_out, p.called_for, p.not_before, p.acted);
}
auto fields(Is<engine::Diagnostics> auto& d) {
  return std::tie(d.max_joint_gap, d.max_joint_angle_error, d.max_penetration, d.rest_penetration, d.max_compression,
                  d.max_solver_residual, d.max_energy_rise, d.energy_turned_over, d.max_unexplained, d.max_effect_gain,
                  d.contact_sweeps, d.newton_steps, d.restitution_scaled, d.substeps, d.warnings);
}
auto fields(Is<engine::HeadMotion> auto& h) {
  return std::tie(h.person, h.time, h.acceleration);
}
auto fields(Is<engine::Failure> auto& f) {
  return std::tie(f.time, f.body, f.effect, f.message);
}
auto fields(Is<Recording> auto& r) {
  return std::tie(r.body_names, r.vehicle_names, r.effect_names, r.interval, r.snapshots, r.events, r.heads, r.peak_acceleration,
                  r.plan, r.diagnostics, r.steps);
}

template <class T>
concept Composed = requires(T& t) {
  fields(t);
};

struct Writer {
  engine::ByteWriter out;

  template <class T>
  void operator()(const T& value) {
    out.put(value);
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    out.put(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) (*this)(value);
  }
  void operator()(const engine::BodyStates& bodies) {
    out.put(static_cast<std::uint64_t>(bodies.size()));
    for (const engine::BodyState& body : bodies) (*this)(body);
  }
  template <Composed T>
  void operator()(const T& value) {
    std::apply([this](const auto&... field) { ((*this)(field), ...); }, fields(value));
  }
};

struct Reader {
  engine::ByteReader in;

  template <class T>
  void operator()(T& value) {
    in.get(value);
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    // one by one: a damaged count asks for no memory
    for (std::size_t left = in.size(); left > 0 && in.good; --left) (*this)(values.emplace_back());
  }
  void operator()(engine::BodyStates& bodies) { (*this)(bodies.own()); }
  template <Composed T>
  void operator()(T& value) {
    std::apply([this](auto&... field) { ((*this)(field), ...); }, fields(value));
  }
};

/// First in the file: of which scene, by which program, and that it is whole.
std::string key_of(const scenes::Scene& scene, const engine::Bytes& payload) {
  const std::string_view bytes(reinterpret_cast<const char*>(payload.data()), payload.size());
  return scenes::sha256(build_id() + scene.sha256 + scene.assets_sha256 + scenes::sha256(bytes));
}

/// Whether every number in it that counts or chooses something can be one of a run of this scene.
class Fits {
 public:
  explicit Fits(const engine::Model& model) : model_(model), bodies_(static_cast<int>(model.bodies.size())) {}

  bool operator()(const Recording& r) const {
    return !r.snapshots.empty() && r.interval > 0 &&
           all(r.snapshots, [&](const auto& s) { return snapshot(s, r.effect_names.size()); }) &&
           r.body_names.size() == model_.bodies.size() && r.vehicle_names.size() == model_.vehicles.size() &&
           (r.peak_acceleration.empty() || r.peak_acceleration.size() == model_.bodies.size()) &&
           all(r.events, [&](const auto& e) { return is_body(e.body_a) && is_body(e.body_b); }) && all(r.heads, [&](const auto& h) {
             return within(h.person, model_.persons.size()) && h.time.size() == h.acceleration.size();
           });
  }

 private:
  static bool all(const auto& list, const auto& holds) { return std::all_of(list.begin(), list.end(), holds); }
  static bool within(int i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; }
  bool is_body(int b) const { return b >= -1 && b < bodies_; }
  bool contact(const engine::ContactRecord& c) const {
    return is_body(c.body_a) && is_body(c.body_b) &&
           std::any_of(kinds_.begin(), kinds_.end(), [&](const engine::PairKind& kind) { return kind.shapes == c.shapes; }) &&
           within(static_cast<int>(c.state), 1 + static_cast<int>(engine::ContactState::impact));
  }
  bool wheel(const engine::WheelRecord& w) const {
    return within(w.vehicle, model_.vehicles.size()) &&
           within(w.wheel, model_.vehicles[static_cast<std::size_t>(w.vehicle)].wheels.size());
  }
  bool snapshot(const engine::Snapshot& s, std::size_t effects) const {
    return s.bodies.size() == model_.bodies.size() && s.tyre_impulse.size() == model_.vehicles.size() &&
           s.energies.dissipated.size() == effects && all(s.contacts, [&](const auto& c) { return contact(c); }) &&
           all(s.wheels, [&](const auto& w) { return wheel(w); });
  }

  const engine::Model& model_;
  int bodies_;
  std::span<const engine::PairKind> kinds_ = engine::pair_table();
};

}  // namespace

engine::Bytes payload_of(const Recording& recording) {
  Writer write;
  write(recording);
  write(recording.failure.has_value());
  write(recording.failure.value_or(engine::Failure{}));
  return std::move(write.out.bytes);
}

std::optional<Recording> recording_of(const engine::Bytes& payload, const engine::Model& model) {
  Reader read{.in = engine::ByteReader(payload)};
  Recording out;
  bool failed = false;
  engine::Failure failure;
  read(out);
  read(failed);
  read(failure);
  if (!read.in.at_end() || !Fits(model)(out)) return std::nullopt;
  if (failed) out.failure = failure;
  return out;
}

std::string recording_bytes(const scenes::Scene& scene, const Recording& recording) {
  const engine::Bytes payload = payload_of(recording);
  return key_of(scene, payload) + std::string(payload.begin(), payload.end());
}

std::optional<Recording> read_recording(const std::filesystem::path& path, const scenes::Scene& scene) {
  std::ifstream file(path, std::ios::binary);
  std::string key(scenes::sha256("").size(), ' ');
  if (!file.read(key.data(), static_cast<std::streamsize>(key.size()))) return std::nullopt;
  const engine::Bytes payload{std::istreambuf_iterator<char>(file), {}};
  return key == key_of(scene, payload) ? recording_of(payload, scene.model) : std::nullopt;
}

}  // namespace cli
