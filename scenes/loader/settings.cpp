// [simulation]: step, scheme, gravity and which effects are forced.

#include "engine/math/functions.h"
#include "scenes/loader/builder.h"

namespace scenes {
namespace {

constexpr Key kEffectKeys[] = {
    {"*", Type::choice, Dimension::none, "",
     "An effect by its name in `crashreel plan`: left to the plan, forced on, or forced off. "
     "Off is shown as a warning in every output.",
     kAny, "automatic|on|off"},
};
const Section kEffectsSection{"simulation.effects", "[simulation.effects]", "Physical effects forced on or off. Normally none.",
                              kEffectKeys};

/// What steps, tolerances and gravity follow from.
enum class Profile { draft, standard, fine, reference };
struct SettingsGiven {
  Profile profile = Profile::standard;
  double gravity = 0, slope = 0;  // [m/s^2], [rad]
};

constexpr double kRightAngle = 1.5707963267948966;

const Key kSimulationKeys[] = {
    bound<&engine::Settings::duration>(
        {"duration", Type::number, Dimension::time, "'4 s'", "Simulated time.", Range{0, 600, true}}),
    bound<&SettingsGiven::profile>(
        {"profile", Type::choice, Dimension::none, "'standard'",
         "Step and solver tolerance where the scene does not give them: draft 4 ms and 0.1 mm/s, standard 1 ms and 0.01 mm/s, fine "
         "0.25 ms and 0.001 mm/s, reference 0.0625 ms and 0.0001 mm/s.",
         kAny, "draft|standard|fine|reference"}),
    bound<&engine::Settings::step>(
        {"step", Type::number, Dimension::time, "'1 ms'", "Time step.", Range{0, 0.1, true}, {}, nullptr, "1 ms is a good start"}),
    bound<&engine::Settings::record_interval>({"record_interval", Type::number, Dimension::time, "'5 ms'",
                                               "Time between recorded instants, rounded to whole steps.", Range{0, 1, true}}),
    bound<&engine::Settings::scheme>(
        {"scheme", Type::choice, Dimension::none, "'stepping'",
         "Integration. stepping: Runge-Kutta 4 for the smooth motion, velocity Verlet for what is touched; contacts, limits and "
         "joint resistance implicit at the end of the step. rk4: joint resistance and compliant contacts too are evaluated anew in "
         "each of four stages. adaptive: rk4 with steps no longer than `step`, divided until the error is below "
         "`adaptive_tolerance`.",
         kAny, "stepping|rk4|adaptive"}),
    bound<&engine::Settings::adaptive_tolerance>(
        {"adaptive_tolerance", Type::number, Dimension::length, "'0.01 mm'",
         "Error of one step's smooth motion, and a tenth of the penetration it may leave; scheme adaptive.", kPositive}),
    bound<&engine::Settings::contact_law>(
        {"contact_law", Type::choice, Dimension::none, "'persons_yield'",
         "persons_yield: a person's contacts and the ends of its joints' ranges by the compliant law, all else by default_auto. "
         "default_auto: surfaces do not give way; impulses at first touch, at all touching points at once, restitution is a ratio "
         "of speeds. compliant: force = stiffness x depth while closing, restitution x stiffness x depth while parting, so that "
         "restitution is the share of energy that comes back.",
         kAny, "default_auto|compliant|persons_yield"}),
    bound<&SettingsGiven::gravity>(
        {"gravity", Type::number, Dimension::acceleration, "'9.81 m/s^2'", "Acceleration of gravity; 0 for none.", kNotNegative}),
    bound<&SettingsGiven::slope>(
        {"slope", Type::number, Dimension::angle, "'0 deg'",
         "Tilts the whole world: the ground stays z = height and gravity turns, so that +x runs downhill at this angle.",
         between(-kRightAngle, kRightAngle)}),
    bound<&engine::Settings::solver_tolerance>({"solver_tolerance", Type::number, Dimension::speed, "'0.01 mm/s'",
                                                "Residual at which the contact solver stops.", kPositive}),
    bound<&engine::Settings::touch_distance>(
        {"touch_distance", Type::number, Dimension::length, "'0.02 mm'",
         "Rigid surfaces this near take part in an impact beside them; an impact itself acts at the surface.",
         between(1e-9, 1e-3)}),
    bound<&engine::Settings::contacts_per_pair>(
        {"contacts_per_pair", Type::integer, Dimension::none, "10",
         "Points at most at which two meshes, or a mesh and the ground, hold each other at a time.", between(3, 100)}),
    bound<&engine::Settings::locate_events>(
        {"locate_events", Type::boolean, Dimension::none, "true",
         "Place impacts (and with rk4 touch, turn and separation of compliant contacts) inside the step."}),
    bound<&engine::Settings::sleep>(
        {"sleep", Type::boolean, Dimension::none, "false",
         "What moves less than 0.02 mm in a second is left alone until something comes near: long waits cost little."}),
    bound<&engine::Settings::stop_at_rest>({"stop_at_rest", Type::boolean, Dimension::none, "true",
                                            "End the run when all rests, and neither a grade or wind nor a driver, brake or "
                                            "friction that changes later sets it in motion."}),
    {"effects", Type::table, Dimension::none, "", "Effects forced on or off.", kAny, {}, &kEffectsSection},
};

}  // namespace

const Section kSimulationSection{"simulation", "[simulation]", "How the motion is computed.", kSimulationKeys};

namespace {

/// What accuracy costs is told for each in scenes/README.md, from `crashreel study` of the shipped cases.
struct Accuracy {
  double step, solver_tolerance;  // [s], [m/s]
};
constexpr Accuracy kAccuracies[] = {{4e-3, 1e-4}, {1e-3, 1e-5}, {0.25e-3, 1e-6}, {0.0625e-3, 1e-7}};

}  // namespace

void read_settings(Builder& builder, std::optional<Reader> reader) {
  // an absent section is an empty one: the defaults of the table apply
  Reader r = reader ? *reader : Reader(empty_table(), kSimulationSection, "simulation", builder.errors);
  engine::Settings& s = builder.scene.model.settings;
  SettingsGiven given;
  r.fill(s);
  r.fill(given);
  const Accuracy& accuracy = kAccuracies[static_cast<std::size_t>(given.profile)];
  if (!r.has("step")) s.step = accuracy.step;
  if (!r.has("solver_tolerance")) s.solver_tolerance = accuracy.solver_tolerance;
  const double g = given.gravity, slope = given.slope;
  s.gravity = {g * engine::math::sin(slope), 0, -g * engine::math::cos(slope)};
  if (slope == 0) s.gravity = {0, 0, -g};
  if (s.step > 0 && s.record_interval < s.step) r.fail("record_interval", "must not be shorter than the step");
  // a collision is told from what is exchanged within 20 ms, and a flight from 50 ms without a touch
  constexpr double kCoarse = 10e-3;  // [s] up to there delta-v of the cases stays as it is at 1 ms
  if (s.record_interval > kCoarse && r.has("record_interval"))
    r.warn("record_interval",
           "is longer than 10 ms: delta-v, PDOF, EES, the table of impacts and the phases of a throw are read off "
           "the recorded instants and come out wrong; 5 ms is a good value");
  if (auto effects = r.table("effects")) {
    for (const Entry& entry : effects->value().entries)
      s.effects[entry.key] = static_cast<engine::Force>(effects->choice(entry.key));
  }
}

}  // namespace scenes
