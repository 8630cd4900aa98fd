#include "scenes/loader/units.h"

#include <array>
#include <cassert>
#include <numbers>

namespace scenes {
namespace {

constexpr std::array<DimensionLine, 16> kDimensions{{
    {"a plain number", "", "", "", {}},
    {"a length", "m", "m", "cm", {1, 0, 0, 0}, "m, cm, mm, km, ft, in"},
    {"a mass", "kg", "kg", "lb", {0, 1, 0, 0}, "kg, g, t, lb"},
    {"a time", "s", "s", "ms", {0, 0, 1, 0}, "s, ms, min, h"},
    {"an angle", "rad", "deg", "rad", {0, 0, 0, 1}, "deg, rad"},
    {"a speed", "m/s", "km/h", "m/s", {1, 0, -1, 0}, "km/h, m/s, mph, ft/s"},
    {"an angular speed", "rad/s", "rad/s", "deg/s", {0, 0, -1, 1}},
    {"an acceleration", "m/s^2", "m/s^2", "g", {1, 0, -2, 0}, "m/s^2, g"},
    {"a force", "N", "N", "kN", {1, 1, -2, 0}, "N, kN, lbf"},
    {"a stiffness", "N/m", "N/m", "kN/m", {0, 1, -2, 0}},
    {"a damping", "N s/m", "N s/m", "kN s/m", {0, 1, -1, 0}},
    {"a torque", "N m", "N m", "kN m", {2, 1, -2, 0}},
    {"an angular stiffness", "N m/rad", "N m/rad", "N m/deg", {2, 1, -2, -1}},
    {"an angular damping", "N m s/rad", "N m s/rad", "N m s/deg", {2, 1, -1, -1}},
    {"a moment of inertia", "kg m^2", "kg m^2", "g cm^2", {2, 1, 0, 0}},
    {"a density", "kg/m^3", "kg/m^3", "g/cm^3", {-3, 1, 0, 0}},
}};

constexpr double kPound = 0.45359237;  // [kg] international pound, exact since 1959
constexpr double kInch = 0.0254;       // [m] exact

constexpr Unit kUnits[] = {
    {"m", 1, {1, 0, 0, 0}},
    {"km", 1e3, {1, 0, 0, 0}},
    {"cm", 1e-2, {1, 0, 0, 0}},
    {"mm", 1e-3, {1, 0, 0, 0}},
    {"um", 1e-6, {1, 0, 0, 0}},
    {"in", kInch, {1, 0, 0, 0}},
    {"ft", 12 * kInch, {1, 0, 0, 0}},
    {"yd", 36 * kInch, {1, 0, 0, 0}},
    {"mi", 63360 * kInch, {1, 0, 0, 0}},
    {"kg", 1, {0, 1, 0, 0}},
    {"g", 1e-3, {0, 1, 0, 0}},
    {"t", 1e3, {0, 1, 0, 0}},
    {"lb", kPound, {0, 1, 0, 0}},
    {"slug", kPound * 9.80665 / (12 * kInch), {0, 1, 0, 0}},
    {"s", 1, {0, 0, 1, 0}},
    {"ms", 1e-3, {0, 0, 1, 0}},
    {"us", 1e-6, {0, 0, 1, 0}},
    {"min", 60, {0, 0, 1, 0}},
    {"h", 3600, {0, 0, 1, 0}},
    {"rad", 1, {0, 0, 0, 1}},
    {"deg", std::numbers::pi / 180, {0, 0, 0, 1}},
    {"°", std::numbers::pi / 180, {0, 0, 0, 1}},
    {"rev", 2 * std::numbers::pi, {0, 0, 0, 1}},
    {"rpm", 2 * std::numbers::pi / 60, {0, 0, -1, 1}},
    {"kph", 1 / 3.6, {1, 0, -1, 0}},
    {"mph", 63360 * kInch / 3600, {1, 0, -1, 0}},
    {"N", 1, {1, 1, -2, 0}},
    {"kN", 1e3, {1, 1, -2, 0}},
    {"MN", 1e6, {1, 1, -2, 0}},
    {"lbf", kPound * 9.80665, {1, 1, -2, 0}},
    {"Hz", 1, {0, 0, -1, 0}},
    {"%", 0.01, {}},
};

}  // namespace

const DimensionLine& line(Dimension d) {
  return kDimensions[static_cast<std::size_t>(d)];
}

std::span<const Unit> all_units() {
  return kUnits;
}

Powers powers_of(Dimension d) {
  return line(d).powers;
}

std::optional<UnitSize> unit_named(std::string_view symbol) {
  for (const Unit& unit : kUnits)
    if (unit.symbol == symbol) return UnitSize{unit.factor, unit.powers};
  return std::nullopt;
}

Dimension dimension_of(std::string_view unit) {
  for (std::size_t d = 0; d < kDimensions.size(); ++d)
    if (kDimensions[d].si == unit) return static_cast<Dimension>(d);
  assert(false && "a unit of the table");
  return Dimension::none;
}

std::string_view name_of(Dimension d) {
  return line(d).name;
}
std::string_view si_unit(Dimension d) {
  return line(d).si;
}
std::string_view usual_unit(Dimension d) {
  return line(d).usual;
}

}  // namespace scenes
