#include "scenes/loader/uncertain.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/math/functions.h"
#include "scenes/loader/expression.h"
#include "scenes/loader/key_path.h"

namespace scenes {
namespace {

constexpr const char* kTwoValues = "must be two values, the lower one first, as in \"20 60 km/h\"";

const Key kCorrelationKeys[] = {
    {"*", Type::number, Dimension::none, "", "The other key in quotes, and the correlation of the two (of their normal scores).",
     between(-1, 1)},
};
const Section kCorrelationSection{"uncertain.correlation", "[uncertain.correlation]",
                                  "What is not known together: taller people are heavier.", kCorrelationKeys};

const Key kUncertainKeys[] = {
    bound<&Uncertain::key>({"key", Type::text, Dimension::none, kRequired,
                            "What is uncertain: a path as in --set, `\"vehicle.sedan.speed\"`, or a variable, "
                            "`\"variables.speed\"`."}),
    {"uniform", Type::any, Dimension::none, "", "All values between two are as likely: `\"38 52 km/h\"`."},
    {"normal", Type::any, Dimension::none, "", "Mean and standard deviation: `\"0.7 0.05\"`, `[\"78 kg\", \"8 kg\"]`."},
    {"triangular", Type::any, Dimension::none, "", "Least, likeliest and greatest: `\"0.6 0.7 0.85\"`."},
    {"log_normal", Type::any, Dimension::none, "",
     "Median, and a factor above 1 that two in three lie within: `[\"1 s\", 1.3]` is 0.77 to 1.3 s."},
    {"choice", Type::any, Dimension::none, "", "One of a list: `[\"walking_left\", \"walking_right\"]`."},
    {"table", Type::any, Dimension::none, "",
     "Values in rising order, each with its relative density, straight lines between: `[[\"30 km/h\", 0], [\"40 km/h\", 2], "
     "...]`."},
    bound<&Uncertain::weights>({"weights", Type::numbers, Dimension::none, "",
                                "How likely each choice is, relative to the others; left out: all alike.", kNotNegative}),
    {"within", Type::any, Dimension::none, "", "Nothing outside of these two is possible (normal, log_normal): `\"0 1.2\"`."},
    {"correlation", Type::table, Dimension::none, "", "With other uncertain keys.", kAny, {}, &kCorrelationSection},
};

constexpr const char* kSpreads[] = {"uniform", "normal", "triangular", "log_normal", "choice", "table"};
constexpr double kTail = 4;  // [standard deviations] so far out a normal is expected to be possible: one in 30,000

/// What stands behind the numbers of a text: " km/h" of "38 52 km/h".
WrittenUnit unit_of(const Value& value, Dimension dimension) {
  if (value.kind == Value::Kind::array) return value.items.empty() ? WrittenUnit{} : unit_of(value.items.front(), dimension);
  if (value.kind != Value::Kind::text || dimension == Dimension::none) return {std::string(si_unit(dimension)), 1};
  std::size_t at = 0;  // numbers are separated by spaces; the unit begins with what is no number
  const std::string& t = value.text;
  while (at < t.size() && (t[at] == ' ' || t[at] == '+' || t[at] == '-' || t[at] == '.' || (t[at] >= '0' && t[at] <= '9') ||
                           (t[at] == 'e' && at + 1 < t.size() && (t[at + 1] == '-' || (t[at + 1] >= '0' && t[at + 1] <= '9')))))
    ++at;
  const Quantity one = parse_quantity("1 " + t.substr(at), dimension);
  if (!one.problem.empty() || !(one.value > 0)) return {std::string(si_unit(dimension)), 1};
  return {t.substr(at), one.value};
}

/// SI numbers to a text that an override takes.
std::string as_override(const Value& value) {
  return value.kind == Value::Kind::text ? value.text : written(value);
}

struct UncertainReader {
  Reader& r;
  const KeyOfPath& found;
  Uncertain& out;
  Dimension dimension = Dimension::none;

  bool read_numbers(const char* key, std::size_t count, const char* what) {
    const Value* value = r.value().find(key);
    const ReadValues read = read_values(*value, dimension);
    if (!read.problem.empty()) return r.fail(key, read.problem), false;
    if (read.numbers.size() != count) return r.fail(key, what), false;
    out.numbers = read.numbers;
    out.unit = read.unit;
    return true;
  }

  void read_uniform() {
    if (read_numbers("uniform", 2, kTwoValues) && !(out.numbers[0] < out.numbers[1])) r.fail("uniform", kTwoValues);
  }
  void read_normal() {
    if (read_numbers("normal", 2, "must be a mean and a standard deviation") && !(out.numbers[1] > 0))
      r.fail("normal", "must have a standard deviation above zero");
  }
  void read_triangular() {
    if (!read_numbers("triangular", 3, "must be three values: least, likeliest and greatest")) return;
    const auto& n = out.numbers;
    if (!(n[0] <= n[1] && n[1] <= n[2] && n[0] < n[2])) r.fail("triangular", "must be three values in rising order");
  }
  void read_log_normal() {
    const Value* value = r.value().find("log_normal");
    constexpr const char* kShape = "must be a median above zero and a factor above 1, like [\"1 s\", 1.3]";
    if (value->kind != Value::Kind::array || value->items.size() != 2) return r.fail("log_normal", kShape);
    const ReadValues median = read_values(value->items[0], dimension), factor = read_values(value->items[1], Dimension::none);
    if (!median.problem.empty()) return r.fail("log_normal", median.problem);
    if (median.numbers.size() != 1 || factor.numbers.size() != 1 || !(median.numbers[0] > 0) || !(factor.numbers[0] > 1))
      return r.fail("log_normal", kShape);
    out.numbers = {median.numbers[0], factor.numbers[0]};
    out.unit = median.unit;
  }
  void read_choice() {
    const Value* value = r.value().find("choice");
    if (value->kind != Value::Kind::array || value->items.empty())
      return r.fail("choice", "must be a list with at least one value");
    for (const Value& item : value->items) out.choices.push_back(as_override(item));
    if (!r.has("weights")) out.weights.assign(out.choices.size(), 1.0);
    const double sum = std::accumulate(out.weights.begin(), out.weights.end(), 0.0);
    if (out.weights.size() != out.choices.size() || !(sum > 0))
      return r.fail("weights", fmt::format("must be {} numbers, one for each choice, not all zero", out.choices.size()));
    for (double& weight : out.weights) weight /= sum;
  }
  void read_table() {
    const Value* value = r.value().find("table");
    constexpr const char* kShape = "must be two or more pairs of a value and its density, the values rising";
    if (value->kind != Value::Kind::array || value->items.size() < 2) return r.fail("table", kShape);
    for (const Value& item : value->items) {
      if (item.kind != Value::Kind::array || item.items.size() != 2) return r.fail("table", kShape);
      const ReadValues x = read_values(item.items[0], dimension), density = read_values(item.items[1], Dimension::none);
      if (!x.problem.empty()) return r.fail("table", x.problem);
      if (x.numbers.size() != 1 || density.numbers.size() != 1 || density.numbers[0] < 0) return r.fail("table", kShape);
      if (!out.numbers.empty() && !(x.numbers[0] > out.numbers.back())) return r.fail("table", kShape);
      if (out.numbers.empty()) out.unit = x.unit;
      out.numbers.push_back(x.numbers[0]);
      out.weights.push_back(density.numbers[0]);
    }
    if (std::all_of(out.weights.begin(), out.weights.end(), [](double w) { return w == 0; }))
      r.fail("table", "must have a density above zero somewhere");
  }

  void read_within() {
    if (!r.has("within")) return;
    if (out.spread != Spread::normal && out.spread != Spread::log_normal)
      return r.fail("within", "is for normal and log_normal; the others have ends of their own");
    const ReadValues read = read_values(*r.value().find("within"), dimension);
    if (!read.problem.empty()) return r.fail("within", read.problem);
    if (read.numbers.size() != 2 || !(read.numbers[0] < read.numbers[1])) return r.fail("within", kTwoValues);
    out.lower = read.numbers[0];
    out.upper = read.numbers[1];
  }

  /// What the spread takes for possible must be possible for the key.
  void check_range(const char* spread) {
    if (out.numbers.empty() || out.spread == Spread::choice) return;
    double low = out.numbers.front(), high = out.numbers.back();
    if (out.spread == Spread::normal) low = out.numbers[0] - kTail * out.numbers[1], high = out.numbers[0] + kTail * out.numbers[1];
    if (out.spread == Spread::log_normal)
      low = out.numbers[0] / engine::math::pow(out.numbers[1], kTail),
      high = out.numbers[0] * engine::math::pow(out.numbers[1], kTail);
    low = std::max(low, out.lower);
    high = std::min(high, out.upper);
    const Range& range = found.key->range;
    const bool too_low = range.lower_open ? !(low > range.lower) : low < range.lower;
    if (!too_low && high <= range.upper) return;
    r.fail(spread, fmt::format("reaches {:.4g} {}, but {} must be {}{}", (too_low ? low : high) / out.unit.factor, out.unit.name,
                               out.key, describe_range(*found.key), out.bounded() ? "" : "; say what is possible with `within`"));
  }

  void read() {
    const char* given = nullptr;
    for (std::size_t i = 0; i < std::size(kSpreads); ++i) {
      if (!r.has(kSpreads[i])) continue;
      if (given) return r.fail(kSpreads[i], fmt::format("stands beside {}; give one of them", given));
      given = kSpreads[i];
      out.spread = static_cast<Spread>(i);
    }
    if (!given) return r.fail_here(fmt::format("says nothing of {}; give one of {}", out.key, fmt::join(kSpreads, ", ")));
    if (r.has("weights") && out.spread != Spread::choice) r.fail("weights", "is for choice");
    void (UncertainReader::*const kRead[])() = {&UncertainReader::read_uniform,    &UncertainReader::read_normal,
                                                &UncertainReader::read_triangular, &UncertainReader::read_log_normal,
                                                &UncertainReader::read_choice,     &UncertainReader::read_table};
    const std::size_t before = r.errors().count();
    (this->*kRead[static_cast<std::size_t>(out.spread)])();
    if (r.errors().count() == before) read_within();
    if (r.errors().count() == before) check_range(given);
  }
};

/// The dimension of a variable is that of what it has now.
std::optional<Dimension> dimension_of_key(const KeyOfPath& found, const Value& root) {
  if (found.key->type != Type::any) return found.key->dimension;
  const Value* table = root.find("variables");
  Variables variables(*table);
  std::string problem;
  const Measured now = found.value->kind == Value::Kind::text ? variables.evaluate(found.value->text, problem) : Measured{};
  for (int d = 0; d <= static_cast<int>(Dimension::density); ++d)
    if (problem.empty() && powers_of(static_cast<Dimension>(d)) == now.powers) return static_cast<Dimension>(d);
  return std::nullopt;
}

bool takes_a_number(const Key& key) {
  return key.type == Type::number || key.type == Type::integer || key.type == Type::schedule || key.type == Type::any;
}

void read_one(Builder& builder, const Value& root, Reader& r) {
  Uncertain out;
  r.fill(out);
  out.place = r.place().text();
  if (out.key.empty()) return;
  const KeyOfPath found = key_of_path(root, out.key);
  if (!found.key) return r.fail("key", found.problem);
  const std::optional<Dimension> dimension = dimension_of_key(found, root);
  if (!dimension) return r.fail("key", "is of a dimension no key of a scene has");
  if (!takes_a_number(*found.key) && !r.has("choice"))
    return r.fail("key", fmt::format("is {}; only a choice can be made of it", describe_type(*found.key)));
  out.si_unit = si_unit(*dimension);
  for (const Uncertain& other : builder.scene.inference.uncertain)
    if (other.key == out.key) return r.fail("key", fmt::format("is uncertain already, at {}", other.place));
  UncertainReader{r, found, out, *dimension}.read();
  if (const auto correlation = r.table("correlation"))
    for (const Entry& entry : correlation->value().entries)
      out.correlation.emplace_back(entry.key, Reader(*correlation).number(entry.key));
  builder.scene.inference.uncertain.push_back(std::move(out));
}

/// The correlations of all must be possible together.
void check_correlations(Builder& builder, std::vector<Reader>& readers) {
  const auto& all = builder.scene.inference.uncertain;
  const auto n = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  std::vector<std::string> keys;
  for (const Uncertain& u : all) keys.push_back(u.key);
  Reader* last = nullptr;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (const auto& [other, value] : all[static_cast<std::size_t>(i)].correlation) {
      const auto at = std::find(keys.begin(), keys.end(), other);
      Reader* reader = &readers[static_cast<std::size_t>(i)];
      if (at == keys.end()) {
        const std::string near = nearest(other, keys);
        return reader->fail("correlation", fmt::format("names \"{}\", which is not among the uncertain keys{}", other,
                                                       near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
      }
      const auto k = at - keys.begin();
      if (k == i) return reader->fail("correlation", "is with itself");
      if (all[static_cast<std::size_t>(k)].spread == Spread::choice || all[static_cast<std::size_t>(i)].spread == Spread::choice)
        return reader->fail("correlation", "is with a choice; only numbers can be correlated");
      if (matrix(i, k) != 0 && matrix(i, k) != value)
        return reader->fail("correlation", fmt::format("with \"{}\" is {}, but {} there", other, value, matrix(i, k)));
      matrix(i, k) = matrix(k, i) = value;
      last = reader;
    }
  }
  if (last && Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0] < 1e-9)
    last->fail("correlation", "contradicts the others: no quantities can be correlated so among each other; make one smaller");
}

}  // namespace

const Section kUncertainSection{"uncertain", "[[uncertain]]",
                                "A value of the scene that is known only so far: a key, and one of uniform, normal, triangular, "
                                "log_normal, choice, table. `crashreel sample` and `fit` draw it; every other command takes what "
                                "the scene says.",
                                kUncertainKeys};

KeyUnit unit_of_key(const Value& root, const std::string& path) {
  const KeyOfPath found = key_of_path(root, path);
  if (!found.key) return {"", found.problem};
  const std::optional<Dimension> dimension = dimension_of_key(found, root);
  if (!dimension) return {"", "is of a dimension no key of a scene has"};
  return {std::string(si_unit(*dimension)), ""};
}

std::optional<double> number_at(const Value& root, const std::string& path) {
  const KeyOfPath found = key_of_path(root, path);
  if (!found.key || !found.value || !takes_a_number(*found.key)) return std::nullopt;
  const std::optional<Dimension> dimension = dimension_of_key(found, root);
  if (!dimension) return std::nullopt;
  const Value* table = root.find("variables");
  Variables variables(table ? *table : empty_table());
  const Value& value = *found.value;
  if (value.kind == Value::Kind::text && (found.key->type == Type::any || is_expression(value.text, variables))) {
    std::string problem;
    const Measured reckoned = variables.evaluate(value.text, problem);
    return problem.empty() ? std::optional(reckoned.value) : std::nullopt;
  }
  const ReadValues read = read_values(value, *dimension);
  return read.problem.empty() && read.numbers.size() == 1 ? std::optional(read.numbers.front()) : std::nullopt;
}

ReadValues read_values(const Value& value, Dimension dimension) {
  ReadValues out;
  out.unit = unit_of(value, dimension);
  if (value.is_number()) {
    if (!std::isfinite(value.number)) out.problem = "must be finite";
    if (dimension != Dimension::none && value.number != 0)
      out.problem = fmt::format("needs a unit: write {}", unit_examples(value.number, dimension));
    out.numbers = {value.number};
  } else if (value.kind == Value::Kind::text) {
    const Quantity single = parse_quantity(value.text, dimension);
    if (single.problem.empty() && value.text.find_first_not_of("0123456789.+-eE ") != std::string::npos) {
      const Quantities several = parse_quantities(value.text, dimension);
      out.numbers = several.problem.empty() ? several.values : std::vector<double>{single.value};  // "5 ft 9 in" is one
    } else {
      const Quantities several = parse_quantities(value.text, dimension);
      out.numbers = several.values;
      out.problem = several.problem;
    }
  } else if (value.kind == Value::Kind::array) {
    for (const Value& item : value.items) {
      const ReadValues part = read_values(item, dimension);
      if (!part.problem.empty()) return part;
      out.numbers.insert(out.numbers.end(), part.numbers.begin(), part.numbers.end());
    }
  } else {
    out.problem = "must be a value or a list";
  }
  return out;
}

void read_uncertain(Builder& builder, const Value& root, std::vector<Reader> readers) {
  const std::size_t before = builder.errors.count();
  for (Reader& r : readers) read_one(builder, root, r);
  if (builder.errors.count() == before) check_correlations(builder, readers);
}

}  // namespace scenes
