// The library file of a person, and how it is sized: lengths with stature, cross axes with sqrt(mass/stature), masses by
// regression.
#include "scenes/loader/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace scenes {
namespace {

const Key kFigureSegmentKeys[] = {
    bound<&Segment::name>(
        {"name", Type::text, Dimension::none, kRequired, "Name of the part; with sides it becomes left_NAME and right_NAME."}),
    {"sides", Type::boolean, Dimension::none, "false", "Given for the left side; the right one is its mirror image."},
    {"centre", Type::vector3, Dimension::length, kRequired, "Centre when standing, x forward, y left, z above the soles."},
    {"axes", Type::vector3, Dimension::length, kRequired, "Semi-axes.", kExtent},
    {"exponent", Type::number, Dimension::none, "2", "Exponent n.", between(2, 100), {}, nullptr, "a hyper-ellipsoid needs n >= 2"},
    {"mass_male", Type::numbers, Dimension::none, "",
     "[b0, b1, b2]: mass in kg = b0 + b1 mass/kg + b2 stature/cm; all parts are then scaled to the person's mass."},
    {"mass_female", Type::numbers, Dimension::none, "", "The same for women; left out: as for men."},
    {"mass_share", Type::number, Dimension::none, "", "Share of the person's mass, in place of a regression.", kPositive},
    {"lengthwise", Type::boolean, Dimension::none, "false", "Its x axis grows with stature, like a foot."},
    bound<&Segment::stiffness>({"stiffness", Type::number, Dimension::stiffness, "'400 kN/m'",
                                "What it yields by against whatever it touches, in series with it.", kPositive}),
    {"cloth", Type::colour, Dimension::none, "'#808080'", "Colour."},
};
const Section kSegmentSectionOfFigure{"figure.segment", "[[segment]]", "In a person's library file: one part.", kFigureSegmentKeys};

const Key kFigureAngleKeys[] = {
    bound<&AnatomicalAngle::name>(
        {"name", Type::text, Dimension::none, kRequired, "The word used in poses: JOINT_NAME, like knee_flexion."}),
    {"about", Type::choice, Dimension::none, kRequired, "Axis of the standing person that a positive angle turns about.", kAny,
     "+x|-x|+y|-y|+z|-z"},
    {"range", Type::range, Dimension::angle, kRequired, "Range of motion."},
    bound<&AnatomicalAngle::word>(
        {"word", Type::text, Dimension::none, "''",
         "Another word for poses. Angles of several joints that have one in common take an even part of it each."}),
};
const Section kAngleSectionOfFigure{"figure.joint.angle", "[[joint.angle]]", "In a person's library file: one angle of a joint.",
                                    kFigureAngleKeys};

const Key kFigureJointKeys[] = {
    {"name", Type::text, Dimension::none, kRequired, "Name of the joint; with sides left_NAME and right_NAME."},
    {"sides", Type::boolean, Dimension::none, "false", "Given for the left side; the right one is its mirror image."},
    {"parent", Type::text, Dimension::none, kRequired, "The part nearer to the root."},
    {"child", Type::text, Dimension::none, kRequired, "The part it carries."},
    {"at", Type::vector3, Dimension::length, kRequired, "Its centre when standing."},
    {"angle",
     Type::tables,
     Dimension::none,
     kRequired,
     "About y: a revolute joint. About y and x: a universal joint. About y, x and z: a ragdoll joint.",
     kAny,
     {},
     &kAngleSectionOfFigure},
    bound<&FigureJoint::damping>(
        {"damping", Type::number, Dimension::angular_damping, "0", "Resistance per angular speed.", kNotNegative}),
    bound<&FigureJoint::friction_torque>(
        {"friction_torque", Type::number, Dimension::torque, "0", "Constant resistance.", kNotNegative}),
    bound<&FigureJoint::stiffness>(
        {"stiffness", Type::number, Dimension::angular_stiffness, "0", "Spring towards the standing pose.", kNotNegative}),
    bound<&FigureJoint::stop_stiffness>(
        {"stop_stiffness", Type::number, Dimension::angular_stiffness, "'300 N m/rad'",
         "Of the stops at the ends of the ranges, compliant contact law only; 0: rigid, as they are with Default-Auto.",
         kNotNegative}),
    bound<&FigureJoint::passive>({"passive", Type::choice, Dimension::none, "'none'",
                                  "Elastic torque of a leg's joint at rest (Riener and Edrich 1999).", kAny,
                                  "none|hip|knee|ankle"}),
    bound<&FigureJoint::passive_share>(
        {"passive_share", Type::number, Dimension::none, "1", "Share of an adult's passive torque.", kNotNegative}),
};
const Section kJointSectionOfFigure{"figure.joint", "[[joint]] of a person's file", "In a person's library file: one joint.",
                                    kFigureJointKeys};

const Key kFigureKeys[] = {
    {"title", Type::text, Dimension::none, "''", "What it is."},
    {"stature", Type::number, Dimension::length, kRequired, "Stature the figures are for.", kPositive},
    {"mass", Type::number, Dimension::mass, kRequired, "Mass the figures are for.", kPositive},
    {"statures", Type::range, Dimension::length, "", "Statures it may be sized to. Left out: any."},
    {"masses", Type::range, Dimension::mass, "", "Masses it may be sized to. Left out: any."},
    {"root", Type::text, Dimension::none, kRequired, "The part all others hang on."},
    {"segment", Type::tables, Dimension::none, kRequired, "Parts.", kAny, {}, &kSegmentSectionOfFigure},
    {"joint", Type::tables, Dimension::none, kRequired, "Joints.", kAny, {}, &kJointSectionOfFigure},
};

const engine::Vec3 kMirror{1, -1, 1};

struct Scaling {
  double along;   // lengths, stature over the file's stature
  double across;  // sqrt(mass/stature) over the file's
  PersonSize size;
};

/// Mass of a part before all are scaled to the person's [kg].
double part_mass(Reader& r, const PersonSize& size) {
  if (r.has("mass_share") == r.has("mass_male")) r.fail_here("must have either mass_male or mass_share");
  if (r.has("mass_share")) return r.number("mass_share") * size.mass;
  const char* key = size.female && r.has("mass_female") ? "mass_female" : "mass_male";
  const std::vector<double> b = r.numbers(key);
  if (b.size() != 3) {
    r.fail(key, "must be three numbers [b0, b1, b2]");
    return 1;
  }
  return b[0] + b[1] * size.mass + b[2] * size.stature * 100;
}

void read_segment(Reader& r, const Scaling& scale, std::vector<Segment>& out) {
  Segment s;
  r.fill(s);
  const bool lengthwise = r.boolean("lengthwise");
  const engine::Vec3 grow{lengthwise ? scale.along : scale.across, scale.across, scale.along};
  s.centre = r.vector("centre").cwiseProduct(grow);
  s.shape = {r.vector("axes").cwiseProduct(grow), std::max(2.0, r.number("exponent"))};
  s.mass = part_mass(r, scale.size);
  const auto colour = r.colour("cloth");
  // bare parts are lit as skin: their red clearly above their blue, and light
  const bool bare = colour[0] > 0.4f && colour[0] > 1.6f * colour[2];
  s.material = {s.name, bare ? render::MaterialKind::skin : render::MaterialKind::cloth, colour, 0.8f, 1.0f};
  if (!r.boolean("sides")) {
    out.push_back(s);
    return;
  }
  const std::string name = s.name;
  s.name = "left_" + name;
  out.push_back(s);
  s.name = "right_" + name;
  s.centre = s.centre.cwiseProduct(kMirror);
  out.push_back(s);
}

std::vector<AnatomicalAngle> read_angles(Reader& r) {
  std::vector<AnatomicalAngle> out;
  for (Reader& angle : r.tables("angle")) {
    const int about = angle.choice("about");
    const auto [lower, upper] = angle.range("range");
    angle.fill(out.emplace_back(AnatomicalAngle{"", engine::Vec3::Unit(about / 2) * (about % 2 == 0 ? 1 : -1), lower, upper, ""}));
    if (out.back().word.empty()) out.back().word = r.text("name") + "_" + out.back().name;
  }
  constexpr int kOrder[] = {1, 0, 2};
  bool ordered = !out.empty() && out.size() <= 3;
  for (std::size_t i = 0; ordered && i < out.size(); ++i) ordered = std::abs(out[i].axis[kOrder[i]]) == 1;
  if (!ordered) r.fail_here("must have one to three angles, about y, x and z in this order");
  return out;
}

int segment_index(Reader& r, const std::vector<Segment>& segments, std::string_view key, const std::string& side) {
  const std::string name = r.text(key);
  for (const std::string& candidate : {side + name, name}) {
    for (std::size_t i = 0; i < segments.size(); ++i)
      if (segments[i].name == candidate) return static_cast<int>(i);
  }
  r.fail(key, "is no part of this person");
  return 0;
}

void read_joint_of_figure(Reader& r, const Scaling& scale, Figure& figure) {
  FigureJoint j;
  const std::vector<AnatomicalAngle> angles = read_angles(r);
  r.fill(j);
  const engine::Vec3 at = r.vector("at").cwiseProduct(engine::Vec3{scale.across, scale.across, scale.along});
  const bool sides = r.boolean("sides");
  for (const std::string side : {"left_", "right_"}) {
    const bool right = sides && side == "right_";
    j.name = (sides ? side : "") + r.text("name");
    j.parent = segment_index(r, figure.segments, "parent", sides ? side : "");
    j.child = segment_index(r, figure.segments, "child", sides ? side : "");
    j.at = right ? at.cwiseProduct(kMirror) : at;
    j.angles = angles;
    if (sides)
      for (AnatomicalAngle& angle : j.angles) angle.word = side + angle.word;
    // the mirror image of a turn about x or z has the other sense, about y the same
    if (right)
      for (AnatomicalAngle& angle : j.angles) angle.axis = angle.axis.cwiseProduct(engine::Vec3{-1, 1, -1});
    figure.joints.push_back(j);
    if (!sides) return;
  }
}

/// Root first, and joints so that a parent is placed before its children. Reports parts that hang on nothing.
void sort_tree(Reader& r, Figure& figure) {
  const std::string root = r.text("root");
  const auto at = std::find_if(figure.segments.begin(), figure.segments.end(), [&](const Segment& s) { return s.name == root; });
  if (at == figure.segments.end()) return r.fail("root", "is no part of this person");
  const int root_index = static_cast<int>(at - figure.segments.begin());
  std::vector<bool> placed(figure.segments.size(), false);
  placed[static_cast<std::size_t>(root_index)] = true;
  std::vector<FigureJoint> sorted;
  for (bool found = true; found;) {
    found = false;
    for (const FigureJoint& j : figure.joints) {
      if (!placed[static_cast<std::size_t>(j.parent)] || placed[static_cast<std::size_t>(j.child)]) continue;
      placed[static_cast<std::size_t>(j.child)] = found = true;
      sorted.push_back(j);
    }
  }
  if (sorted.size() != figure.joints.size() || sorted.size() + 1 != figure.segments.size()) {
    return r.fail("joint", "must join all parts to a tree with the root at its foot");
  }
  figure.joints = std::move(sorted);
  std::rotate(figure.segments.begin(), figure.segments.begin() + root_index, figure.segments.begin() + root_index + 1);
  for (FigureJoint& j : figure.joints) {
    for (int* i : {&j.parent, &j.child}) *i = *i == root_index ? 0 : *i < root_index ? *i + 1 : *i;
  }
}

}  // namespace

const Section kFigureSection{"figure", "scenes/library/persons/NAME.toml",
                             "A person as data; a scene's own lies beside it or in its folder persons/.", kFigureKeys};

namespace {

/// The person's size, within what the figure is made for.
PersonSize read_size(Builder& builder, Reader& person, Reader& figure) {
  PersonSize size{figure.number("stature"), figure.number("mass"), person.choice("sex") == 1};
  auto read = [&](std::string_view key, std::string_view limits, const char* unit, double& value) {
    if (!person.has(key)) return;
    value = person.number(key);
    if (!figure.has(limits)) return;
    const auto [lower, upper] = figure.range(limits);
    if (value >= lower && value <= upper) return;
    person.fail(key, fmt::format("must lie in {:.4g}..{:.4g} {} for the figure {}; the library of persons has {}", lower, upper,
                                 unit, person.text("figure"), fmt::join(library_names(builder, "persons"), ", ")));
  };
  read("stature", "statures", "m", size.stature);
  read("mass", "masses", "kg", size.mass);
  return size;
}

}  // namespace

Figure read_figure(Builder& builder, Reader& person, PersonSize& size) {
  const std::string name = person.text("figure");
  const auto tree = library_entry(builder, "persons", name);
  if (!tree) {
    person.fail("figure", not_in_library(builder, "persons", "figure", name));
    return {};
  }
  const std::size_t errors_before = builder.errors.count();
  Reader r(*tree, kFigureSection, name, builder.errors);
  size = read_size(builder, person, r);
  if (!(size.stature > 0) || !(size.mass > 0) || builder.errors.count() != errors_before) return {};
  const double along = size.stature / r.number("stature");
  const Scaling scale{along, std::sqrt(size.mass / r.number("mass") / along), size};

  Figure out;
  for (Reader& segment : r.tables("segment")) read_segment(segment, scale, out.segments);
  for (Reader& joint : r.tables("joint")) read_joint_of_figure(joint, scale, out);
  sort_tree(r, out);
  if (builder.errors.count() != errors_before) return {};

  double sum = 0;
  for (const Segment& s : out.segments) sum += s.mass;
  for (Segment& s : out.segments) {
    // the regressions are for adults; far outside them a light part can come out without mass
    if (s.mass <= 0) {
      person.fail("mass", fmt::format("is outside the regressions for this stature: the {} would weigh {:.2f} kg", s.name, s.mass));
      return {};
    }
    s.mass *= size.mass / sum;
    s.inertia = engine::principal_inertia(s.shape, s.mass).asDiagonal();
  }
  return out;
}

}  // namespace scenes
