// [[person]]: a figure of the library, sized, posed, set on the ground and given its walking velocity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "scenes/loader/figure.h"

namespace scenes {

namespace {

const Key kPersonSegmentKeys[] = {
    {"axes", Type::vector3, Dimension::length, "", "Semi-axes.", kExtent},
    {"exponent", Type::number, Dimension::none, "", "Exponent n.", between(2, 100), {}, nullptr, "a hyper-ellipsoid needs n >= 2"},
    {"mass", Type::number, Dimension::mass, "", "Mass; the other parts keep theirs.", kPositive},
    {"inertia", Type::inertia, Dimension::inertia, "", "About the part's centre, in its axes."},
    CRASHREEL_SURFACE_KEYS,
    {"colour", Type::colour, Dimension::none, "", "Colour in pictures."},
};
const Section kSegmentSectionOfPerson{"person.segment", "[person.segment.NAME]",
                                      "Changes to one part: head, neck, torso, hips, left_thigh ...", kPersonSegmentKeys};

const Key kRangeKeys[] = {{"*", Type::range, Dimension::angle, "", "Range of motion of the angle of this name, like flexion."}};
const Section kRangesSection{"person.joint.ranges", "[person.joint.NAME.ranges]", "Other ranges of motion.", kRangeKeys};

const Key kPersonJointKeys[] = {
    bound<&FigureJoint::damping>(
        {"damping", Type::number, Dimension::angular_damping, "", "Resistance per angular speed.", kNotNegative}),
    bound<&FigureJoint::friction_torque>(
        {"friction_torque", Type::number, Dimension::torque, "", "Constant resistance against turning.", kNotNegative}),
    bound<&FigureJoint::stiffness>(
        {"stiffness", Type::number, Dimension::angular_stiffness, "", "Resistive spring towards standing.", kNotNegative}),
    bound<&FigureJoint::stop_stiffness>(
        {"stop_stiffness", Type::number, Dimension::angular_stiffness, "",
         "Of the stops at the ends of the ranges, compliant contact law only; 0: rigid, as they are with Default-Auto.",
         kNotNegative}),
    bound<&FigureJoint::passive_share>({"passive_share", Type::number, Dimension::none, "",
                                        "Share of an adult's passive elastic torque in hip, knee or ankle; 0: none.",
                                        kNotNegative}),
    {"ranges", Type::table, Dimension::none, "", "Ranges of motion.", kAny, {}, &kRangesSection},
};
const Section kJointSectionOfPerson{"person.joint", "[person.joint.NAME]",
                                    "Changes to one joint: trunk, neck, head, left_hip, left_knee ...", kPersonJointKeys};

const Key kPersonKeys[] = {
    {"name", Type::text, Dimension::none, kRequired, "Name; its parts are NAME/head, NAME/left_thigh ..."},
    {"figure", Type::text, Dimension::none, "'person-14'", "A person of the library or of the scene's folder."},
    {"sex", Type::choice, Dimension::none, "'male'", "Which regression gives the masses of the parts.", kAny, "male|female"},
    {"stature",
     Type::number,
     Dimension::length,
     "",
     "Height standing, within what the figure is made for. Left out: the figure's own.",
     kPositive,
     {},
     nullptr,
     {},
     between(0.4, 2.6)},
    {"mass",
     Type::number,
     Dimension::mass,
     "",
     "Mass of the whole person. Left out: the figure's own.",
     kPositive,
     {},
     nullptr,
     {},
     between(4, 300)},
    {"pose", Type::text, Dimension::none, "'standing'", "A pose of the library or of the scene's folder."},
    {"angles", Type::table, Dimension::none, "", "Changes to the pose.", kAny, {}, &kAnglesSection},
    {"position", Type::vector2, Dimension::length, "'0 0 m'", "World x, y of the centre of the hips."},
    {"heading", Type::number, Dimension::angle, "'0 deg'", "Where the person faces, from +x towards +y."},
    {"speed", Type::number, Dimension::speed, "'0 m/s'", "Walking velocity along the heading."},
    {"velocity", Type::vector3, Dimension::speed, "", "Velocity in world axes, in place of speed."},
    {"angular_velocity", Type::vector3, Dimension::angular_speed, "",
     "Of the whole person about its centre of gravity, world axes."},
    {"height", Type::number, Dimension::length, "'0 m'", "Of the lowest point above the ground."},
    {"cg_height", Type::number, Dimension::length, "", "Of the centre of gravity above z = 0, in place of height."},
    {"rides", Type::text, Dimension::none, "''",
     "A vehicle with a saddle: the person sits on it in its pose, goes with it, and holds on with hands, feet and seat."},
    {"grip_force", Type::number, Dimension::force, "'400 N'", "Above it a hand lets go (mean over 10 ms).", kPositive},
    {"pedal_force", Type::number, Dimension::force, "'400 N'", "Above it a foot leaves its pedal or rest.", kPositive},
    {"seat_force", Type::number, Dimension::force, "'1.5 kN'", "Above it the rider leaves the saddle.", kPositive},
    bound<&engine::Person::zero_condition>({"zero_condition", Type::boolean, Dimension::none, "true",
                                            "Keeps pose and velocity at no cost until something touches it."}),
    {"appearance", Type::choice, Dimension::none, "'skin'", "Bare ellipsoids, the figure with its joints closed, or the wire grid.",
     kAny, "segments|skin|raster"},
    bound<&engine::Body::collision_model>({"collision", Type::choice, Dimension::none, "'default_auto'",
                                           "Collision model the person asks for.", kAny, "default_auto"}),
    CRASHREEL_SURFACE_KEYS,
    {"segment", Type::map, Dimension::none, "", "Changes to single parts.", kAny, {}, &kSegmentSectionOfPerson},
    {"joint", Type::map, Dimension::none, "", "Changes to single joints.", kAny, {}, &kJointSectionOfPerson},
};

void change_segments(Reader& r, Figure& figure, std::vector<engine::SurfaceProperties>& surfaces) {
  for (auto& [name, change] : r.map("segment")) {
    const auto at =
        std::find_if(figure.segments.begin(), figure.segments.end(), [&n = name](const Segment& s) { return s.name == n; });
    if (at == figure.segments.end()) {
      std::vector<std::string> names;
      for (const Segment& s : figure.segments) names.push_back(s.name);
      const std::string guess = nearest(name, names);
      change.fail_here(guess.empty() ? "is no part of this person"
                                     : fmt::format("is no part of this person; did you mean \"{}\"?", guess));
      continue;
    }
    if (const auto axes = change.vector_if("axes")) at->shape.semi_axes = *axes;
    if (change.has("exponent")) at->shape.exponent = std::max(2.0, change.number("exponent"));
    if (change.has("mass")) at->mass = change.number("mass");
    if (change.has("colour")) at->material.colour = change.colour("colour");
    if (change.has("inertia")) {
      at->inertia = change.inertia("inertia");
      check_inertia(change, "inertia", at->inertia);
    } else if (at->mass > 0 && (at->shape.semi_axes.array() > 0).all()) {
      at->inertia = engine::principal_inertia(at->shape, at->mass).asDiagonal();
    }
    auto& surface = surfaces[static_cast<std::size_t>(at - figure.segments.begin())];
    surface = read_surface(change, surface);
  }
}

void change_ranges(Reader& ranges, FigureJoint& joint) {
  for (const Entry& entry : ranges.value().entries) {
    const auto angle =
        std::find_if(joint.angles.begin(), joint.angles.end(), [&](const AnatomicalAngle& a) { return a.name == entry.key; });
    const auto [lower, upper] = ranges.range(entry.key);
    if (angle == joint.angles.end()) {
      ranges.fail(entry.key, fmt::format("is no angle of joint {}", joint.name));
    } else {
      angle->lower = lower;
      angle->upper = upper;
    }
  }
}

void change_joints(Reader& r, Figure& figure) {
  for (auto& [name, change] : r.map("joint")) {
    const auto at =
        std::find_if(figure.joints.begin(), figure.joints.end(), [&n = name](const FigureJoint& j) { return j.name == n; });
    if (at == figure.joints.end()) {
      std::vector<std::string> names;
      for (const FigureJoint& j : figure.joints) names.push_back(j.name);
      const std::string guess = nearest(name, names);
      change.fail_here(guess.empty() ? "is no joint of this person"
                                     : fmt::format("is no joint of this person; did you mean \"{}\"?", guess));
      continue;
    }
    change.fill(*at);
    if (auto ranges = change.table("ranges")) change_ranges(*ranges, *at);
  }
}

void add_actor(Builder& builder, const std::string& name, int look, int first_body, const Figure& figure,
               const std::vector<engine::Pose>& X_WB) {
  render::PersonActor actor;
  actor.name = name;
  actor.look = static_cast<render::PersonLook>(look);
  for (std::size_t i = 0; i < figure.segments.size(); ++i) {
    const Segment& s = figure.segments[i];
    actor.segments.push_back({s.name, first_body + static_cast<int>(i), -1, engine::Vec3::Zero(), s.shape, X_WB[i], s.material});
  }
  for (const FigureJoint& j : figure.joints) {
    auto& segment = actor.segments[static_cast<std::size_t>(j.child)];
    segment.parent = j.parent;
    segment.joint_P = j.at - figure.segments[static_cast<std::size_t>(j.parent)].centre;
  }
  builder.scene.stage.persons.push_back(std::move(actor));
}

}  // namespace

const Section kPersonSection{"person", "[[person]]",
                             "A person: parts joined by joints. Angles in words, sizes by stature and mass.", kPersonKeys};

void read_person(Builder& builder, Reader r) {
  engine::Model& model = builder.scene.model;
  engine::Person person;
  person.name = r.text("name");
  if (person.name.empty() || person.name.find('/') != std::string::npos) r.fail("name", "must be a name without a slash");
  for (const engine::Person& other : model.persons)
    if (other.name == person.name) r.fail("name", "this name is already used; every person needs a name of its own");
  PersonSize size;
  Figure figure = read_figure(builder, r, size);
  if (figure.segments.empty()) return;

  std::vector<engine::SurfaceProperties> surfaces(figure.segments.size(), read_surface(r, {}));
  change_segments(r, figure, surfaces);
  change_joints(r, figure);
  const Pose pose = read_pose(builder, r, figure);
  const int mount = find_mount(builder, r);
  const engine::Body* ridden = mount < 0 ? nullptr : &model.bodies[static_cast<std::size_t>(mount)];
  const engine::Vec3 ahead = ridden ? engine::Vec3(ridden->X_WB.q * engine::Vec3::UnitX()) : engine::Vec3::UnitX();
  const double heading = ridden ? engine::math::atan2(ahead.y(), ahead.x()) : r.number("heading");
  using engine::math::rotation;
  const engine::Quat q_root = rotation(heading, engine::Vec3::UnitZ()) * rotation(pose.pitch, engine::Vec3::UnitY()) *
                              rotation(pose.roll, engine::Vec3::UnitX());
  std::vector<engine::Pose> X_WB = placed(figure, pose, q_root);
  if (ridden) {
    const engine::Vec3 seat = ridden->X_WB * builder.saddles.at(ridden->name);
    for (engine::Pose& X : X_WB) X.p += seat;
  } else {
    set_down(r, model.ground, figure, X_WB);
  }

  if (r.has("velocity") && r.has("speed")) r.fail("velocity", "must not be given together with speed");
  const engine::Vec3 v =
      ridden ? ridden->V_WB.v
             : r.vector_if("velocity")
                   .value_or(r.number("speed") * engine::Vec3(engine::math::cos(heading), engine::math::sin(heading), 0));
  const engine::Vec3 w = r.vector("angular_velocity");
  const engine::Vec3 cg = centre_of_gravity(figure, X_WB);

  const int first = static_cast<int>(model.bodies.size());
  for (std::size_t i = 0; i < figure.segments.size(); ++i) {
    const Segment& s = figure.segments[i];
    engine::Body body;
    body.name = person.name + "/" + s.name;
    body.mass = s.mass;
    body.inertia_B = s.inertia;
    body.shape = s.shape;
    body.surface = surfaces[i];
    if (!surfaces[i].stiffness_given) body.surface.stiffness = s.stiffness;
    r.fill(body);
    body.X_WB = X_WB[i];
    body.V_WB = {v + w.cross(X_WB[i].p - cg), w};
    body.person = static_cast<int>(model.persons.size());
    const int index = first + static_cast<int>(i);
    person.bodies.push_back(index);
    if (s.name == "head") person.head = index;
    if (s.name == "torso") person.torso = index;
    model.bodies.push_back(std::move(body));
  }
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    engine::Joint joint = engine_joint(figure, figure.joints[i], pose.angles[i]);
    joint.name = person.name + "/" + joint.name;
    joint.parent = first + figure.joints[i].parent;
    joint.child = first + figure.joints[i].child;
    model.joints.push_back(std::move(joint));
  }
  person.hips = first;
  person.stature = size.stature;
  r.fill(person);
  if (mount >= 0) hold_on(builder, r, mount, person);
  add_actor(builder, person.name, r.choice("appearance"), first, figure, X_WB);
  builder.scene.stage.speeds.emplace_back(first, person.name);
  model.persons.push_back(std::move(person));
}

}  // namespace scenes
