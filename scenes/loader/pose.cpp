// Poses: angles in anatomical words, from the library, the scene's folder, or the person's own `angles`.
#include <fmt/format.h>

#include <algorithm>
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
    bound<&Pose::title>({"title", Type::text, Dimension::none, "''", "What it is."}),
    bound<&Pose::roll>({"roll", Type::number, Dimension::angle, "'0 deg'", "Attitude of the hips: about the forward axis, first."}),
    bound<&Pose::pitch>({"pitch", Type::number, Dimension::angle, "'0 deg'",
                         "Attitude of the hips: about the axis to the left, second; 90 deg lies face down."}),
    {"angles", Type::table, Dimension::none, "", "Joint angles.", kAny, {}, &kAnglesSection},
};

/// The same word on either side, or the one joint that has it.
bool names_angle(const std::string& key, const AnatomicalAngle& angle) {
  return key == angle.word || "left_" + key == angle.word || "right_" + key == angle.word;
}

/// Words a pose may use, those of the left side also without it.
std::vector<std::string> words_of(const Figure& figure) {
  std::vector<std::string> out;
  for (const FigureJoint& joint : figure.joints)
    for (const AnatomicalAngle& angle : joint.angles) {
      out.push_back(angle.word);
      if (angle.word.starts_with("left_")) out.push_back(angle.word.substr(5));
    }
  return out;
}

int sharers(const Figure& figure, const std::string& word) {
  int count = 0;
  for (const FigureJoint& joint : figure.joints)
    for (const AnatomicalAngle& angle : joint.angles) count += angle.word == word;
  return count;
}

/// Does the figure have the joint of "shoulder_rotation", though not that angle of it?
bool lacks_only_the_angle(const std::vector<std::string>& known, const std::string& key) {
  const std::string joint = key.substr(0, key.rfind('_') + 1);
  return !joint.empty() &&
         std::any_of(known.begin(), known.end(), [&](const std::string& word) { return word.starts_with(joint); });
}

enum class Source { pose, person };

/// Puts one angle where its word says; false: no joint has it.
bool apply_angle(Reader& angles, const std::string& key, double value, const Figure& figure, Pose& pose) {
  bool found = false;
  bool refused = false;
  for (std::size_t j = 0; j < figure.joints.size(); ++j) {
    for (std::size_t a = 0; a < figure.joints[j].angles.size(); ++a) {
      const AnatomicalAngle& angle = figure.joints[j].angles[a];
      if (!names_angle(key, angle)) continue;
      found = true;
      const int parts = sharers(figure, angle.word);
      const double part = value / parts;
      constexpr double kRounding = 1e-9;  // [rad] "140 deg" is in a range that ends at "140 deg"
      if ((part < angle.lower - kRounding || part > angle.upper + kRounding) && !refused) {
        constexpr double kDegree = std::numbers::pi / 180;
        angles.fail(
            key, fmt::format("must lie in {:.4g}..{:.4g} deg; that is the range of {} of joint {}", parts * angle.lower / kDegree,
                             parts * angle.upper / kDegree, angle.name, figure.joints[j].name));
        refused = true;
      }
      pose.angles[j][a] = part;
    }
  }
  return found;
}

void apply_angles(Reader angles, Source source, const Figure& figure, Pose& pose) {
  const std::vector<std::string> known = words_of(figure);
  for (const Entry& entry : angles.value().entries) {
    if (apply_angle(angles, entry.key, angles.number(entry.key), figure, pose)) continue;
    // a pose serves every figure: what it asks of a joint that turns in fewer ways is left out, and told
    if (source == Source::pose && lacks_only_the_angle(known, entry.key)) {
      angles.warn(entry.key, "is left out: this person's joint does not turn that way");
      continue;
    }
    const std::string guess = nearest(entry.key, known);
    angles.fail(entry.key, guess.empty() ? "is no angle of this person; write like left_knee_flexion"
                                         : fmt::format("is no angle of this person; did you mean \"{}\"?", guess));
  }
}

}  // namespace

const Section kPoseSection{"pose", "scenes/library/poses/NAME.toml",
                           "A pose as data; a scene's own lies beside it or in its folder poses/.", kPoseKeys};

Pose read_pose(Builder& builder, Reader& person, const Figure& figure) {
  Pose out;
  for (const FigureJoint& joint : figure.joints) out.angles.emplace_back(joint.angles.size(), 0.0);
  const std::string name = person.text("pose");
  const auto tree = library_entry(builder, "poses", name);
  if (!tree) {
    person.fail("pose", not_in_library(builder, "poses", "pose", name));
  } else {
    Reader r(*tree, kPoseSection, name, builder.errors);
    r.fill(out);
    if (auto angles = r.table("angles")) apply_angles(*angles, Source::pose, figure, out);
  }
  if (auto angles = person.table("angles")) apply_angles(*angles, Source::person, figure, out);
  return out;
}

}  // namespace scenes
