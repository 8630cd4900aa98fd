#include "scenes/loader/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/model/model.h"

namespace scenes {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t';
}
bool is_number_start(std::string_view t) {
  return !t.empty() && ((t[0] >= '0' && t[0] <= '9') || t[0] == '.' || ((t[0] == '-' || t[0] == '+') && t.size() > 1));
}

void skip_spaces(std::string_view& t) {
  while (!t.empty() && is_space(t.front())) t.remove_prefix(1);
}

std::optional<double> take_number(std::string_view& t) {
  if (!is_number_start(t)) return std::nullopt;
  std::string_view digits = t;
  if (digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // "0x10" stops at the x and would read as zero; an exponent too large is an error of from_chars
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  t.remove_prefix(static_cast<std::size_t>(end - t.data()));
  if (!t.empty() && (t.front() == 'x' || t.front() == 'X' || t.front() == ',' || t.front() == '_')) return std::nullopt;
  return value;
}

struct UnitValue {
  double factor = 1;
  Powers powers;
  std::string unknown;  // the symbol that is not a unit
};

/// Product of units: "N m s/rad", "kg*m^2", "m/s^2". One slash divides by what directly follows it.
UnitValue take_unit(std::string_view& t, Dimension wanted) {
  UnitValue out;
  bool divide = false;
  for (;;) {
    skip_spaces(t);
    if (t.empty() || is_number_start(t)) return out;
    if (t.front() == '*') {
      t.remove_prefix(1);
      continue;
    }
    if (t.front() == '/') {
      divide = true;
      t.remove_prefix(1);
      continue;
    }
    std::size_t length = 0;
    while (length < t.size() && !is_space(t[length]) && t[length] != '/' && t[length] != '*' && t[length] != '^' &&
           !(t[length] >= '0' && t[length] <= '9'))
      ++length;
    const std::string_view symbol = t.substr(0, length);
    t.remove_prefix(length);
    int power = 1;
    if (!t.empty() && t.front() == '^') t.remove_prefix(1);
    if (!t.empty() && (t.front() == '2' || t.front() == '3')) {
      power = t.front() - '0';
      t.remove_prefix(1);
    }
    if (divide) power = -power;
    divide = false;
    const Unit* unit = nullptr;
    for (const Unit& candidate : all_units())
      if (candidate.symbol == symbol) unit = &candidate;
    constexpr Unit kGravityUnit{"g", engine::kGravity, {1, 0, -2, 0}};
    if (symbol == "g" && wanted == Dimension::acceleration) unit = &kGravityUnit;
    if (!unit) {
      out.unknown = symbol.empty() ? std::string(t.substr(0, 1)) : std::string(symbol);
      return out;
    }
    for (int k = 0; k < std::abs(power); ++k) power > 0 ? out.factor *= unit->factor : out.factor /= unit->factor;
    out.powers.m += power * unit->powers.m;
    out.powers.kg += power * unit->powers.kg;
    out.powers.s += power * unit->powers.s;
    out.powers.rad += power * unit->powers.rad;
  }
}

std::string must_be(Dimension d) {
  if (d == Dimension::none) return "must be a plain number without a unit";
  return fmt::format("must be {}; write it like \"{} {}\"{}{}", line(d).name, 1, line(d).usual,
                     line(d).units.empty() ? "" : "; units: ", line(d).units);
}

constexpr std::size_t kLongest = 64;  // [byte] a remedy is looked for in what a person may have typed

enum class Remedies { sought, none };  // none: a remedy is being tried, and needs none of its own

Quantity quantity_of(std::string_view text, Dimension wanted, Remedies);
Quantities quantities_of(std::string_view text, Dimension wanted, Remedies);

/// Whether a text reads as one quantity, or a list of them.
bool reads(const std::string& text, Dimension wanted) {
  return text.size() <= kLongest &&
         (quantity_of(text, wanted, Remedies::none).problem.empty() || quantities_of(text, wanted, Remedies::none).problem.empty());
}

enum class Commas { decimal, either };  // what a comma may have been meant as

/// "40,5 km/h" and "1, 2 m": what to write instead, where that reads.
std::optional<std::string> comma_remedy(std::string_view text, Dimension wanted, Commas meant, Remedies remedies) {
  if (remedies == Remedies::none || text.size() > kLongest || text.find(',') == std::string_view::npos) return std::nullopt;
  const bool spaced = text.find(", ") != std::string_view::npos || text.find(' ') > text.rfind(',');
  std::string point(text), blank(text);
  std::replace(point.begin(), point.end(), ',', '.');
  std::replace(blank.begin(), blank.end(), ',', ' ');
  blank.erase(std::unique(blank.begin(), blank.end(), [](char a, char b) { return a == ' ' && b == ' '; }), blank.end());
  if (meant == Commas::either && spaced && reads(blank, wanted))
    return fmt::format("has commas between its numbers; write \"{}\"", blank);
  if (reads(point, wanted)) return fmt::format("has a decimal comma; write \"{}\"", point);
  return std::nullopt;
}

struct Alias {
  std::string_view word, unit;
};
constexpr Alias kAliases[] = {
    {"kmh", "km/h"},    {"kmph", "km/h"},     {"km/hr", "km/h"},    {"sec", "s"},          {"secs", "s"},
    {"second", "s"},    {"seconds", "s"},     {"msec", "ms"},       {"minutes", "min"},    {"hours", "h"},
    {"hr", "h"},        {"meter", "m"},       {"meters", "m"},      {"metre", "m"},        {"metres", "m"},
    {"degree", "deg"},  {"degrees", "deg"},   {"kgs", "kg"},        {"kilogram", "kg"},    {"kilograms", "kg"},
    {"kilo", "kg"},     {"lbs", "lb"},        {"pounds", "lb"},     {"feet", "ft"},        {"foot", "ft"},
    {"inch", "in"},     {"inches", "in"},     {"mile", "mi"},       {"miles", "mi"},       {"ton", "t"},
    {"tons", "t"},      {"tonne", "t"},       {"tonnes", "t"},      {"newton", "N"},       {"radian", "rad"},
    {"radians", "rad"}, {"kilometers", "km"}, {"kilometres", "km"}, {"centimeters", "cm"}, {"centimetres", "cm"},
};

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string unknown_unit(std::string_view text, const std::string& unknown, Dimension wanted, Remedies remedies) {
  if (remedies == Remedies::none) return must_be(wanted);
  const auto with = [&](std::string_view unit) {
    std::string out(text);
    return out.replace(text.rfind(unknown), unknown.size(), unit);
  };
  if (wanted == Dimension::speed && (same_letters(unknown, "kn") || same_letters(unknown, "knots")))
    return fmt::format("\"{}\" is not a unit; a knot is 1.852 km/h", unknown);
  if (text.size() <= kLongest && text.rfind(unknown) != std::string_view::npos) {
    for (const Alias& alias : kAliases)
      if (same_letters(alias.word, unknown) && reads(with(alias.unit), wanted))
        return fmt::format("\"{}\" is not a unit; did you mean \"{}\"?", unknown, with(alias.unit));
    for (const Unit& unit : all_units())
      if (same_letters(unit.symbol, unknown) && reads(with(unit.symbol), wanted))
        return fmt::format("\"{}\" is not a unit; did you mean \"{}\"?", unknown, with(unit.symbol));
  }
  return fmt::format("\"{}\" is not a unit; {}", unknown, must_be(wanted));
}

/// "5 ft 9", "1m78": a number has no unit, and what is before it has one.
std::string last_unit_missing(std::string_view before, std::string_view unit, double number, Dimension wanted) {
  constexpr Alias kFollowers[] = {{"ft", "in"}, {"h", "min"}, {"min", "s"}, {"m", "cm"}, {"kg", "g"}};
  for (const Alias& alias : kFollowers) {
    const std::string meant = fmt::format("{} {} {}", before, number, alias.unit);
    if (alias.word == unit && reads(meant, wanted)) return fmt::format("{} has no unit; write \"{}\"", number, meant);
  }
  return fmt::format("{} has no unit", number);
}

std::vector<std::string_view> split_units(std::string_view units) {
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at < units.size(); at = std::min(units.find(", ", at), units.size() - 2) + 2)
    out.push_back(units.substr(at, std::min(units.find(", ", at), units.size()) - at));
  return out;
}

Quantity quantity_of(std::string_view text, Dimension wanted, Remedies remedies) {
  Quantity out;
  std::string_view t = text;
  skip_spaces(t);
  int terms = 0;
  bool negative = false;
  std::string_view before, last_unit;  // the terms read so far, and the last one's unit
  while (!t.empty()) {
    const auto number = take_number(t);
    if (!number) return {0, comma_remedy(text, wanted, Commas::decimal, remedies).value_or(must_be(wanted)), {}};
    skip_spaces(t);
    const std::string_view at_unit = t;
    const UnitValue unit = take_unit(t, wanted);
    if (!unit.unknown.empty()) return {0, unknown_unit(text, unit.unknown, wanted, remedies), {}};
    if (unit.powers == Powers{} && unit.factor == 1 && wanted != Dimension::none) {
      if (terms > 0) return {0, last_unit_missing(before, last_unit, *number, wanted), {}};
      return {0, fmt::format("needs a unit: write {}", unit_examples(*number, wanted)), number};
    }
    const auto ended = [](std::string_view read) { return read.substr(0, read.find_last_not_of(' ') + 1); };
    last_unit = ended(at_unit.substr(0, at_unit.size() - t.size()));
    before = ended(text.substr(0, text.size() - t.size()));
    // as plans and surveys tell grades: the rise over the way
    if (wanted == Dimension::angle && last_unit == "%" && terms == 0)
      return {0,
              fmt::format("is a grade, and must be an angle; write \"{:.4g} deg\"", engine::math::atan2(*number, 100) * 180 / M_PI),
              {}};
    if (!(unit.powers == line(wanted).powers)) return {0, must_be(wanted), {}};
    // "-5 ft 9 in" means -(5 ft 9 in)
    if (terms++ == 0) negative = std::signbit(*number);
    out.value += (negative && terms > 1 ? -1 : 1) * *number * unit.factor;
    skip_spaces(t);
  }
  if (terms == 0) return {0, must_be(wanted), {}};
  return out;
}

Quantities quantities_of(std::string_view text, Dimension wanted, Remedies remedies) {
  Quantities out;
  std::string_view t = text;
  for (skip_spaces(t); is_number_start(t); skip_spaces(t)) {
    const auto number = take_number(t);
    if (!number) return {{}, comma_remedy(text, wanted, Commas::either, remedies).value_or(must_be(wanted))};
    out.values.push_back(*number);
  }
  const UnitValue unit = take_unit(t, wanted);
  if (!unit.unknown.empty()) return {{}, unknown_unit(text, unit.unknown, wanted, remedies)};
  if (!(unit.powers == line(wanted).powers) || !t.empty()) {
    return {{},
            wanted == Dimension::none ? "must be plain numbers"
                                      : fmt::format("must end in a unit of {}, like \"1 2 3 {}\"",
                                                    line(wanted).name.substr(line(wanted).name.find(' ') + 1), line(wanted).usual)};
  }
  for (double& value : out.values) value *= unit.factor;
  return out;
}

}  // namespace

Quantity parse_quantity(std::string_view text, Dimension wanted) {
  return quantity_of(text, wanted, Remedies::sought);
}

Quantities parse_quantities(std::string_view text, Dimension wanted) {
  return quantities_of(text, wanted, Remedies::sought);
}

std::string unit_examples(double number, Dimension d, double lower, double upper) {
  const auto factor = [&](std::string_view unit) { return take_unit(unit, d).factor; };
  const auto fits = [&](std::string_view unit) { return number * factor(unit) >= lower && number * factor(unit) <= upper; };
  if (!fits(line(d).usual)) {
    std::vector<std::string> others;
    for (const std::string_view unit : split_units(line(d).units))
      if (fits(unit)) others.push_back(fmt::format("\"{} {}\"", number, unit));
    if (!others.empty()) return fmt::format("{}", fmt::join(others, " or "));
  }
  // a deceleration of 0.7 is one of 0.7 g: braking in m/s^2 is above this
  if (d == Dimension::acceleration && std::abs(number) < 1.5)
    return fmt::format("\"{} g\" or \"{:.3g} m/s^2\"", number, number * factor("g"));
  const double second = number * factor(line(d).usual) / factor(line(d).second);
  const std::string rounded =
      std::abs(second) >= 100 && std::abs(second) < 1e6 ? fmt::format("{:.0f}", second) : fmt::format("{:.3g}", second);
  return fmt::format("\"{} {}\" or \"{} {}\"", number, line(d).usual, rounded, line(d).second);
}

}  // namespace scenes
