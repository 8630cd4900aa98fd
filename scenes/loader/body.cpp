// [[body]]: a free body of any shape, and what bodies of all sections share.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "engine/math/functions.h"
#include "scenes/loader/builder.h"
#include "scenes/loader/mesh.h"
#include "scenes/loader/mesh_frame.h"

namespace scenes {
namespace {

/// What the body's shape, turn and turning follow from.
struct BodyGiven {
  std::optional<engine::Vec3> axes;                   // [m]
  double exponent = 2;                                // [-]
  std::optional<engine::Vec3> angular_velocity_body;  // [rad/s]
};

const Key kBodyKeys[] = {
    bound<&engine::Body::name>({"name", Type::text, Dimension::none, kRequired, "Name in every output."}),
    bound<&engine::Body::mass>({"mass", Type::number, Dimension::mass, "", "Mass; needed unless the body is fixed.", kPositive}),
    bound<&BodyGiven::axes>(
        {"axes", Type::vector3, Dimension::length, "", "Semi-axes a, b, c of a hyper-ellipsoid, eq. (60).", kExtent}),
    bound<&BodyGiven::exponent>({"exponent",
                                 Type::number,
                                 Dimension::none,
                                 "2",
                                 "Its exponent n: 2 an ellipsoid, 30 almost a box.",
                                 between(2, 100),
                                 {},
                                 nullptr,
                                 "a hyper-ellipsoid needs n >= 2"}),
    {"mesh", Type::path, Dimension::none, "", "A mesh file in place of axes; its origin is the centre of mass."},
    CRASHREEL_MESH_KEYS,
    bound<&engine::Body::inertia_B>({"inertia", Type::inertia, Dimension::inertia, "",
                                     "About the centre of mass in body axes. Left out: that of the even hyper-ellipsoid."}),
    bound<&engine::Body::X_WB, &engine::Pose::p>(
        {"position", Type::vector3, Dimension::length, "'0 0 0 m'", "Centre of mass at the start."}),
    bound<&Attitude::roll_pitch_yaw>({"attitude", Type::vector3, Dimension::angle, "'0 0 0 deg'",
                                      "Roll, pitch, yaw at the start: turned about x, then y, then z of the world."}),
    bound<&Attitude::quaternion>(
        {"quaternion", Type::numbers, Dimension::none, "", "Attitude as [w, x, y, z] in place of roll, pitch, yaw."}),
    bound<&engine::Body::V_WB, &engine::Twist::v>(
        {"velocity", Type::vector3, Dimension::speed, "'0 0 0 m/s'", "Of the centre of mass, world axes."}),
    bound<&engine::Body::V_WB, &engine::Twist::w>(
        {"angular_velocity", Type::vector3, Dimension::angular_speed, "", "In world axes."}),
    bound<&BodyGiven::angular_velocity_body>(
        {"angular_velocity_body", Type::vector3, Dimension::angular_speed, "", "In body axes, in place of angular_velocity."}),
    CRASHREEL_SURFACE_KEYS,
    bound<&engine::Body::fixed>({"fixed", Type::boolean, Dimension::none, "false", "Part of the world: never moves."}),
    bound<&engine::Body::collision_model>({"collision", Type::choice, Dimension::none, "'default_auto'",
                                           "Collision model the body asks for. Kudlich-Slibar acts between two meshes that both "
                                           "ask for it, Default-Auto in every other "
                                           "case.",
                                           kAny, "default_auto|kudlich_slibar"}),
    bound<&render::Material::colour>({"colour", Type::colour, Dimension::none, "'#c87838'", "Colour in pictures."}),
    bound<&render::Material::kind>({"material", Type::choice, Dimension::none, "'matte'", "Surface in pictures.", kAny,
                                    "matte|paint|glass|lamp|rubber|metal|skin|cloth"}),
};

void read_shape(Builder& builder, Reader& r, const BodyGiven& given, engine::Body& body) {
  if (given.axes && r.has("mesh")) r.fail("mesh", "must not be given together with axes; a body has one shape");
  if (given.axes) {
    body.shape = engine::HyperEllipsoid{*given.axes, std::max(2.0, given.exponent)};
  } else if (r.has("mesh")) {
    if (const auto mesh = in_frame(builder, import_mesh(builder, r, "mesh"), given_frame(r)))
      body.shape = engine::MeshShape{mesh->solid->mesh(), {}};
  }
}

void read_inertia(Reader& r, engine::Body& body) {
  if (r.has("inertia")) {
    check_inertia(r, "inertia", body.inertia_B);
  } else if (const auto* ellipsoid = std::get_if<engine::HyperEllipsoid>(&body.shape);
             ellipsoid && (ellipsoid->semi_axes.array() > 0).all()) {
    body.inertia_B = engine::principal_inertia(*ellipsoid, body.mass).asDiagonal();
  } else if (!body.fixed && !r.has("axes")) {
    r.fail("inertia", "is missing; a body without axes needs its inertia, like inertia = \"1 2 2 kg m^2\"");
  }
}

}  // namespace

const Section kBodySection{"body", "[[body]]", "A free rigid body: a hyper-ellipsoid, a mesh, or a shapeless mass.", kBodyKeys};

int Builder::body_index(const std::string& name) const {
  const auto& bodies = scene.model.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].name == name) return static_cast<int>(i);
  return -1;
}

std::vector<std::string> Builder::body_names() const {
  std::vector<std::string> out;
  for (const engine::Body& body : scene.model.bodies) out.push_back(body.name);
  return out;
}

engine::Quat read_attitude(Reader& r) {
  Attitude given;
  r.fill(given);
  if (given.quaternion) {
    if (r.has("attitude")) r.fail("quaternion", "must not be given together with attitude");
    const std::vector<double>& q = *given.quaternion;
    const engine::Quat out = q.size() == 4 ? engine::Quat(q[0], q[1], q[2], q[3]) : engine::Quat(0, 0, 0, 0);
    // four digits are what people copy from a printout
    if (std::abs(out.norm() - 1) < 1e-3) return out.normalized();
    r.fail("quaternion", "must be four numbers [w, x, y, z] whose squares sum to 1");
    return engine::Quat::Identity();
  }
  using engine::math::rotation;
  const engine::Vec3& rpy = given.roll_pitch_yaw;
  if (rpy.isZero()) return engine::Quat::Identity();
  return rotation(rpy.z(), engine::Vec3::UnitZ()) * rotation(rpy.y(), engine::Vec3::UnitY()) *
         rotation(rpy.x(), engine::Vec3::UnitX());
}

engine::SurfaceProperties read_surface(Reader& r, engine::SurfaceProperties out) {
  r.fill(out);
  out.stiffness_given = out.stiffness_given || r.has("stiffness");
  return out;
}

void check_inertia(Reader& r, std::string_view key, const engine::Mat3& inertia) {
  const engine::Vec3 moments = Eigen::SelfAdjointEigenSolver<engine::Mat3>(inertia).eigenvalues();
  if (moments[0] <= 0) {
    r.fail(key, fmt::format("must be positive definite; its smallest principal moment is {:.6g} kg m^2", moments[0]));
    // rounding of a tensor that is exactly flat must pass
  } else if (moments[0] + moments[1] < moments[2] * (1 - 1e-9)) {
    r.fail(key, fmt::format("must be physically possible; of its principal moments {:.6g} + {:.6g} is less than {:.6g} kg m^2",
                            moments[0], moments[1], moments[2]));
  }
}

engine::Vec3 Placing::ahead() const {
  return {engine::math::cos(heading), engine::math::sin(heading), 0};
}

engine::Vec3 Placing::v(Reader& r) const {
  if (r.has("velocity") && r.has("speed")) r.fail("velocity", "must not be given together with speed");
  return velocity.value_or(speed * ahead());
}

void read_body(Builder& builder, Reader r) {
  engine::Body body;
  BodyGiven given;
  r.fill(body);
  r.fill(given);
  if (body.name.empty()) r.fail("name", "must not be empty");
  if (body.name == "world" || builder.body_index(body.name) >= 0)
    r.fail("name", "this name is already used; every body needs a name of its own");
  if (!r.has("mass") && !body.fixed) r.fail("mass", "is missing; write like mass = \"78 kg\", or fixed = true");
  const std::size_t errors_before = builder.errors.count();
  read_shape(builder, r, given, body);
  if (body.mass > 0 && builder.errors.count() == errors_before) read_inertia(r, body);
  body.surface = read_surface(r, {});
  if (body.collision_model == engine::CollisionModel::kudlich_slibar && !r.has("mesh"))
    r.fail("collision", "must be default_auto for a body without a mesh; Kudlich-Slibar needs two meshes");
  body.X_WB.q = read_attitude(r);
  if (const auto& w_B = given.angular_velocity_body) {
    if (r.has("angular_velocity")) r.fail("angular_velocity_body", "must not be given together with angular_velocity");
    body.V_WB.w = body.X_WB.q * *w_B;
  }

  const int index = static_cast<int>(builder.scene.model.bodies.size());
  render::Stage& stage = builder.scene.stage;
  render::Material material{body.name, {}, {}, 0.5f, 1.0f};
  r.fill(material);
  if (const auto* ellipsoid = std::get_if<engine::HyperEllipsoid>(&body.shape)) {
    stage.ellipsoids.push_back({body.name, index, *ellipsoid, material});
  } else if (std::holds_alternative<engine::MeshShape>(body.shape)) {
    if (const auto mesh = in_frame(builder, import_mesh(builder, r, "mesh"), given_frame(r)))
      stage.meshes.push_back({body.name, index, {}, mesh->look, {}, std::get<engine::MeshShape>(body.shape).mesh});
  }
  if (!body.fixed) stage.speeds.push_back({index, body.name});
  builder.scene.model.bodies.push_back(std::move(body));
}

}  // namespace scenes
