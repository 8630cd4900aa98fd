// Compliant contacts as forces in the stages of Runge and Kutta (schemes rk4 and adaptive). With events located every contact keeps
// its phase through a step, so that each stage sees one smooth law, and the step ends where a phase does: touch, turn, separation.
#pragma once

#include <vector>

#include "engine/laws/compliant_contact.h"
#include "engine/world.h"

namespace engine {

class CompliantContacts {
 public:
  explicit CompliantContacts(World&);

  /// Begins a step from `state`: which contacts are in which phase.
  void begin(State&, bool keep_phases);

  /// Begins an integration over h: what was exchanged by another that was thrown away is forgotten.
  void restart(double h) { exchanged_.clear(), h_ = h; }
  /// The same for a further part of the same integration.
  void next_part(double h) { h_ = h; }

  /// Forces at a stage, with its weight [-] in the step's mean force: what was exchanged is summed for the record.
  void add_forces(const std::vector<Pose>&, const std::vector<Twist>&, double weight, std::vector<Vec6>& force);

  /// After each part of an integration: what the impulses exchanged in it did to bodies that moved like this at its start and end.
  /// `lifted` [J]: what gravity did more over the mean of both velocities than over the way the bodies went.
  void end_part(const std::vector<Twist>& V_start, const std::vector<Twist>& V_end, double lifted);

  /// An event of a contact before the end of a step: how far its function is past zero at the end, and was before zero at the
  /// start.
  struct Crossing {
    std::uint64_t key = 0;
    int kind = 0;  // 0 gap, 1 speed
    double start = 0, end = 0;
  };
  /// The crossing that comes first by linear interpolation; false if there is none.
  bool first_crossing(const Motion& end, Crossing&);
  /// Its function at another end; NaN if the contact is not found there.
  double crossing_at(const Motion& end, const Crossing&);

  /// Ends the step at `end`, where `crossing` (may be null) happens: phases move on, what was exchanged goes to `done` with its
  /// work to the books.
  void finish(const Motion& end, const Crossing* crossing, std::vector<Constraint>& done);

  /// Largest angular frequency [rad/s] of a contact's spring on its bodies, of those present at the last look.
  double fastest_spring() const { return fastest_spring_; }
  /// The lighter of those bodies, and the effect whose contact it is.
  int sprung_body() const { return sprung_body_; }
  int sprung_by() const { return sprung_by_; }

 private:
  using Touch = ContactPhaseMemory;
  struct Exchange {
    Constraint contact;
    Vec3 impulse_W = Vec3::Zero();
    double work = 0;                                // [J]
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();  // [N s], [N m s] of the part under way, on either body
    double pressed = 0;                             // [N s] of the part
  };
  void look(const Motion&, double within = 0);
  Vec3 force_of(const Constraint&, const Vec3& u, ContactPhase) const;
  void exchange(const Constraint&, const Vec3& force, double weight);
  ContactPhase phase_after(const Constraint&, double speed, const Crossing*);
  ContactPhase phase_now(const Constraint&, double separating) const;
  bool slow(const Constraint&, double separating, double share) const;
  Touch* known(std::uint64_t key);

  World& world_;
  const Model& model_;
  State* state_ = nullptr;  // of the step under way
  Motion stage_;
  std::vector<Constraint> found_;
  std::vector<Touch> next_touches_;  // sorted by key
  std::vector<Exchange> exchanged_;
  std::vector<double> carried_;  // [kg] per body: it and what hangs on it by joints
  double h_ = 0;
  bool keep_phases_ = true;
  double rest_speed_ = 0, smoothing_ = 0;
  double fastest_spring_ = 0;
  int sprung_body_ = -1, sprung_by_ = -1;
};

}  // namespace engine
