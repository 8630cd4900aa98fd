// What changes while a model runs: all that the next step depends on, in one copyable value. A run can be stopped, copied, saved
// and gone on with, and gives the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/bytes.h"
#include "engine/contact/clearance.h"
#include "engine/laws/compliant_contact.h"
#include "engine/math/types.h"
#include "engine/solver/constraint.h"

namespace engine {

/// Where all bodies are at an instant and how they move.
struct Motion {
  double time = 0;          // [s]
  std::vector<Pose> X_WB;   // per body
  std::vector<Twist> V_WB;  // per body

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.time, s.X_WB, s.V_WB);
  }
};

/// Impulse of a contact or limit in the last step, found again by its key: the next solve starts from it.
struct WarmStart {
  std::uint64_t key = 0;
  Vec3 impulse_W = Vec3::Zero();  // [N s] world axes for contacts; first component for one-row blocks

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.key, s.impulse_W);
  }
};

/// A wheel, in the order of the vehicles' wheels. `tyres` and `driver` write it.
struct WheelState {
  int vehicle = 0, wheel = 0;
  double static_load = 0;       // [N]
  double compression = 0;       // [m] from static ride, positive: compressed
  double lift = 0;              // [m] of the hub from static ride: no more than the stops let it
  double brake = 0;             // [N] asked for now
  Vec3 contact = Vec3::Zero();  // [m] world
  Vec3 hub = Vec3::Zero();      // [m] world
  Vec3 impulse = Vec3::Zero();  // [N s] last step: load, longitudinal, lateral
  double slip = 0;              // [m/s]
  double drive = 0;             // [N] of the engine at this wheel now
  double steer = 0;             // [rad]
  bool locked = false;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.vehicle, s.wheel, s.static_load, s.compression, s.lift, s.brake, s.contact, s.hub, s.impulse, s.slip, s.drive,
                    s.steer, s.locked);
  }
};

/// Contacts and limits found at the end of the last step: the next one solves them.
struct FoundContacts {
  std::vector<Constraint> list;
  std::vector<int> trees;  // awake when they were found
  bool known = false;

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.list, s.trees, s.known);
  }
};

/// Phase of a compliant contact that the stages of Runge and Kutta see, by its key.
struct ContactPhaseMemory {
  std::uint64_t key = 0;
  ContactPhase phase = ContactPhase::open;
  double gap = 0, speed = 0;  // [m], [m/s] at the start of the step

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.key, s.phase, s.gap, s.speed);
  }
};

/// The fastest swing that joint forces make a body capable of: sqrt(T r / I), as in a chain of light links pulled taut by heavy
/// ends. Runge-Kutta 4 blows up above 2.8 over the step.
struct Swing {
  double rate = 0;  // [rad/s]
  int body = -1;    // -1: none
};

/// How long steps may be that follow the blow on one head.
struct HeadPace {
  double last = 0;   // [s] that the blow allowed last, infinite: any
  double next = 0;   // [s] that it allows now
  double until = 0;  // [s] when its pulse is over at the latest

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.last, s.next, s.until);
  }
};

/// What the steps so far say of the length of the next.
struct StepPace {
  double last = 0;              // [s] length of the last step
  double next = 0;              // [s] what the last step suggests, 0: anything
  int cuts = 0;                 // of the step under way, to place impacts
  int events = 0;               // of compliant contacts placed in it
  Swing swing;                  // of the last step
  double next_instant = -1;     // [s] at which a step must end, negative: none
  std::vector<HeadPace> heads;  // per person
  std::vector<int> in_vain;     // per tree: solves in a row of its island that Newton brought no nearer

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.last, s.next, s.cuts, s.events, s.swing.rate, s.swing.body, s.next_instant, s.heads, s.in_vain);
  }
};

/// Where the mechanical energy went, since the start of the run.
struct EnergyLedger {
  double initial = 0;              // [J] kinetic, gravitational and of springs
  double scale = 0;                // [J] of the scene: kinetic and of springs at the start, and all masses falling by a metre
  std::vector<double> dissipated;  // [J] per effect of the plan
  double added = 0;                // [J] by engines
  double springs = 0;              // [J] in the suspensions now

  template <class S>
  static auto fields(S& s) {
    return std::tie(s.initial, s.scale, s.dissipated, s.added, s.springs);
  }
};

/// What one effect keeps from step to step, a value of the effect's own type.
class EffectMemory {
 public:
  EffectMemory() = default;
  template <class T>
  explicit EffectMemory(T value) : held_(std::make_unique<Of<T>>(std::move(value))) {}
  EffectMemory(const EffectMemory& other) : held_(other.held_ ? other.held_->copy() : nullptr) {}
  EffectMemory& operator=(const EffectMemory& other) {
    held_ = other.held_ ? other.held_->copy() : nullptr;
    return *this;
  }
  EffectMemory(EffectMemory&&) = default;
  EffectMemory& operator=(EffectMemory&&) = default;
  ~EffectMemory() = default;

  /// T must be the type it was made of.
  template <class T>
  T& as() {
    return static_cast<Of<T>&>(*held_).value;
  }
  void write(ByteWriter& out) const {
    if (held_) held_->write(out);
  }
  void read(ByteReader& in) {
    if (held_) held_->read(in);
  }

 private:
  struct Held {
    virtual ~Held() = default;
    virtual std::unique_ptr<Held> copy() const = 0;
    virtual void write(ByteWriter&) const = 0;
    virtual void read(ByteReader&) = 0;
  };
  template <class T>
  struct Of final : Held {
    explicit Of(T v) : value(std::move(v)) {}
    std::unique_ptr<Held> copy() const override { return std::make_unique<Of>(value); }
    void write(ByteWriter& out) const override { out.put(value); }
    void read(ByteReader& in) override { in.get(value); }
    T value;
  };
  std::unique_ptr<Held> held_;
};

struct State : Motion {
  std::vector<char> released;              // per person: 0 while in the zero condition
  std::vector<char> broken;                // per joint: 1 once its breaking force was passed
  std::vector<char> asleep;                // per tree; empty: nothing sleeps
  std::vector<double> wheel_spin;          // [rad] per wheel, in the order of the vehicles' wheels
  std::vector<WheelState> wheels;          // the same; empty without the effect `tyres`
  std::vector<WarmStart> warm;             // sorted by key
  FoundContacts contacts;                  // at this instant
  ContactMemory contact_memory;            // of pairs
  std::vector<ContactPhaseMemory> phases;  // sorted by key
  StepPace pace;
  EnergyLedger energy;
  std::vector<EffectMemory> memory;  // per effect of the plan
};

/// A state as bytes, for a file or another process; the same on every machine with little-endian IEEE doubles.
Bytes to_bytes(const State&);

/// The state back. `like` is any state of the same model and plan, such as its first; nothing if the bytes are not of them.
std::optional<State> from_bytes(const Bytes&, const State& like);

/// To the last bit.
bool operator==(const State&, const State&);
std::uint64_t hash(const State&);

}  // namespace engine
