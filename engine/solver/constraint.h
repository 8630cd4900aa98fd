// Conditions that act by impulses at the end of a step: contacts, limits, wheels, closed loops.
#pragma once

#include <cstdint>
#include <limits>
#include <tuple>

#include "engine/geometry/shape_pair.h"
#include "engine/math/types.h"
#include "engine/model/model.h"

namespace engine {

/// contact: rows normal, two tangents, Coulomb cone. wheel: the same with a soft normal (suspension) and a bound along its rolling
/// direction (brake). limit: one row, impulse >= 0. bilateral: one row, any impulse.
enum class ConstraintKind { contact, wheel, limit, bilateral };

/// One of the two bodies of a condition.
struct ConstraintSide {
  int body = -1;    // -1: the world, or a body that is fixed
  int record = -1;  // body named in the record (fixed ones too)
  Eigen::Matrix<double, 3, 6, Eigen::RowMajor> J = Eigen::Matrix<double, 3, 6>::Zero();  // first Constraint::rows rows
};

/// Of the two surfaces of a contact.
struct TouchingSurfaces {
  double friction = 0;                                    // [-] with what ploughing adds
  double ploughing = 0;                                   // [-] share of it: of a part that lies in a dent of a panel
  double restitution = 0;                                 // [-]
  bool rolls = false;                                     // a wheel on its tread, without friction
  double held = std::numeric_limits<double>::infinity();  // [-] friction at most: a wheel that turns holds what the road gives it
};

/// Of a contact or stop whose depth is a deformation.
struct YieldingSpring {
  double stiffness = 0;                                        // [N/m] both surfaces in series; [N m/rad] stop; 0: rigid
  double yield = std::numeric_limits<double>::infinity();      // [N] force that a contact does not grow beyond, but by bottoming
  double hysteresis = 0;                                       // [-] share of the energy that comes back
  double share_a = 0.5;                                        // [-] of the depth, by which surface a gives way
  double thickness = std::numeric_limits<double>::infinity();  // [m] depth at which what yields has gone through
  double room = 0;                                             // [m] depth at which what yields bottoms out; 0: never
  double loading = 0;                                          // [N/m] of a vehicle's panel and the part on it before it yields
  double force = 0;                                            // [N] of the two at this depth, before several points share it
  double reached = 1;      // [-] share of it: of a panel that has not been pressed in by all of the depth
  double struck_mass = 0;  // [kg] that a contact with room stops by itself: of its bodies were they free, its share of it
};

/// How the bodies answer an impulse along the first row [1/kg].
struct ConstraintResponse {
  double free = 0;   // contact, compliant stop or wheel: were the two free of joints
  double whole = 0;  // contact: of all that hangs on them, moving as one
};

/// What only a wheel has.
struct WheelRows {
  int index = -1;            // of State::wheels
  double braking = 0;        // [N s] most that the brake can give along t1
  double driving = 0;        // [N s] what the engine gives along t1
  double grip_softness = 0;  // [1/kg] added to the lateral's own response: a tyre needs slip to give a force
};

/// Relative velocities along the rows [m/s].
struct RowVelocities {
  Vec3 before = Vec3::Zero();  // at the start of the step
  Vec3 smooth = Vec3::Zero();  // at its end under smooth forces alone
  Vec3 free = Vec3::Zero();    // the same with joint resistance: what the solver starts from
  Vec3 after = Vec3::Zero();   // with the impulses
};

/// Relative velocity of a against b along row r: u_r = a.J.row(r) V_a + b.J.row(r) V_b. Filled once a step, kept in one arena.
struct Constraint {
  ConstraintKind kind = ConstraintKind::contact;
  int rows = 3;
  bool slides = false;  // limit: the end of a slide [m], not of a turn [rad]
  ConstraintSide a, b;
  Vec3 point = Vec3::Zero();      // [m] world
  Mat3 frame = Mat3::Identity();  // columns: normal, t1, t2 (contacts and wheels)
  double gap = 0;                 // [m] or [rad]; negative: penetration, beyond the limit
  ShapePair shapes;               // contact
  TouchingSurfaces surface;
  YieldingSpring spring;
  ConstraintResponse response;
  WheelRows wheel;
  double softness = 0;  // [1/kg] added to the normal's own response: 1 / (dt (k dt + c))
  double target = 0;    // [m/s] what u_0 + softness * impulse must reach
  RowVelocities u;
  Vec3 impulse = Vec3::Zero();  // [N s] result, in row coordinates
  double push = 0;              // [N s^2] moves bodies apart that stand inside each other, without giving them speed
  std::uint64_t key = 0;
  int effect = 0;  // index into Plan::active

  /// What a contact or limit is when it is found; the rest is of the step that solves it.
  template <class S>
  static auto fields(S& s) {
    return std::tie(s.kind, s.rows, s.slides, s.surface.rolls, s.a.body, s.b.body, s.a.J, s.b.J, s.point, s.frame, s.gap,
                    s.surface.friction, s.surface.ploughing, s.surface.restitution, s.surface.held, s.spring.stiffness,
                    s.spring.yield, s.spring.hysteresis, s.spring.room, s.spring.struck_mass, s.spring.share_a, s.spring.thickness,
                    s.response.free, s.response.whole, s.key, s.effect, s.shapes, s.a.record, s.b.record);
  }
};

/// Names the two bodies of a condition; -1: the ground.
inline void set_bodies(Constraint& c, const Model& model, int a, int b) {
  const auto moving = [&model](int body) { return body >= 0 && !model.bodies[body].fixed ? body : -1; };
  c.a.record = a;
  c.b.record = b;
  c.a.body = moving(a);
  c.b.body = moving(b);
}

inline bool is_contact(const Constraint& c) {
  return c.kind == ConstraintKind::contact;
}

/// The end of an articulation angle's range.
inline bool is_angular_limit(const Constraint& c) {
  return c.kind == ConstraintKind::limit && !c.slides;
}

/// A contact or limit whose depth is a deformation, not an error.
inline bool is_compliant(const Constraint& c) {
  return c.spring.stiffness > 0;
}

}  // namespace engine
