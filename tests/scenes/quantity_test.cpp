#include "scenes/loader/quantity.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scenes {
namespace {

struct Case {
  const char* text;
  Dimension dimension;
  double value;
};

class Quantities_ : public ::testing::TestWithParam<Case> {};

TEST_P(Quantities_, AreReadInSi) {
  const Quantity q = parse_quantity(GetParam().text, GetParam().dimension);
  EXPECT_EQ(q.problem, "");
  // one multiplication by a factor known to a rounding error
  EXPECT_NEAR(q.value, GetParam().value, 4e-16 * std::abs(GetParam().value)) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Units, Quantities_,
    ::testing::Values(Case{"40 km/h", Dimension::speed, 40 / 3.6}, Case{"35 mph", Dimension::speed, 35 * 0.44704},
                      Case{"5 ft 9 in", Dimension::length, 1.7526}, Case{"-5 ft 9 in", Dimension::length, -1.7526},
                      Case{"78 kg", Dimension::mass, 78}, Case{"172 lb", Dimension::mass, 172 * 0.45359237},
                      Case{"30 deg", Dimension::angle, M_PI / 6}, Case{"0.5 rad", Dimension::angle, 0.5},
                      Case{"1 ms", Dimension::time, 1e-3}, Case{"12 kN", Dimension::force, 12e3},
                      Case{"25 N/mm", Dimension::stiffness, 25e3}, Case{"9.81 m/s^2", Dimension::acceleration, 9.81},
                      Case{"0.3 g", Dimension::acceleration, 0.3 * 9.81}, Case{"10 g", Dimension::mass, 0.01},
                      Case{"50 g cm^2", Dimension::inertia, 5e-6}, Case{"2 N m s/rad", Dimension::angular_damping, 2},
                      Case{"3 kg*m^2", Dimension::inertia, 3}, Case{"1.5e-2m", Dimension::length, 0.015},
                      Case{"60 %", Dimension::none, 0.6}, Case{"0.6", Dimension::none, 0.6}));

struct Refused {
  const char* text;
  Dimension dimension;
  const char* problem;
};

class Texts : public ::testing::TestWithParam<Refused> {};

TEST_P(Texts, ThatAreNoQuantityAreRefusedWithTheRemedy) {
  EXPECT_EQ(parse_quantity(GetParam().text, GetParam().dimension).problem, GetParam().problem);
}

INSTANTIATE_TEST_SUITE_P(
    Slips, Texts,
    ::testing::Values(Refused{"40 kg", Dimension::speed, "must be a speed; write it like \"1 km/h\"; units: km/h, m/s, mph, ft/s"},
                      Refused{"5 %", Dimension::angle, "is a grade, and must be an angle; write \"2.862 deg\""},
                      Refused{"40", Dimension::speed, "needs a unit: write \"40 km/h\" or \"11.1 m/s\""},
                      Refused{"40 kmh", Dimension::speed, "\"kmh\" is not a unit; did you mean \"40 km/h\"?"},
                      Refused{"nan m", Dimension::length, "must be a length; write it like \"1 m\"; units: m, cm, mm, km, ft, in"},
                      Refused{"1e999 m", Dimension::length,
                              "must be a length; write it like \"1 m\"; units: m, cm, mm, km, ft, in"},
                      Refused{"0x10 m", Dimension::length, "must be a length; write it like \"1 m\"; units: m, cm, mm, km, ft, in"},
                      Refused{"1,5 m", Dimension::length, "has a decimal comma; write \"1.5 m\""},
                      Refused{"", Dimension::length, "must be a length; write it like \"1 m\"; units: m, cm, mm, km, ft, in"},
                      Refused{"0.6 m", Dimension::none, "must be a plain number without a unit"}));

TEST(QuantityLists, ShareOneUnit) {
  const Quantities q = parse_quantities("1 -2 3.5 km", Dimension::length);
  EXPECT_EQ(q.values, (std::vector<double>{1000, -2000, 3500}));
  EXPECT_NE(parse_quantities("1 2 3 s", Dimension::length).problem, "");
}

}  // namespace
}  // namespace scenes
