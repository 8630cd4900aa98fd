// The engine's whole output: what happened, at instants, with what it cost and how right it is.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/shape_pair.h"
#include "engine/math/types.h"

namespace engine {

enum class ContactState { approach, separate, slide, stick, impact };

const char* name_of(const ShapePair&);  // of a contact between the two, as in contacts.csv
const char* name_of(ContactState);

struct BodyState {
  Pose X_WB;
  Twist V_WB;
};

/// All bodies at one instant. Those that are still hold alike over many: they are kept once, for all instants in a row.
class BodyStates {
 public:
  struct Still {
    std::vector<BodyState> states;
    std::vector<int> place;  // per body: among those that are not still, or ~place in `states`
  };

  BodyStates() = default;
  BodyStates(std::shared_ptr<Still> still, std::vector<BodyState> others) : still_(std::move(still)), others_(std::move(others)) {}

  std::size_t size() const { return still_ ? still_->place.size() : others_.size(); }
  const BodyState& operator[](std::size_t body) const {
    if (!still_) return others_[body];
    const int place = still_->place[body];
    return place < 0 ? still_->states[static_cast<std::size_t>(~place)] : others_[static_cast<std::size_t>(place)];
  }

  struct Iterator {
    const BodyStates* states;
    std::size_t body;
    const BodyState& operator*() const { return (*states)[body]; }
    Iterator& operator++() { return ++body, *this; }
    bool operator==(const Iterator&) const = default;
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size()}; }

  /// All of them in order, this instant's own from now on.
  std::vector<BodyState>& own();

  /// What this instant alone has, and what it shares: to change each state of a recording once.
  std::vector<BodyState>& others() { return others_; }
  Still* still() { return still_.get(); }

 private:
  std::shared_ptr<Still> still_;
  std::vector<BodyState> others_;
};

/// A contact at one recorded instant. Impulses are summed since the snapshot before, forces are their mean over that time's last
/// step.
struct ContactRecord {
  ShapePair shapes = {};
  int body_a = -1;
  int body_b = -1;                // -1: the ground
  Vec3 point = Vec3::Zero();      // [m] world
  Vec3 normal = Vec3::UnitZ();    // unit, from b to a
  double depth = 0;               // [m] penetration, negative: gap
  Vec3 force = Vec3::Zero();      // [N] on a, world
  double normal_force = 0;        // [N]
  double tangential_force = 0;    // [N]
  double normal_impulse = 0;      // [N s] since the snapshot before
  double tangential_impulse = 0;  // [N s] sum of magnitudes
  double friction_limit = 0;      // [N s] most that friction could have made of them, with what a dent adds
  Vec3 impulse = Vec3::Zero();    // [N s] on a, world, since the snapshot before: the sum of vectors, which may turn meanwhile
  double energy_lost = 0;         // [J] since the snapshot before: minus the work of the impulse on both. Deformation and friction;
                                  // what is elastic comes back
  double slip = 0;                // [m/s]
  double begun = 0;               // [s] when the first of those impulses began to act
  ContactState state = ContactState::approach;
  bool exchange = false;  // at one instant, by Kudlich-Slibar
};

struct WheelRecord {
  int vehicle = 0;
  int wheel = 0;
  Vec3 hub = Vec3::Zero();      // [m] world, where the wheel's centre is now (suspension moved)
  Vec3 contact = Vec3::Zero();  // [m] world
  double steer = 0;             // [rad]
  double spin = 0;              // [rad] turned since t = 0, for the picture
  double load = 0;              // [N]
  double longitudinal = 0;      // [N]
  double lateral = 0;           // [N]
  double slip = 0;              // [m/s] of the tyre over the road; > 0 draws a skid mark
};

/// Energies [J]; `dissipated` by effect, in the order of Recording::effect_names.
struct Energies {
  double kinetic = 0;
  double potential = 0;  // gravity and springs
  std::vector<double> dissipated;
  double added = 0;     // by drive and other sources
  double residual = 0;  // what the ledger cannot explain: (kinetic + potential) - initial + sum(dissipated) - added
};

struct Snapshot {
  double time = 0;  // [s]
  BodyStates bodies;
  std::vector<ContactRecord> contacts;
  std::vector<WheelRecord> wheels;
  std::vector<Vec3> tyre_impulse;  // [N s] world, per vehicle: of all its tyres since the snapshot before
  Energies energies;
};

/// Something that happened at one instant: "first_contact", "head_impact", "ground_contact", "release", "rest", "impact", "warning"
/// ...
struct Event {
  double time = 0;
  std::string kind;
  int body_a = -1;
  int body_b = -1;  // -1: the ground or nothing
  Vec3 point = Vec3::Zero();
  double value = 0;  // what the kind says: closing speed [m/s] of contacts, speed [m/s] of the head's centre of a head impact
  Vec3 normal = Vec3::Zero();    // unit, from b to a, of what touches
  Vec3 velocity = Vec3::Zero();  // [m/s] head impact: of the head's centre seen from the struck surface, just before
};

struct PlanLine {
  std::string effect;
  bool active = false;
  bool forced = false;
  std::string reason;
  std::string left_out;  // what is not computed, with its bound
  bool called_for = false;
  double not_before = 0;  // [s] it cannot matter earlier, proved before the run

  /// What a run saw of an effect that acts by contacts, stops or wheels; a time below zero: never.
  struct Acted {
    bool told = false;             // it is of that kind, and there was a run
    double in_reach = -1;          // [s] first it had anything to look after
    double first = -1, last = -1;  // [s] it exchanged an impulse
  } acted;

  bool forced_off() const { return forced && !active; }
  bool idle() const { return active && !called_for; }  // switched on by the author
};

struct EffectCost {
  std::string effect;
  long calls = 0;
  double wall_s = 0;
};

struct Diagnostics {
  double max_joint_gap = 0;          // [m]
  double max_joint_angle_error = 0;  // [rad] beyond constraint or limit
  double max_penetration = 0;        // [m]
  double rest_penetration = 0;       // [m] at the last snapshot
  double max_compression = 0;        // [m] compliant law: deepest contact, of both surfaces together
  double max_solver_residual = 0;    // [m/s]
  double max_energy_rise = 0;        // [J] largest rise of the mechanical energy between two snapshots that no source explains
  double energy_turned_over = 0;     // [J] most that was moving, given off or put in at a snapshot
  double max_unexplained = 0;        // [J] most at a snapshot, of either sign, that the ledger cannot explain
  double max_effect_gain = 0;        // [J] most that an effect which has no energy to give gave in a step
  long contact_sweeps = 0;
  long newton_steps = 0;        // of the contact solver
  long restitution_scaled = 0;  // impacts whose restitution was lowered because Newton's rule would have created energy
  long substeps = 0;            // steps divided to place an impact or to hold a bound
  std::vector<std::string> warnings;
};

/// Why a run ended before its time: which body, when, in which effect.
struct Failure {
  double time = 0;
  std::string body;
  std::string effect;
  std::string message;
};

/// The step that took longest to compute, where the caller handed in clocks. Not the same from run to run.
struct LongestStep {
  double processor_s = 0;           // [s]
  double time = 0;                  // [s] at its end
  std::vector<std::string> bodies;  // that had most contacts and limits in it, or turned fastest
};

/// Acceleration of the centre of a person's head over each step: what head injury criteria integrate. Only with the compliant law.
struct HeadMotion {
  int person = 0;
  std::vector<double> time;          // [s] the start, and the end of each step
  std::vector<double> acceleration;  // [m/s^2] magnitude of the mean over the step that ends then
};

struct Recording {
  std::vector<std::string> body_names;
  std::vector<std::string> vehicle_names;
  std::vector<std::string> effect_names;  // of the plan, order of Energies::dissipated
  double interval = 0;                    // [s] between snapshots
  std::vector<Snapshot> snapshots;        // never empty after simulate()
  std::vector<Event> events;
  std::vector<HeadMotion> heads;
  std::vector<double> peak_acceleration;  // [m/s^2] per body: largest mean over a step; with the compliant law and persons only
  std::vector<PlanLine> plan;
  std::vector<EffectCost> costs;   // of the effects of the plan; wall_s only when a clock was handed in
  std::vector<EffectCost> phases;  // of what serves several effects at once
  Diagnostics diagnostics;
  std::optional<LongestStep> longest_step;
  long steps = 0;
  double wall_s = 0;  // filled by the caller: the engine has no clock
  std::optional<Failure> failure;

  /// State at any time: poses between snapshots by cubic Hermite (positions) and slerp (attitudes), contacts and wheel forces of
  /// the later snapshot of the interval. Velocities are linear between them, but for an impact at an instant: before
  /// it those of the earlier one, from it on those of the later one. Clamped to the recorded span.
  Snapshot at(double time) const;
  double end_time() const { return snapshots.back().time; }
};

/// FNV-1a over every bit of the trajectory (times, poses, velocities, impulses): equal hash, equal run.
std::uint64_t hash(const Recording&);

}  // namespace engine
