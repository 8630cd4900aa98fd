// A person as data: segments and joints of the library file, sized for one stature and mass. No place in the world yet.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/model/joint.h"
#include "scenes/loader/builder.h"

namespace scenes {

/// One anatomical angle: a word, the standing person's axis it turns about, and its range of motion.
struct AnatomicalAngle {
  std::string name;   // "flexion"
  engine::Vec3 axis;  // unit, positive turn in the sense of the word
  double lower = 0;   // [rad]
  double upper = 0;   // [rad]
  std::string word;   // of poses: "left_knee_flexion"; angles of several joints that share one take an even part each
};

struct Segment {
  std::string name;     // "left_thigh"
  engine::Vec3 centre;  // [m] standing, soles at z = 0
  engine::HyperEllipsoid shape;
  double mass = 0;       // [kg]
  double stiffness = 0;  // [N/m]
  engine::Mat3 inertia = engine::Mat3::Zero();
  render::Material material;
};

struct FigureJoint {
  std::string name;  // "left_hip"
  int parent = 0;    // segments
  int child = 0;
  engine::Vec3 at;                      // [m] standing
  std::vector<AnatomicalAngle> angles;  // one: revolute; two: universal; three: ragdoll; applied in this order
  double damping = 0;                   // [N m s/rad]
  double friction_torque = 0;           // [N m]
  double stiffness = 0;                 // [N m/rad]
  double stop_stiffness = 0;            // [N m/rad]
  engine::PassiveTorque passive = engine::PassiveTorque::none;
  double passive_share = 1;                      // [-] of an adult's
  std::optional<engine::JointCoordinate> slide;  // of the child along z of the standing person; as wide as the ranges say
};

struct Figure {
  std::vector<Segment> segments;    // the root first
  std::vector<FigureJoint> joints;  // parents before children
};

struct PersonSize {
  double stature = 1.75;  // [m]
  double mass = 78;       // [kg]
  bool female = false;
};

/// Reads scenes/library/persons/NAME.toml (or the scene's own) and sizes it by the person's stature, mass and sex; what of them is
/// left out is the file's own. An empty figure after an error, which is collected.
Figure read_figure(Builder&, Reader& person, PersonSize&);

extern const Section kFigureSection, kPoseSection, kAnglesSection;

/// Attitude of the child in the parent's axes for angles in the joint's order [rad].
engine::Quat articulation(const FigureJoint&, const std::vector<double>& angles);

/// The engine's joint: frame in the middle of the range, limits that hold every motion in one plane and the pose at the start.
engine::Joint engine_joint(const Figure&, const FigureJoint&, const std::vector<double>& start_angles);

/// Angles of a pose by joint and angle, in the order of the figure; and the attitude of the root.
struct Pose {
  std::string title;
  std::vector<std::vector<double>> angles;
  double roll = 0;  // [rad] of the root: about x (forward), then pitch about y (left)
  double pitch = 0;
};

/// The named pose with the person's own `angles` on top; angles outside the range of motion are refused, naming the joint.
Pose read_pose(Builder&, Reader& person, const Figure&);

/// Attitudes and centres of all segments with the hips' centre at the origin.
std::vector<engine::Pose> placed(const Figure&, const Pose&, const engine::Quat& q_root);
engine::Vec3 centre_of_gravity(const Figure&, const std::vector<engine::Pose>& X_WB);
/// How high a person is at the start.
struct Standing {
  double height = 0;                // [m] of the lowest point above the ground
  std::optional<double> cg_height;  // [m] of the centre of gravity above z = 0, in its place
};
/// Height [m] of what carries a person or a wheel at x, y; none over a hole.
std::optional<double> ground_beneath(const engine::Ground&, double x, double y);

/// Moves the person to its position and down to the ground, or to the height the scene gives.
void set_down(Reader&, const engine::Vec3& position, const engine::Ground&, const Figure&, std::vector<engine::Pose>& X_WB);
/// The vehicle ridden, -1: none.
int find_mount(Builder&, Reader&);
/// Above what force a rider's joints with the mount let go [N].
struct Hold {
  double hand = 0, foot = 0, seat = 0;
};
/// Joints of hands, feet and seat with the mount, breakable; the mount waits in the zero condition with its rider.
void hold_on(Builder&, const Hold&, int mount, engine::Person&);

}  // namespace scenes
