// Where a person is at the start: set down on the ground, or on a vehicle it rides.
#include "scenes/loader/figure.h"

namespace scenes {

std::optional<double> ground_beneath(const engine::Ground& ground, double x, double y) {
  const double top = std::max(ground.height, ground.terrain ? ground.terrain->bounds().upper.z() : 0) + 1;
  return ground.height_below({x, y, top});
}

namespace {

double ground_height(const engine::Ground& ground, double x, double y) {
  return ground_beneath(ground, x, y).value_or(0);
}

/// How far the lowest support point stands above the ground.
double clearance(const engine::Ground& ground, const Figure& figure, const std::vector<engine::Pose>& X_WB) {
  double least = 1e300;
  for (std::size_t i = 0; i < X_WB.size(); ++i) {
    const engine::Vec3 p =
        X_WB[i] * engine::support_point(figure.segments[i].shape, X_WB[i].q.conjugate() * -engine::Vec3::UnitZ());
    least = std::min(least, p.z() - ground_height(ground, p.x(), p.y()));
  }
  return least;
}

}  // namespace

std::vector<engine::Pose> placed(const Figure& figure, const Pose& pose, const engine::Quat& q_root) {
  std::vector<engine::Pose> out(figure.segments.size());
  out[0].q = q_root;
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    const FigureJoint& j = figure.joints[i];
    const engine::Pose& X_WP = out[static_cast<std::size_t>(j.parent)];
    const engine::Vec3 p_WJ = X_WP * (j.at - figure.segments[static_cast<std::size_t>(j.parent)].centre);
    const engine::Quat q = (X_WP.q * articulation(j, pose.angles[i])).normalized();
    out[static_cast<std::size_t>(j.child)] = {p_WJ - q * (j.at - figure.segments[static_cast<std::size_t>(j.child)].centre), q};
  }
  return out;
}

engine::Vec3 centre_of_gravity(const Figure& figure, const std::vector<engine::Pose>& X_WB) {
  engine::Vec3 sum = engine::Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < X_WB.size(); ++i) {
    sum += figure.segments[i].mass * X_WB[i].p;
    mass += figure.segments[i].mass;
  }
  return sum / mass;
}

void set_down(Reader& r, const engine::Vec3& position, const engine::Ground& ground, const Figure& figure,
              std::vector<engine::Pose>& X_WB) {
  Standing given;
  r.fill(given);
  for (engine::Pose& X : X_WB) X.p += position;
  double up = given.height - clearance(ground, figure, X_WB);
  if (given.cg_height) {
    if (r.has("height")) r.fail("cg_height", "must not be given together with height");
    up = *given.cg_height - centre_of_gravity(figure, X_WB).z();
  }
  for (engine::Pose& X : X_WB) X.p.z() += up;
}

int find_mount(Builder& builder, Reader& r) {
  const std::string name = r.text("rides");
  if (name.empty()) return -1;
  const int mount = builder.body_index(name);
  if (mount < 0 || !builder.saddles.contains(name)) {
    r.fail("rides", mount < 0 ? "is no vehicle of the scene" : "is no vehicle with a saddle");
    return -1;
  }
  for (const char* key : {"position", "heading", "height", "cg_height", "speed", "velocity", "angular_velocity"})
    if (r.has(key)) r.fail(key, "must not be given for a rider, who goes with the vehicle");
  if (builder.scene.model.bodies[static_cast<std::size_t>(mount)].person >= 0) r.fail("rides", "has a rider already");
  return mount;
}

void hold_on(Builder& builder, const Hold& hold, int mount, engine::Person& person) {
  engine::Model& model = builder.scene.model;
  engine::Body& ridden = model.bodies[static_cast<std::size_t>(mount)];
  person.mount = mount;
  ridden.person = static_cast<int>(model.persons.size());
  for (const int index : person.bodies) {
    const engine::Body& part = model.bodies[static_cast<std::size_t>(index)];
    const std::string name = part.name.substr(part.name.find('/') + 1);
    const auto& shape = std::get<engine::HyperEllipsoid>(part.shape);
    engine::Joint joint;
    if (name.ends_with("forearm") || name.ends_with("lower_arm")) {
      joint.breaking_force = hold.hand;
      joint.X_CF.p.z() = -0.88 * shape.semi_axes.z();  // the palm
    } else if (name.ends_with("foot")) {
      joint.breaking_force = hold.foot;
    } else if (index == person.bodies.front()) {
      joint.breaking_force = hold.seat;
      joint.X_CF.p.z() = -shape.semi_axes.z();
    } else {
      continue;
    }
    joint.name = part.name + "-" + ridden.name;
    joint.kind = engine::JointKind::spherical;
    joint.parent = mount;
    joint.child = index;
    joint.X_PF = ridden.X_WB.inverse() * part.X_WB * joint.X_CF;
    model.joints.push_back(std::move(joint));
  }
}

}  // namespace scenes
