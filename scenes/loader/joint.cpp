// [[joint]]: between two bodies, or a body and the world.
#include <fmt/format.h>

#include "engine/joints/joint_type.h"
#include "scenes/loader/builder.h"

namespace scenes {
namespace {

constexpr Key kStiffness = bound<&engine::JointCoordinate::stiffness>(
    {"stiffness", Type::number, Dimension::angular_stiffness, "", "Resistive spring torque per angle.", kNotNegative});
constexpr Key kRest =
    bound<&engine::JointCoordinate::rest>({"rest", Type::number, Dimension::angle, "", "Angle at which the spring is slack."});
constexpr Key kDamping = bound<&engine::JointCoordinate::damping>(
    {"damping", Type::number, Dimension::angular_damping, "", "Resistance per angular speed.", kNotNegative});
constexpr Key kFriction = bound<&engine::JointCoordinate::friction>(
    {"friction_torque", Type::number, Dimension::torque, "", "Constant resistance against turning.", kNotNegative});
constexpr Key kRange = bound_to_ends<&engine::JointCoordinate::lower, &engine::JointCoordinate::upper>(
    {"range", Type::range, Dimension::angle, "", "Lower and upper limit of the angle. Left out: free."});

const Key kAngleKeys[] = {kRange, kStiffness, kRest, kDamping, kFriction};
const Section kAngleSection{
    "joint.angle", "[joint.x]",
    "One articulation angle, also [joint.y], [joint.z]: swing about x, swing about y, twist about z of the joint frame. "
    "What is not given here is taken from the joint.",
    kAngleKeys};

const Key kSlideKeys[] = {
    bound_to_ends<&engine::JointCoordinate::lower, &engine::JointCoordinate::upper>(
        {"range", Type::range, Dimension::length, "", "Lower and upper limit of the way. Left out: free."}),
    bound<&engine::JointCoordinate::stiffness>(
        {"stiffness", Type::number, Dimension::stiffness, "0", "Resistive spring force per way.", kNotNegative}),
    bound<&engine::JointCoordinate::rest>({"rest", Type::number, Dimension::length, "0", "Way at which the spring is slack."}),
    bound<&engine::JointCoordinate::damping>(
        {"damping", Type::number, Dimension::damping, "0", "Resistance per speed.", kNotNegative}),
    bound<&engine::JointCoordinate::friction>(
        {"friction", Type::number, Dimension::force, "0", "Constant resistance against sliding.", kNotNegative}),
    bound<&engine::JointCoordinate::stop_stiffness>(
        {"stop_stiffness", Type::number, Dimension::stiffness, "0",
         "Of the stops at the ends of the range, compliant contact law only; 0: rigid, as they are with Default-Auto.",
         kNotNegative}),
};
}  // namespace

const Section kSlideSection{"joint.slide", "[joint.slide]",
                            "The slide of a prismatic, cylindrical or spinal joint: the way of the joint's centre since the start, "
                            "along axis or a spine's z.",
                            kSlideKeys};

namespace {

/// What the joint's frames follow from, in the world at the start.
struct JointPlace {
  std::optional<engine::Vec3> at;            // [m]
  engine::Vec3 axis = engine::Vec3::Zero();  // need not be unit
  std::optional<engine::Vec3> second_axis;   // need not be unit
};

const Key kJointKeys[] = {
    bound<&engine::Joint::name>({"name", Type::text, Dimension::none, "''", "Name in messages; left out: parent-child."}),
    bound<&engine::Joint::kind>(
        {"kind", Type::choice, Dimension::none, "'spherical'",
         "What it leaves: turns about axis; a cardan cross; all turns; all with limits; nothing; sliding along axis; sliding and "
         "turning; all with limits and sliding along z.",
         kAny, "revolute|universal|spherical|ragdoll|fixed|prismatic|cylindrical|spinal"}),
    {"parent", Type::text, Dimension::none, "'world'", "A body, or the world."},
    {"child", Type::text, Dimension::none, kRequired, "The body that hangs on the parent."},
    bound<&JointPlace::at>({"at", Type::vector3, Dimension::length, "",
                            "The joint's centre at the start, in the world. Left out: the child's centre."}),
    bound<&JointPlace::axis>(
        {"axis", Type::vector3, Dimension::none, "[0, 1, 0]",
         "World direction of the joint frame's y at the start: what a revolute turns about and a prismatic slides along, the "
         "parent's arm of a cardan cross."}),
    bound<&JointPlace::second_axis>(
        {"second_axis", Type::vector3, Dimension::none, "",
         "World direction of the joint frame's x, at right angles to axis: the child's arm of a cardan cross."}),
    kRange,
    kStiffness,
    kRest,
    kDamping,
    kFriction,
    bound<&engine::JointCoordinate::stop_stiffness>(
        {"stop_stiffness", Type::number, Dimension::angular_stiffness, "0",
         "Of the stops at the ends of the ranges, compliant contact law only; 0: rigid, as they are with Default-Auto.",
         kNotNegative}),
    {"x", Type::table, Dimension::none, "", "The first swing angle.", kAny, {}, &kAngleSection},
    {"y", Type::table, Dimension::none, "", "The second swing angle; the angle of a revolute.", kAny, {}, &kAngleSection},
    {"z", Type::table, Dimension::none, "", "The twist.", kAny, {}, &kAngleSection},
    {"slide", Type::table, Dimension::none, "", "The slide of a prismatic, cylindrical or spinal joint.", kAny, {}, &kSlideSection},
};

constexpr std::array<std::string_view, 3> kAngleNames{"x", "y", "z"};

engine::Quat frame_at(Reader& r, const JointPlace& place) {
  if (place.axis.norm() < 1e-9) {
    r.fail("axis", "must have a direction");
    return engine::Quat::Identity();
  }
  const engine::Vec3 y_W = place.axis.normalized();
  // any direction across will do when none is asked for: the world axis farthest from y
  engine::Vec3 x = std::abs(y_W.x()) < 0.9 ? engine::Vec3::UnitX() : engine::Vec3(0, -1, 0);
  if (const auto& given = place.second_axis) {
    if (std::abs(given->normalized().dot(y_W)) > 1e-6 || given->norm() < 1e-9)
      r.fail("second_axis", "must stand at right angles to axis");
    x = *given;
  }
  engine::Mat3 frame;
  const engine::Vec3 x_W = (x - y_W * x.dot(y_W)).normalized();
  frame << x_W, y_W, x_W.cross(y_W);
  return engine::Quat(frame).normalized();
}

}  // namespace

int find_body(Builder& builder, Reader& r, std::string_view key) {
  const std::string name = r.text(key);
  if (name == "world" && key == "parent") return -1;
  const int index = builder.body_index(name);
  const bool told = !builder.errors.empty() && builder.is_declared(name);
  if (index < 0 && !told) {
    const std::string guess = nearest(name, builder.body_names());
    r.fail(key, guess.empty() ? "is no body of the scene" : fmt::format("is no body of the scene; did you mean \"{}\"?", guess));
  }
  return index;
}

const Section kJointSection{"joint", "[[joint]]",
                            "Ties a body to another or to the world. All angles are zero in the pose at the start.", kJointKeys};

namespace {

void refuse_what_is_not_free(Reader& r, const engine::Joint& joint) {
  const engine::JointType& type = engine::type_of(joint.kind);
  const auto free = engine::joint_coordinates(joint, {}, {}).free;
  const std::string slides = type.slides() > 0 ? "; what is of its slide stands in [joint.slide]" : "";
  for (const std::string_view key : {"range", "stiffness", "rest", "damping", "friction_torque", "stop_stiffness"})
    if (type.turns() == 0 && r.has(key)) r.fail(key, fmt::format("a {} joint does not turn{}", type.name, slides));
  for (std::size_t i = 0; i < kAngleNames.size(); ++i)
    if (!free[i] && r.has(kAngleNames[i]))
      r.fail(kAngleNames[i], fmt::format("a {} joint does not turn about {}", type.name, kAngleNames[i]));
  if (type.slides() == 0 && r.has("slide"))
    r.fail("slide", fmt::format("a {} joint does not slide; prismatic, cylindrical and spinal ones do", type.name));
}

}  // namespace

void read_joint(Builder& builder, Reader r) {
  engine::Joint joint;
  JointPlace place;
  r.fill(joint);
  r.fill(place);
  joint.parent = find_body(builder, r, "parent");
  joint.child = find_body(builder, r, "child");
  if (!r.has("name")) joint.name = r.text("parent") + "-" + r.text("child");
  refuse_what_is_not_free(r, joint);
  const bool complete = joint.child >= 0 && (joint.parent >= 0 || r.text("parent") == "world");
  if (!complete) return;
  if (joint.child == joint.parent) r.fail("child", "must be another body than the parent");
  const engine::Body& child = builder.scene.model.bodies[static_cast<std::size_t>(joint.child)];
  const engine::Pose X_WF{place.at.value_or(child.X_WB.p), frame_at(r, place)};
  joint.X_CF = child.X_WB.inverse() * X_WF;
  joint.X_PF = joint.parent < 0 ? X_WF : builder.scene.model.bodies[static_cast<std::size_t>(joint.parent)].X_WB.inverse() * X_WF;
  engine::JointCoordinate all;
  r.fill(all);
  joint.angles.fill(all);
  for (std::size_t i = 0; i < kAngleNames.size(); ++i)
    if (auto angle = r.table(kAngleNames[i])) angle->fill(joint.angles[i]);
  if (auto slide = r.table("slide")) slide->fill(joint.slide);
  builder.scene.model.joints.push_back(std::move(joint));
}

}  // namespace scenes
