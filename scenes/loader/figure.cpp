// The library file of a person, and how it is sized: lengths with stature, cross axes with sqrt(mass/stature), masses by
// regression.
#include "scenes/loader/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace scenes {
namespace {

/// What a part's size, mass and mirror image follow from.
struct SegmentGiven {
  bool sides = false, lengthwise = false;
  std::optional<std::vector<double>> mass_male, mass_female;  // regressions
  std::optional<double> mass_share;                           // [-]
};

const Key kFigureSegmentKeys[] = {
    bound<&Segment::name>(
        {"name", Type::text, Dimension::none, kRequired, "Name of the part; with sides it becomes left_NAME and right_NAME."}),
    bound<&SegmentGiven::sides>(
        {"sides", Type::boolean, Dimension::none, "false", "Given for the left side; the right one is its mirror image."}),
    bound<&Segment::centre>(
        {"centre", Type::vector3, Dimension::length, kRequired, "Centre when standing, x forward, y left, z above the soles."}),
    bound<&Segment::shape, &engine::HyperEllipsoid::semi_axes>(
        {"axes", Type::vector3, Dimension::length, kRequired, "Semi-axes.", kExtent}),
    bound<&Segment::shape, &engine::HyperEllipsoid::exponent>({"exponent",
                                                               Type::number,
                                                               Dimension::none,
                                                               "2",
                                                               "Exponent n.",
                                                               between(2, 100),
                                                               {},
                                                               nullptr,
                                                               "a hyper-ellipsoid needs n >= 2"}),
    bound<&SegmentGiven::mass_male>(
        {"mass_male", Type::numbers, Dimension::none, "",
         "[b0, b1, b2]: mass in kg = b0 + b1 mass/kg + b2 stature/cm; all parts are then scaled to the person's mass."}),
    bound<&SegmentGiven::mass_female>(
        {"mass_female", Type::numbers, Dimension::none, "", "The same for women; left out: as for men."}),
    bound<&SegmentGiven::mass_share>(
        {"mass_share", Type::number, Dimension::none, "", "Share of the person's mass, in place of a regression.", kPositive}),
    bound<&SegmentGiven::lengthwise>(
        {"lengthwise", Type::boolean, Dimension::none, "false", "Its x axis grows with stature, like a foot."}),
    bound<&Segment::stiffness>({"stiffness", Type::number, Dimension::stiffness, "'400 kN/m'",
                                "What it yields by against whatever it touches, in series with it.", kPositive}),
    bound<&Segment::material, &render::Material::colour>({"cloth", Type::colour, Dimension::none, "'#808080'", "Colour."}),
};
const Section kSegmentSectionOfFigure{"figure.segment", "[[segment]]", "In a person's library file: one part.", kFigureSegmentKeys};

enum class Turn { x, minus_x, y, minus_y, z, minus_z };
struct AngleGiven {
  Turn about = Turn::x;
};

const Key kFigureAngleKeys[] = {
    bound<&AnatomicalAngle::name>(
        {"name", Type::text, Dimension::none, kRequired, "The word used in poses: JOINT_NAME, like knee_flexion."}),
    bound<&AngleGiven::about>({"about", Type::choice, Dimension::none, kRequired,
                               "Axis of the standing person that a positive angle turns about.", kAny, "+x|-x|+y|-y|+z|-z"}),
    bound_to_ends<&AnatomicalAngle::lower, &AnatomicalAngle::upper>(
        {"range", Type::range, Dimension::angle, kRequired, "Range of motion."}),
    bound<&AnatomicalAngle::word>(
        {"word", Type::text, Dimension::none, "''",
         "Another word for poses. Angles of several joints that have one in common take an even part of it each."}),
};
const Section kAngleSectionOfFigure{"figure.joint.angle", "[[joint.angle]]", "In a person's library file: one angle of a joint.",
                                    kFigureAngleKeys};

struct JointGiven {
  bool sides = false;
};

const Key kFigureJointKeys[] = {
    bound<&FigureJoint::name>(
        {"name", Type::text, Dimension::none, kRequired, "Name of the joint; with sides left_NAME and right_NAME."}),
    bound<&JointGiven::sides>(
        {"sides", Type::boolean, Dimension::none, "false", "Given for the left side; the right one is its mirror image."}),
    {"parent", Type::text, Dimension::none, kRequired, "The part nearer to the root."},
    {"child", Type::text, Dimension::none, kRequired, "The part it carries."},
    bound<&FigureJoint::at>({"at", Type::vector3, Dimension::length, kRequired, "Its centre when standing."}),
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
    {"slide",
     Type::table,
     Dimension::none,
     "",
     "Of a joint of three angles: how the child gives way along z of the standing person, from the parent upwards. Not with the "
     "contact law default_auto, which has no forces.",
     kAny,
     {},
     &kSlideSection},
};
const Section kJointSectionOfFigure{"figure.joint", "[[joint]] of a person's file", "In a person's library file: one joint.",
                                    kFigureJointKeys};

/// Whom the file is made for.
struct FigureGiven {
  std::string title, root;
  double stature = 0, mass = 0;                           // [m], [kg]
  std::optional<std::array<double, 2>> statures, masses;  // [m], [kg]
};

const Key kFigureKeys[] = {
    bound<&FigureGiven::title>({"title", Type::text, Dimension::none, "''", "What it is."}),
    bound<&FigureGiven::stature>(
        {"stature", Type::number, Dimension::length, kRequired, "Stature the figures are for.", kPositive}),
    bound<&FigureGiven::mass>({"mass", Type::number, Dimension::mass, kRequired, "Mass the figures are for.", kPositive}),
    bound<&FigureGiven::statures>({"statures", Type::range, Dimension::length, "", "Statures it may be sized to. Left out: any."}),
    bound<&FigureGiven::masses>({"masses", Type::range, Dimension::mass, "", "Masses it may be sized to. Left out: any."}),
    bound<&FigureGiven::root>({"root", Type::text, Dimension::none, kRequired, "The part all others hang on."}),
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
double part_mass(Reader& r, const SegmentGiven& given, const PersonSize& size) {
  if (given.mass_share.has_value() == given.mass_male.has_value()) r.fail_here("must have either mass_male or mass_share");
  if (given.mass_share) return *given.mass_share * size.mass;
  const bool female = size.female && given.mass_female;
  const std::vector<double> b = (female ? given.mass_female : given.mass_male).value_or(std::vector<double>{});
  if (b.size() != 3) {
    r.fail(female ? "mass_female" : "mass_male", "must be three numbers [b0, b1, b2]");
    return 1;
  }
  return b[0] + b[1] * size.mass + b[2] * size.stature * 100;
}

void read_segment(Reader& r, const Scaling& scale, std::vector<Segment>& out) {
  Segment s;
  SegmentGiven given;
  r.fill(s);
  r.fill(given);
  const engine::Vec3 grow{given.lengthwise ? scale.along : scale.across, scale.across, scale.along};
  s.centre = s.centre.cwiseProduct(grow);
  s.shape = {s.shape.semi_axes.cwiseProduct(grow), std::max(2.0, s.shape.exponent)};
  s.mass = part_mass(r, given, scale.size);
  const auto colour = s.material.colour;
  // bare parts are lit as skin: their red clearly above their blue, and light
  const bool bare = colour[0] > 0.4f && colour[0] > 1.6f * colour[2];
  s.material = {s.name, bare ? render::MaterialKind::skin : render::MaterialKind::cloth, colour, 0.8f, 1.0f};
  if (!given.sides) {
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
    AngleGiven given;
    angle.fill(given);
    const int about = static_cast<int>(given.about);
    angle.fill(out.emplace_back(AnatomicalAngle{"", engine::Vec3::Unit(about / 2) * (about % 2 == 0 ? 1 : -1), 0, 0, ""}));
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
  JointGiven given;
  const std::vector<AnatomicalAngle> angles = read_angles(r);
  r.fill(j);
  if (auto slide = r.table("slide")) {
    if (angles.size() != 3) slide->fail_here("is of a joint of three angles");
    slide->fill(j.slide.emplace());
    // as a column of that size, of the same material
    j.slide->lower *= scale.along, j.slide->upper *= scale.along, j.slide->rest *= scale.along;
    const double stiffer = scale.across * scale.across / scale.along;
    j.slide->stiffness *= stiffer, j.slide->damping *= stiffer, j.slide->stop_stiffness *= stiffer;
  }
  r.fill(given);
  const std::string name = j.name;
  const engine::Vec3 at = j.at.cwiseProduct(engine::Vec3{scale.across, scale.across, scale.along});
  const bool sides = given.sides;
  for (const std::string side : {"left_", "right_"}) {
    const bool right = sides && side == "right_";
    j.name = (sides ? side : "") + name;
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
void sort_tree(Reader& r, const std::string& root, Figure& figure) {
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
PersonSize read_size(Builder& builder, Reader& person, const FigureGiven& figure) {
  PersonSize size{figure.stature, figure.mass};
  person.fill(size);
  const auto check = [&](std::string_view key, const std::optional<std::array<double, 2>>& limits, const char* unit, double value) {
    if (!person.has(key) || !limits || (value >= (*limits)[0] && value <= (*limits)[1])) return;
    person.fail(key, fmt::format("must lie in {:.4g}..{:.4g} {} for the figure {}; the library of persons has {}", (*limits)[0],
                                 (*limits)[1], unit, person.text("figure"), fmt::join(library_names(builder, "persons"), ", ")));
  };
  check("stature", figure.statures, "m", size.stature);
  check("mass", figure.masses, "kg", size.mass);
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
  FigureGiven given;
  r.fill(given);
  size = read_size(builder, person, given);
  if (!(size.stature > 0) || !(size.mass > 0) || builder.errors.count() != errors_before) return {};
  const double along = size.stature / given.stature;
  const Scaling scale{along, std::sqrt(size.mass / given.mass / along), size};

  Figure out;
  for (Reader& segment : r.tables("segment")) read_segment(segment, scale, out.segments);
  for (Reader& joint : r.tables("joint")) read_joint_of_figure(joint, scale, out);
  sort_tree(r, given.root, out);
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
