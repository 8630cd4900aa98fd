// A recursive descent over sum, product, power and primary. A number and the units that follow it without a sign bind first:
// "9.81 m/s^2" is (9.81 m) / s^2, the same as read by people.
#include "scenes/loader/expression.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "engine/math/functions.h"
#include "engine/model/model.h"

namespace scenes {
namespace {

namespace math = engine::math;

constexpr int kDeepest = 64;  // parentheses within each other

Powers times(const Powers& a, const Powers& b, int sign) {
  return {a.m + sign * b.m, a.kg + sign * b.kg, a.s + sign * b.s, a.rad + sign * b.rad};
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || static_cast<unsigned char>(c) >= 0x80 || c == '%';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_function(std::string_view word) {
  for (const char* name : {"sqrt", "abs", "min", "max", "sin", "cos", "tan"})
    if (word == name) return true;
  return false;
}

std::string_view take_word(std::string_view& t) {
  std::size_t length = 0;
  while (length < t.size() && (is_letter(t[length]) || (length > 0 && is_digit(t[length])))) ++length;
  const std::string_view word = t.substr(0, length);
  t.remove_prefix(length);
  return word;
}

struct Parser {
  std::string_view t;
  Variables& variables;
  std::string& problem;
  int depth = 0;

  void fail(const std::string& what) {
    if (problem.empty()) problem = what;
    t = {};
  }
  char next() {
    while (!t.empty() && (t.front() == ' ' || t.front() == '\t')) t.remove_prefix(1);
    return t.empty() ? '\0' : t.front();
  }
  bool take(char c) {
    if (next() != c) return false;
    t.remove_prefix(1);
    return true;
  }

  Measured sum() {
    if (++depth > kDeepest) fail("has too many parentheses within each other");
    Measured out = product();
    while (problem.empty() && (next() == '+' || next() == '-')) {
      const double sign = take('+') ? 1 : (take('-'), -1);
      const Measured right = product();
      if (problem.empty() && !(out.powers == right.powers))
        fail(fmt::format("adds {} and {}", in_words(out.powers), in_words(right.powers)));
      out.value += sign * right.value;
    }
    --depth;
    return out;
  }

  Measured product() {
    Measured out = power();
    while (problem.empty() && (next() == '*' || next() == '/')) {
      const int sign = take('*') ? 1 : (take('/'), -1);
      const Measured right = power();
      out.value = sign > 0 ? out.value * right.value : out.value / right.value;
      out.powers = times(out.powers, right.powers, sign);
    }
    return out;
  }

  Measured power() {
    if (take('-')) {
      Measured out = power();
      out.value = -out.value;
      return out;
    }
    if (take('+')) return power();
    return raised(primary());
  }

  Measured raised(Measured base) {
    if (!take('^')) return base;
    const int sign = take('-') ? -1 : 1;
    if (!is_digit(next())) {
      fail("needs a whole number after ^");
      return base;
    }
    const int exponent = sign * (t.front() - '0');
    t.remove_prefix(1);
    double power = 1;
    for (int i = 0; i < std::abs(exponent); ++i) power *= base.value;
    base.value = exponent < 0 ? 1 / power : power;
    base.powers = {exponent * base.powers.m, exponent * base.powers.kg, exponent * base.powers.s, exponent * base.powers.rad};
    return base;
  }

  Measured primary() {
    const char c = next();
    if (take('(')) {
      const Measured out = sum();
      if (!take(')') && problem.empty()) fail("has an open parenthesis");
      return out;
    }
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return word(take_word(t));
    fail(c == '\0' ? "ends where a value should stand" : fmt::format("has \"{}\" where a value should stand", t.substr(0, 1)));
    return {};
  }

  Measured number() {
    Measured out;
    const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), out.value);
    if (error != std::errc{} || !std::isfinite(out.value)) {
      fail("has a number that cannot be read");
      return out;
    }
    t.remove_prefix(static_cast<std::size_t>(end - t.data()));
    // the units that belong to it
    while (problem.empty() && is_letter(next())) {
      const std::string_view symbol = take_word(t);
      if (variables.has(symbol)) {
        fail(fmt::format("has {} directly after a number; put a * between them", symbol));
        break;
      }
      const Measured unit = raised(word(symbol));
      out.value *= unit.value;
      out.powers = times(out.powers, unit.powers, 1);
    }
    return out;
  }

  Measured word(std::string_view name) {
    if (variables.has(name)) return variables.value_of(std::string(name), problem);
    if (is_function(name)) return function(name);
    if (name == "g") return {engine::kGravity, powers_of(Dimension::acceleration)};
    if (const auto unit = unit_named(name)) return {unit->factor, unit->powers};
    const std::string near = nearest(name, variables.names());
    fail(fmt::format("has \"{}\", which is neither a unit nor one of [variables]{}", name,
                     near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
    return {};
  }

  Measured function(std::string_view name) {
    if (!take('(')) {
      fail(fmt::format("needs a parenthesis after {}", name));
      return {};
    }
    Measured a = sum();
    if (name == "min" || name == "max") {
      if (!take(',')) fail(fmt::format("needs two values in {}, with a comma between them", name));
      const Measured b = sum();
      if (problem.empty() && !(a.powers == b.powers))
        fail(fmt::format("has {} and {} in {}", in_words(a.powers), in_words(b.powers), name));
      a.value = name == "min" ? std::min(a.value, b.value) : std::max(a.value, b.value);
    }
    if (!take(')') && problem.empty()) fail("has an open parenthesis");
    return problem.empty() ? applied(name, a) : a;
  }

  Measured applied(std::string_view name, Measured a) {
    const Powers& p = a.powers;
    if (name == "abs") a.value = std::abs(a.value);
    if (name == "sqrt") {
      if (p.m % 2 != 0 || p.kg % 2 != 0 || p.s % 2 != 0 || p.rad % 2 != 0) fail(fmt::format("takes the root of {}", in_words(p)));
      if (a.value < 0) fail("takes the root of a negative number");
      return {std::sqrt(a.value), {p.m / 2, p.kg / 2, p.s / 2, p.rad / 2}};
    }
    if (name != "sin" && name != "cos" && name != "tan") return a;
    if (!(p == powers_of(Dimension::angle)) && !(p == Powers{})) fail(fmt::format("takes the {} of {}", name, in_words(p)));
    return {name == "sin" ? math::sin(a.value) : name == "cos" ? math::cos(a.value) : math::tan(a.value), {}};
  }
};

}  // namespace

std::string in_words(const Powers& p) {
  for (int d = 0; d <= static_cast<int>(Dimension::density); ++d)
    if (powers_of(static_cast<Dimension>(d)) == p) return std::string(name_of(static_cast<Dimension>(d)));
  std::string out;
  const auto add = [&out](const char* unit, int power) {
    if (power != 0) out += fmt::format("{}{}{}", out.empty() ? "" : " ", unit, power == 1 ? "" : fmt::format("^{}", power));
  };
  add("m", p.m);
  add("kg", p.kg);
  add("s", p.s);
  add("rad", p.rad);
  return out;
}

Variables::Variables(const Value& table) : table_(&table) {}

bool Variables::has(std::string_view name) const {
  return table_->find(name) != nullptr && name != "g" && !unit_named(name);
}

std::vector<std::string> Variables::names() const {
  std::vector<std::string> out;
  for (const Entry& entry : table_->entries) out.push_back(entry.key);
  return out;
}

Measured Variables::evaluate(std::string_view expression, std::string& problem) {
  Parser parser{expression, *this, problem};
  const Measured out = parser.sum();
  if (problem.empty() && parser.next() != '\0') problem = fmt::format("has \"{}\" where an operator should stand", parser.t);
  if (problem.empty() && !std::isfinite(out.value)) problem = "has no finite value";
  return out;
}

Measured Variables::value_of(const std::string& name, std::string& problem) {
  used_.insert(name);
  if (const auto found = known_.find(name); found != known_.end()) return found->second;
  const Value* value = table_->find(name);
  if (value->is_number() && std::isfinite(value->number)) return known_[name] = {value->number, {}};
  if (value->kind != Value::Kind::text) {
    problem = fmt::format("uses {}, which is no quantity", name);
    return {};
  }
  if (!open_.insert(name).second) {
    problem = fmt::format("goes in a circle: {} depends on itself", name);
    return {};
  }
  const Measured out = evaluate(value->text, problem);
  open_.erase(name);
  if (problem.empty()) known_[name] = out;
  return out;
}

bool is_expression(std::string_view text, const Variables& variables) {
  if (text.find_first_of("(") != std::string_view::npos) return true;
  if (variables.empty()) return false;
  for (const char* sign : {" + ", " - ", " * ", " / "})
    if (text.find(sign) != std::string_view::npos) return true;
  for (std::string_view t = text; !t.empty();) {
    if (!is_letter(t.front())) {
      t.remove_prefix(1);
      continue;
    }
    if (variables.has(take_word(t))) return true;
  }
  return false;
}

}  // namespace scenes
