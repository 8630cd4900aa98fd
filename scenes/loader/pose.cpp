// Poses: angles in anatomical words, from the library, the scene's folder, or the person's own `angles`.
#include <fmt/format.h>

#include <numbers>

#include "scenes/loader/figure.h"

namespace scenes {
namespace {

const Key kAngleKeys[] = {
    {"*", Type::number, Dimension::angle, "", "SIDE_JOINT_ANGLE like left_knee_flexion, or JOINT_ANGLE for both sides."}};
}  // namespace

const Section kAnglesSection{"person.angles", "[person.angles]",
                             "Joint angles in anatomical words; those not named are zero, as in standing.", kAngleKeys};

namespace {

const Key kPoseKeys[] = {
    {"title", Type::text, Dimension::none, "''", "What it is."},
    {"roll", Type::number, Dimension::angle, "'0 deg'", "Attitude of the hips: about the forward axis, first."},
    {"pitch", Type::number, Dimension::angle, "'0 deg'",
     "Attitude of the hips: about the axis to the left, second; 90 deg lies face down."},
    {"angles", Type::table, Dimension::none, "", "Joint angles.", kAny, {}, &kAnglesSection},
};

/// The same name on either side, or the one joint that has it.
bool names_angle(const std::string& key, const FigureJoint& joint, const AnatomicalAngle& angle) {
  const std::string full = joint.name + "_" + angle.name;
  return key == full || "left_" + key == full || "right_" + key == full;
}

void apply_angles(Reader angles, const Figure& figure, Pose& pose) {
  std::vector<std::string> known;
  for (const FigureJoint& joint : figure.joints)
    for (const AnatomicalAngle& angle : joint.angles) {
      const std::string name = joint.name + "_" + angle.name;
      known.push_back(name);
      if (name.starts_with("left_")) known.push_back(name.substr(5));
    }
  for (const Entry& entry : angles.value().entries) {
    const double value = angles.number(entry.key);
    bool found = false;
    bool refused = false;
    for (std::size_t j = 0; j < figure.joints.size(); ++j) {
      for (std::size_t a = 0; a < figure.joints[j].angles.size(); ++a) {
        const AnatomicalAngle& angle = figure.joints[j].angles[a];
        if (!names_angle(entry.key, figure.joints[j], angle)) continue;
        found = true;
        constexpr double kRounding = 1e-9;  // [rad] "140 deg" is in a range that ends at "140 deg"
        if ((value < angle.lower - kRounding || value > angle.upper + kRounding) && !refused) {
          constexpr double kDegree = std::numbers::pi / 180;
          angles.fail(entry.key, fmt::format("must lie in {:.4g}..{:.4g} deg; that is the range of {} of joint {}",
                                             angle.lower / kDegree, angle.upper / kDegree, angle.name, figure.joints[j].name));
          refused = true;
        }
        pose.angles[j][a] = value;
      }
    }
    if (!found) {
      const std::string guess = nearest(entry.key, known);
      angles.fail(entry.key, guess.empty() ? "is no angle of this person; write like left_knee_flexion"
                                           : fmt::format("is no angle of this person; did you mean \"{}\"?", guess));
    }
  }
}

}  // namespace

const Section kPoseSection{"pose", "scenes/library/poses/NAME.toml",
                           "A pose as data; a scene's own lies beside it or in its folder poses/.", kPoseKeys};

Pose read_pose(Builder& builder, Reader& person, const Figure& figure) {
  Pose out;
  for (const FigureJoint& joint : figure.joints) out.angles.emplace_back(joint.angles.size(), 0.0);
  const std::string name = person.text("pose");
  const auto file = library_file(builder, "poses", name);
  if (file.empty()) {
    const auto names = library_names(builder, "poses");
    const std::string guess = nearest(name, names);
    person.fail("pose", fmt::format("is not in the library of poses ({}){}", fmt::join(names, ", "),
                                    guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)));
  } else {
    const Value tree = parse_file(file);
    Reader r(tree, kPoseSection, name, builder.errors);
    out.roll = r.number("roll");
    out.pitch = r.number("pitch");
    if (auto angles = r.table("angles")) apply_angles(*angles, figure, out);
  }
  if (auto angles = person.table("angles")) apply_angles(*angles, figure, out);
  return out;
}

}  // namespace scenes
