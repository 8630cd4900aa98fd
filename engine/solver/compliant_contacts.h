// Compliant contacts as forces in the stages of Runge and Kutta (schemes rk4 and adaptive). With events located every contact keeps
// its phase through a step, so that each stage sees one smooth law, and the step ends where a phase does: touch, turn, separation.
#pragma once

#include <functional>
#include <vector>

#include "engine/laws/compliant_contact.h"
#include "engine/world.h"

namespace engine {

class CompliantContacts {
 public:
  /// Looks for contacts at poses and velocities, and for what could become one within a time: appends to the list.
  using Finder = std::function<void(const State&, double within, std::vector<Constraint>&)>;

  CompliantContacts(const Model&, Finder);

  /// Begins a step from `state`: which contacts are in which phase.
  void begin(const World&, const State&, bool keep_phases);

  /// Begins an integration over h: what was exchanged by another that was thrown away is forgotten.
  void restart(double h) { exchanged_.clear(), h_ = h; }
  /// The same for a further part of the same integration.
  void next_part(double h) { h_ = h; }

  /// Forces at a stage, with its weight [-] in the step's mean force: what was exchanged is summed for the record.
  void add_forces(const World&, const std::vector<Pose>&, const std::vector<Twist>&, double weight, std::vector<Vec6>& force);

  /// An event of a contact before the end of a step: how far its function is past zero at the end, and was before zero at the
  /// start.
  struct Crossing {
    std::uint64_t key = 0;
    int kind = 0;  // 0 gap, 1 speed
    double start = 0, end = 0;
  };
  /// The crossing that comes first by linear interpolation; false if there is none.
  bool first_crossing(const State& end, Crossing&);
  /// Its function at another end; NaN if the contact is not found there.
  double crossing_at(const State& end, const Crossing&);

  /// Ends the step at `end`, where `crossing` (may be null) happens: phases move on, what was exchanged goes to `done` with its
  /// work to the books.
  void finish(World&, const State& end, const Crossing* crossing, std::vector<Constraint>& done);

  /// Largest angular frequency [rad/s] of a contact's spring on its bodies, of those present at the last look.
  double fastest_spring() const { return fastest_spring_; }
  /// The lighter of those bodies, and the effect whose contact it is.
  int sprung_body() const { return sprung_body_; }
  int sprung_by() const { return sprung_by_; }

 private:
  struct Touch {
    std::uint64_t key;
    ContactPhase phase;
    double gap, speed;  // at the start of the step
  };
  struct Exchange {
    Constraint contact;
    Vec3 impulse_W = Vec3::Zero();
    double work = 0;
  };
  void look(const State&, double within = 0);
  ContactPhase phase_now(const Constraint&, double separating) const;
  bool slow(const Constraint&, double separating, double share) const;
  Touch* known(std::uint64_t key);

  const Model& model_;
  Finder finder_;
  State stage_;
  std::vector<Constraint> found_;
  std::vector<Touch> touches_, next_touches_;  // sorted by key
  std::vector<Exchange> exchanged_;
  std::vector<double> carried_;  // [kg] per body: it and what hangs on it by joints
  double h_ = 0;
  bool keep_phases_ = true;
  double rest_speed_ = 0, smoothing_ = 0;
  double fastest_spring_ = 0;
  int sprung_body_ = -1, sprung_by_ = -1;
};

}  // namespace engine
