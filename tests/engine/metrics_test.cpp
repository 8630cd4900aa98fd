#include "engine/measure/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace engine {
namespace {

struct Pulse {
  std::vector<double> times, acceleration;
};

Pulse half_sine(double peak_g, double duration) {
  Pulse pulse;
  const int samples = 2000;
  for (int i = 0; i <= samples; ++i) {
    pulse.times.push_back(duration * i / samples);
    pulse.acceleration.push_back(peak_g * std::sin(std::numbers::pi * i / samples));
  }
  return pulse;
}

TEST(HeadInjury, HalfSinesHaveTheirTabulatedValues) {
  const Pulse short_pulse = half_sine(100, 0.010), long_pulse = half_sine(100, 0.020);
  // 2000 samples: windows end within 1/4000 of the optimum, where the criterion is flat; the trapezium rule errs by 1e-6
  EXPECT_NEAR(hic(short_pulse.times, short_pulse.acceleration, 0.015), 414.65, 0.01);
  EXPECT_NEAR(hic(long_pulse.times, long_pulse.acceleration, 0.015), 829.29, 0.02);
  EXPECT_NEAR(three_ms_clip(short_pulse.times, short_pulse.acceleration), 89.10, 0.005);
}

TEST(HeadInjury, RigidImpactsSayWhyTheyHaveNone) {
  Model model;
  EXPECT_NE(why_no_head_injury(model), "");
  model.settings.contact_law = ContactLaw::compliant;
  EXPECT_EQ(why_no_head_injury(model), "");
}

}  // namespace
}  // namespace engine
