// [[person]]: a figure of the library, sized, posed, set on the ground and given its walking velocity.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/math/functions.h"
#include "scenes/loader/figure.h"

namespace scenes {

namespace {

const Key kPersonSegmentKeys[] = {
    bound<&Segment::shape, &engine::HyperEllipsoid::semi_axes>(
        {"axes", Type::vector3, Dimension::length, "", "Semi-axes.", kExtent}),
    bound<&Segment::shape, &engine::HyperEllipsoid::exponent>({"exponent",
                                                               Type::number,
                                                               Dimension::none,
                                                               "",
                                                               "Exponent n.",
                                                               between(2, 100),
                                                               {},
                                                               nullptr,
                                                               "a hyper-ellipsoid needs n >= 2"}),
    bound<&Segment::mass>({"mass", Type::number, Dimension::mass, "", "Mass; the other parts keep theirs.", kPositive}),
    bound<&Segment::inertia>({"inertia", Type::inertia, Dimension::inertia, "", "About the part's centre, in its axes."}),
    CRASHREEL_SURFACE_KEYS,
    bound<&Segment::material, &render::Material::colour>({"colour", Type::colour, Dimension::none, "", "Colour in pictures."}),
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
    bound<&engine::Person::name>(
        {"name", Type::text, Dimension::none, kRequired, "Name; its parts are NAME/head, NAME/left_thigh ..."}),
    {"figure", Type::text, Dimension::none, "'person-14'", "A person of the library or of the scene's folder."},
    bound<&PersonSize::female>(
        {"sex", Type::choice, Dimension::none, "'male'", "Which regression gives the masses of the parts.", kAny, "male|female"}),
    bound<&PersonSize::stature>({"stature",
                                 Type::number,
                                 Dimension::length,
                                 "",
                                 "Height standing, within what the figure is made for. Left out: the figure's own.",
                                 kPositive,
                                 {},
                                 nullptr,
                                 {},
                                 between(0.4, 2.6)}),
    bound<&PersonSize::mass>({"mass",
                              Type::number,
                              Dimension::mass,
                              "",
                              "Mass of the whole person. Left out: the figure's own.",
                              kPositive,
                              {},
                              nullptr,
                              {},
                              between(4, 300)}),
    {"pose", Type::text, Dimension::none, "'standing'", "A pose of the library or of the scene's folder."},
    {"angles", Type::table, Dimension::none, "", "Changes to the pose.", kAny, {}, &kAnglesSection},
    bound<&Placing::position>({"position", Type::vector2, Dimension::length, "'0 0 m'", "World x, y of the centre of the hips."}),
    bound<&Placing::heading>({"heading", Type::number, Dimension::angle, "'0 deg'", "Where the person faces, from +x towards +y."}),
    bound<&Placing::speed>({"speed", Type::number, Dimension::speed, "'0 m/s'",
                            "Walking velocity along the heading, up and down with the ground. Off an edge of 40 cm it falls."}),
    bound<&Placing::velocity>({"velocity", Type::vector3, Dimension::speed, "", "Velocity in world axes, in place of speed."}),
    bound<&engine::Twist::w>({"angular_velocity", Type::vector3, Dimension::angular_speed, "",
                              "Of the whole person about its centre of gravity, world axes."}),
    bound<&Standing::height>({"height", Type::number, Dimension::length, "'0 m'", "Of the lowest point above the ground."}),
    bound<&Standing::cg_height>(
        {"cg_height", Type::number, Dimension::length, "", "Of the centre of gravity above z = 0, in place of height."}),
    {"rides", Type::text, Dimension::none, "''",
     "A vehicle with a saddle: the person sits on it in its pose, goes with it, and holds on with hands, feet and seat."},
    bound<&Hold::hand>(
        {"grip_force", Type::number, Dimension::force, "'400 N'", "Above it a hand lets go (mean over 10 ms).", kPositive}),
    bound<&Hold::foot>(
        {"pedal_force", Type::number, Dimension::force, "'400 N'", "Above it a foot leaves its pedal or rest.", kPositive}),
    bound<&Hold::seat>(
        {"seat_force", Type::number, Dimension::force, "'1.5 kN'", "Above it the rider leaves the saddle.", kPositive}),
    bound<&engine::Person::zero_condition>({"zero_condition", Type::boolean, Dimension::none, "true",
                                            "Keeps pose and velocity at no cost until something touches it."}),
    bound<&render::PersonActor::look>({"appearance", Type::choice, Dimension::none, "'skin'",
                                       "Bare ellipsoids, the figure with its joints closed, or the wire grid.", kAny,
                                       "segments|skin|raster"}),
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
    change.fill(*at);
    at->shape.exponent = std::max(2.0, at->shape.exponent);
    if (change.has("inertia")) {
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

void add_actor(Builder& builder, Reader& r, const engine::Person& person, const Figure& figure,
               const std::vector<engine::Pose>& X_WB) {
  render::PersonActor actor;
  actor.name = person.name;
  actor.mount = person.mount;
  r.fill(actor);
  for (std::size_t i = 0; i < figure.segments.size(); ++i) {
    const Segment& s = figure.segments[i];
    actor.segments.push_back({s.name, person.bodies[i], -1, engine::Vec3::Zero(), s.shape, X_WB[i], s.material});
  }
  for (const FigureJoint& j : figure.joints) {
    auto& segment = actor.segments[static_cast<std::size_t>(j.child)];
    segment.parent = j.parent;
    segment.joint_P = j.at - figure.segments[static_cast<std::size_t>(j.parent)].centre;
  }
  builder.scene.stage.persons.push_back(std::move(actor));
}

/// Where a person's parts are at the start, and how the whole moves.
struct Start {
  std::vector<engine::Pose> X_WB;
  engine::Twist V;  // of the centre of gravity
};

/// Set down on the ground, or on the saddle of what it rides and as fast as that.
Start start_of(Builder& builder, Reader& r, const Figure& figure, const Pose& pose, int mount) {
  const engine::Model& model = builder.scene.model;
  const engine::Body* ridden = mount < 0 ? nullptr : &model.bodies[static_cast<std::size_t>(mount)];
  Start out;
  Placing placing;
  r.fill(placing);
  r.fill(out.V);
  if (ridden) {
    const engine::Vec3 ahead = ridden->X_WB.q * engine::Vec3::UnitX();
    placing.heading = engine::math::atan2(ahead.y(), ahead.x());
  }
  using engine::math::rotation;
  const engine::Quat q_root = rotation(placing.heading, engine::Vec3::UnitZ()) * rotation(pose.pitch, engine::Vec3::UnitY()) *
                              rotation(pose.roll, engine::Vec3::UnitX());
  out.X_WB = placed(figure, pose, q_root);
  if (ridden) {
    const engine::Vec3 seat = ridden->X_WB * builder.saddles.at(ridden->name);
    for (engine::Pose& X : out.X_WB) X.p += seat;
    out.V.v = ridden->V_WB.v;
  } else {
    set_down(r, placing.position, model.ground, figure, out.X_WB);
    out.V.v = placing.v(r);
  }
  return out;
}

/// A body for each part, which the person then knows.
void add_bodies(Builder& builder, Reader& r, const Figure& figure, const std::vector<engine::SurfaceProperties>& surfaces,
                const Start& start, engine::Person& person) {
  engine::Model& model = builder.scene.model;
  const engine::Vec3 cg = centre_of_gravity(figure, start.X_WB);
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
    body.X_WB = start.X_WB[i];
    body.V_WB = {start.V.v + start.V.w.cross(start.X_WB[i].p - cg), start.V.w};
    body.person = static_cast<int>(model.persons.size());
    const int index = static_cast<int>(model.bodies.size());
    person.bodies.push_back(index);
    if (s.name == "head") person.head = index;
    if (s.name == "torso") person.torso = index;
    model.bodies.push_back(std::move(body));
  }
  person.hips = person.bodies.front();
}

void add_joints(Builder& builder, const Figure& figure, const Pose& pose, const engine::Person& person) {
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    engine::Joint joint = engine_joint(figure, figure.joints[i], pose.angles[i]);
    joint.name = person.name + "/" + joint.name;
    joint.parent = person.hips + figure.joints[i].parent;
    joint.child = person.hips + figure.joints[i].child;
    builder.scene.model.joints.push_back(std::move(joint));
  }
}

}  // namespace

const Section kPersonSection{"person", "[[person]]",
                             "A person: parts joined by joints. Angles in words, sizes by stature and mass.", kPersonKeys};

void read_person(Builder& builder, Reader r) {
  engine::Model& model = builder.scene.model;
  engine::Person person;
  r.fill(person);
  if (person.name.empty() || person.name.find('/') != std::string::npos) r.fail("name", "must be a name without a slash");
  for (const engine::Person& other : model.persons)
    if (other.name == person.name) r.fail("name", "this name is already used; every person needs a name of its own");
  PersonSize size;
  Figure figure = read_figure(builder, r, size);
  if (figure.segments.empty()) return;
  person.stature = size.stature;

  std::vector<engine::SurfaceProperties> surfaces(figure.segments.size(), read_surface(r, {}));
  change_segments(r, figure, surfaces);
  if (!engine::yields(model.settings.contact_law, true))
    for (FigureJoint& joint : figure.joints) joint.slide.reset();
  change_joints(r, figure);
  const Pose pose = read_pose(builder, r, figure);
  const int mount = find_mount(builder, r);
  const Start start = start_of(builder, r, figure, pose, mount);
  add_bodies(builder, r, figure, surfaces, start, person);
  add_joints(builder, figure, pose, person);
  Hold hold;
  r.fill(hold);
  if (mount >= 0) hold_on(builder, hold, mount, person);
  add_actor(builder, r, person, figure, start.X_WB);
  render::Mover mover{person.hips, person.name};
  for (const int b : person.bodies) mover.masses.emplace_back(b, model.bodies[static_cast<std::size_t>(b)].mass);
  builder.scene.stage.speeds.push_back(std::move(mover));
  model.persons.push_back(std::move(person));
}

}  // namespace scenes
