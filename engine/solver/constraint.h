// Conditions that act by impulses at the end of a step: contacts, limits, wheels, closed loops.
#pragma once

#include <cstdint>
#include <limits>
#include <tuple>

#include "engine/geometry/shape_pair.h"
#include "engine/math/types.h"

namespace engine {

/// contact: rows normal, two tangents, Coulomb cone. wheel: the same with a soft normal (suspension) and a bound along its rolling
/// direction (brake). limit: one row, impulse >= 0. bilateral: one row, any impulse.
enum class ConstraintKind { contact, wheel, limit, bilateral };

/// Relative velocity of a against b along row r: u_r = J_a.row(r) V_a + J_b.row(r) V_b. Filled once a step, kept in one arena.
struct Constraint {
  ConstraintKind kind = ConstraintKind::contact;
  int rows = 3;
  bool slides = false;  // limit: the end of a slide [m], not of a turn [rad]
  bool rolls = false;   // contact: of a wheel on its tread, without friction
  int body_a = -1;      // -1: the world
  int body_b = -1;
  Eigen::Matrix<double, 3, 6, Eigen::RowMajor> J_a = Eigen::Matrix<double, 3, 6>::Zero();  // first `rows` rows
  Eigen::Matrix<double, 3, 6, Eigen::RowMajor> J_b = Eigen::Matrix<double, 3, 6>::Zero();
  Vec3 point = Vec3::Zero();      // [m] world
  Mat3 frame = Mat3::Identity();  // columns: normal, t1, t2 (contacts and wheels)
  double gap = 0;                 // [m] or [rad]; negative: penetration, beyond the limit
  double friction = 0;            // [-] with what ploughing adds
  double ploughing = 0;           // [-] share of it: of a part that lies in a dent of a panel
  double restitution = 0;         // [-]
  double share_a = 0.5;           // [-] of the depth, by which surface a gives way
  double softness = 0;            // [1/kg] added to the normal's own response: 1 / (dt (k dt + c))
  double target = 0;              // [m/s] what u_0 + softness * impulse must reach
  double stiffness = 0;           // [N/m] compliant contact, both surfaces in series; [N m/rad] compliant stop; 0: rigid
  double hysteresis = 0;          // [-] compliant contact: share of the energy that comes back
  double thickness = std::numeric_limits<double>::infinity();  // [m] depth at which what yields has gone through
  double room = 0;                                             // [m] depth at which what yields bottoms out; 0: never
  double struck_mass = 0;        // [kg] that a contact with room stops by itself: of its bodies were they free, its share of it
  double free_response = 0;      // [1/kg] contact, compliant stop or wheel: of its two bodies were they free of joints
  double whole_response = 0;     // [1/kg] contact: of all that hangs on its bodies, moving as one
  double rolling_bound = 0;      // [N s] wheel: most that brake can give along t1
  double rolling_drive = 0;      // [N s] wheel: what the engine gives along t1
  double grip_softness = 0;      // [1/kg] wheel: added to the lateral's own response: a tyre needs slip to give a force
  Vec3 impulse = Vec3::Zero();   // [N s] result, in row coordinates
  double push = 0;               // [N s^2] moves bodies apart that stand inside each other, without giving them speed
  Vec3 u_before = Vec3::Zero();  // [m/s] at the start of the step
  Vec3 u_smooth = Vec3::Zero();  // [m/s] at its end under smooth forces alone
  Vec3 u_free = Vec3::Zero();    // [m/s] the same with joint resistance: what the solver starts from
  Vec3 u_after = Vec3::Zero();   // [m/s] with them
  std::uint64_t key = 0;
  int effect = 0;                    // index into Plan::active
  ShapePair shapes;                  // contact
  int record_a = -1, record_b = -1;  // bodies named in the record (fixed ones too)
  int wheel = -1;                    // running number of the wheel

  /// What a contact or limit is when it is found; the rest is of the step that solves it.
  template <class S>
  static auto fields(S& s) {
    return std::tie(s.kind, s.rows, s.slides, s.rolls, s.body_a, s.body_b, s.J_a, s.J_b, s.point, s.frame, s.gap, s.friction,
                    s.ploughing, s.restitution, s.stiffness, s.hysteresis, s.room, s.struck_mass, s.share_a, s.thickness,
                    s.free_response, s.whole_response, s.key, s.effect, s.shapes, s.record_a, s.record_b);
  }
};

inline bool is_contact(const Constraint& c) {
  return c.kind == ConstraintKind::contact;
}

/// The end of an articulation angle's range.
inline bool is_angular_limit(const Constraint& c) {
  return c.kind == ConstraintKind::limit && !c.slides;
}

/// A contact or limit whose depth is a deformation, not an error.
inline bool is_compliant(const Constraint& c) {
  return c.stiffness > 0;
}

}  // namespace engine
