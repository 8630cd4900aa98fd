// [[evidence]]: what was seen, and how exactly.
#include <fmt/format.h>

#include <algorithm>

#include "engine/measure/definitions.h"
#include "scenes/loader/metric_unit.h"
#include "scenes/loader/uncertain.h"

namespace scenes {
namespace {

const Key kEvidenceKeys[] = {
    bound<&Evidence::name>({"name", Type::text, Dimension::none, kRequired, "What it is called in tables and pages."}),
    bound<&Evidence::metric>(
        {"metric", Type::text, Dimension::none, "",
         "What it is compared with: a measure of summary.json with or without its unit (`throw_distance`, `wrap_around_distance`, "
         "`delta_v`, `ees`, `head_impact_speed`), or `rest_place`, `landing_place` (world x, y), `contact_place` (of the part `of` "
         "on the vehicle `with`, in the vehicle's axes from its centre of mass), `speed` (at the time `at`, as an event data "
         "recorder has it), `contact` or `no_contact` (of `of` and `with`)."}),
    {"mark", Type::any, Dimension::none, "",
     "In place of a metric: a skid or scuff mark on the ground as a list of world points, `[\"3.1 -1.2 m\", \"9.8 -1.4 m\"]`. Of a "
     "vehicle it is held against the way its wheels slip, of all or of one side, whichever is nearer; of a person or body against "
     "the way it slides."},
    bound<&Evidence::of>(
        {"of", Type::text, Dimension::none, "''",
         "The person, vehicle or body meant, or a part of a person (`pedestrian/head`). Left out where there is only one."}),
    bound<&Evidence::with>({"with", Type::text, Dimension::none, "''", "The other one, of contact_place, contact and no_contact."}),
    bound<&Evidence::at>({"at", Type::number, Dimension::time, "'0 s'", "The time of `speed`.", kNotNegative}),
    {"value", Type::any, Dimension::none, "", "What was seen: `\"14.2 m\"`, a place as `\"12.1 -3.0 m\"`."},
    {"tolerance", Type::any, Dimension::none, "",
     "How exactly: one standard deviation of everything that may be off (two in three times the truth lies within). Of a mark, "
     "of its distance."},
};

constexpr const char* kSpecial[] = {"metric", "rest_place", "landing_place", "contact_place",
                                    "speed",  "mark",       "contact",       "no_contact"};

void check_name(const Builder& builder, Reader& r, const char* key, const std::string& name) {
  if (name.empty() || builder.is_declared(name)) return;
  const std::string near = nearest(name.substr(0, name.find('/')), builder.declared);
  r.fail(key, fmt::format("is nobody and nothing of the scene{}", near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

/// Of a measure by its key, as summary.json has it.
const MetricUnit& measure_unit(std::string_view key) {
  return *std::find_if(std::begin(kMetricUnits), std::end(kMetricUnits),
                       [key](const MetricUnit& unit) { return key.ends_with(unit.suffix); });
}

void refuse_unknown_measure(Reader& r, const std::string& metric) {
  std::vector<std::string> known(std::begin(kSpecial) + 1, std::end(kSpecial));
  for (const engine::Definition& d : engine::definitions()) {
    known.emplace_back(d.key);
    known.back().resize(known.back().size() - measure_unit(d.key).suffix.size());
  }
  const std::string near = nearest(metric, known);
  r.fail("metric", fmt::format("is no measure{}; `crashreel explain all` lists them",
                               near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

/// value and tolerance in the unit of the measure; without one the name may mean two: a landing has a place and a time.
void read_measure(Reader& r, Evidence& out) {
  const Value *value = r.value().find("value"), *tolerance = r.value().find("tolerance");
  const char* wrong = nullptr;
  std::string problem;
  for (const engine::Definition& d : engine::definitions()) {
    const MetricUnit& unit = measure_unit(d.key);
    if (out.metric != d.key && out.metric + std::string(unit.suffix) != d.key) continue;
    const ReadValues v = read_values(*value, unit.dimension), t = read_values(*tolerance, unit.dimension);
    if (v.problem.empty() && t.problem.empty() && v.numbers.size() == 1 && t.numbers.size() == 1) {
      out.metric = d.key;
      out.value = {v.numbers[0] * unit.per_si};
      out.tolerance = t.numbers[0] * unit.per_si;
      out.unit = {v.unit.name, v.unit.factor * unit.per_si};
      return;
    }
    if (wrong) continue;
    const bool by_value = !v.problem.empty() || v.numbers.size() != 1;
    wrong = by_value ? "value" : "tolerance";
    problem = by_value ? v.problem : t.problem;
    // told as of any single value: a comma in it is that of a decimal
    const Value& bad = by_value ? *value : *tolerance;
    if (!problem.empty() && bad.kind == Value::Kind::text)
      if (const Quantity single = parse_quantity(bad.text, unit.dimension); !single.problem.empty()) problem = single.problem;
  }
  if (!wrong) return refuse_unknown_measure(r, out.metric);
  r.fail(wrong, problem.empty() ? "must be one value" : problem);
}

void read_quantities(Reader& r, Evidence& out, Dimension dimension, std::size_t least, std::size_t most) {
  const ReadValues v = read_values(*r.value().find("value"), dimension), t = read_values(*r.value().find("tolerance"), dimension);
  if (!v.problem.empty()) return r.fail("value", v.problem);
  if (!t.problem.empty()) return r.fail("tolerance", t.problem);
  if (v.numbers.size() < least || v.numbers.size() > most)
    return r.fail("value", most == 1
                               ? "must be one value"
                               : fmt::format("must have {} components", least == most ? fmt::format("{}", least) : "two or three"));
  if (t.numbers.size() != 1) return r.fail("tolerance", "must be one value");
  out.value = v.numbers;
  out.tolerance = t.numbers[0];
  out.unit = v.unit;
}

void read_mark(Reader& r, Evidence& out) {
  const Value* mark = r.value().find("mark");
  constexpr const char* kShape = "must be a list of two or more world points, like [\"3.1 -1.2 m\", \"9.8 -1.4 m\"]";
  if (mark->kind != Value::Kind::array || mark->items.size() < 2) return r.fail("mark", kShape);
  for (const Value& item : mark->items) {
    const ReadValues point = read_values(item, Dimension::length);
    if (!point.problem.empty()) return r.fail("mark", point.problem);
    if (point.numbers.size() != 2) return r.fail("mark", kShape);
    out.mark.emplace_back(point.numbers[0], point.numbers[1], 0);
  }
  const ReadValues t = read_values(*r.value().find("tolerance"), Dimension::length);
  if (!t.problem.empty() || t.numbers.size() != 1) return r.fail("tolerance", t.problem.empty() ? "must be one length" : t.problem);
  out.value = {0};
  out.tolerance = t.numbers[0];
  out.unit = t.unit;
}

void read_one(Builder& builder, Reader& r) {
  Evidence out;
  r.fill(out);
  out.place = r.place().text();
  check_name(builder, r, "of", out.of);
  check_name(builder, r, "with", out.with);
  for (const Evidence& other : builder.scene.inference.evidence)
    if (other.name == out.name) return r.fail("name", fmt::format("is the name of other evidence, at {}", other.place));
  if (out.metric.empty() != r.has("mark")) return r.fail_here("needs either a metric or a mark");
  for (std::size_t i = 1; i < std::size(kSpecial); ++i)
    if (out.metric == kSpecial[i]) out.seen = static_cast<Seen>(i);
  if (r.has("mark")) out.seen = Seen::mark;
  const bool pair = out.seen == Seen::contact_place || out.seen == Seen::contact || out.seen == Seen::no_contact;
  if (pair && (out.of.empty() || out.with.empty())) return r.fail_here(fmt::format("needs `of` and `with`: who touched whom"));
  if (out.seen == Seen::contact || out.seen == Seen::no_contact) {
    out.value = {out.seen == Seen::contact ? 1.0 : 0.0};
    out.tolerance = 1;
    builder.scene.inference.evidence.push_back(std::move(out));
    return;
  }
  for (const char* key : {"value", "tolerance"})
    if (!r.has(key) && !(out.seen == Seen::mark && key[0] == 'v')) return r.fail(key, "is missing; [[evidence]] needs it");
  const std::size_t before = r.errors().count();
  if (out.seen == Seen::metric) read_measure(r, out);
  if (out.seen == Seen::speed) read_quantities(r, out, Dimension::speed, 1, 1);
  if (out.seen == Seen::rest_place || out.seen == Seen::landing_place) read_quantities(r, out, Dimension::length, 2, 2);
  if (out.seen == Seen::contact_place) read_quantities(r, out, Dimension::length, 3, 3);
  if (out.seen == Seen::mark) read_mark(r, out);
  if (r.errors().count() > before) return;
  if (!(out.tolerance > 0)) return r.fail("tolerance", "must be above zero: nothing is measured without error");
  builder.scene.inference.evidence.push_back(std::move(out));
}

}  // namespace

const Section kEvidenceSection{"evidence", "[[evidence]]",
                               "Something seen: a rest place, a throw, a mark, a dent, a recorded speed, and how exactly. "
                               "`crashreel fit` asks which inputs explain it.",
                               kEvidenceKeys};

void read_evidence(Builder& builder, std::vector<Reader> readers) {
  for (Reader& r : readers) read_one(builder, r);
}

}  // namespace scenes
