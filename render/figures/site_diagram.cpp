// The site from above at a round scale: road, vehicle and person at impact, landing and rest, their paths, skid marks, and the
// throw with its parts as dimensions.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "render/figures/figures.h"
#include "render/figures/outline.h"
#include "render/figures/plan.h"
#include "render/figures/sheet.h"

namespace render {
namespace {

constexpr double kAround = 1.2;    // [m] kept free around what moves
constexpr double kLeastLine = 32;  // [mm] of a dimension that holds its own number
constexpr double kSkids = 0.3;     // [m/s] slip that leaves a mark

struct Site {
  const Stage& stage;
  const engine::Recording& recording;
  const FigureJob& job;
  Plan plan;
};

const engine::Pose& pose(const engine::Snapshot& s, int body) {
  return s.bodies[static_cast<std::size_t>(body)].X_WB;
}

std::vector<double> times_of_interest(const PersonFacts& p, const engine::Recording& r) {
  std::vector<double> out;
  if (p.hit) out.push_back(*p.hit);
  if (p.landed) out.push_back(*p.landed);
  out.push_back(p.rest.value_or(r.end_time()));
  return out;
}

bool leaves_mark(const engine::WheelRecord& wheel) {
  return wheel.slip > kSkids && wheel.load > 0;
}

bool any_skids(const engine::Recording& recording) {
  return std::any_of(recording.snapshots.begin(), recording.snapshots.end(),
                     [](const engine::Snapshot& s) { return std::any_of(s.wheels.begin(), s.wheels.end(), leaves_mark); });
}

void draw_skids(cairo_t* c, const Site& site) {
  grey(c, 0.6);
  cairo_set_line_width(c, std::max(0.3, 1000 * 0.18 / site.plan.denominator));
  const auto& snapshots = site.recording.snapshots;
  for (std::size_t w = 0; w < snapshots.front().wheels.size(); ++w) {
    bool open = false;
    for (const engine::Snapshot& s : snapshots) {
      const engine::WheelRecord& wheel = s.wheels[w];
      const bool skids = leaves_mark(wheel);
      const Point2 p = site.plan.at(wheel.contact);
      if (skids && open)
        cairo_line_to(c, p.x(), p.y());
      else if (skids)
        cairo_move_to(c, p.x(), p.y());
      open = skids;
    }
    cairo_stroke(c);
  }
}

void draw_path(cairo_t* c, const Site& site, const PersonFacts& facts) {
  grey(c, 0);
  cairo_set_line_width(c, 0.35);
  set_dashes(c, 4);
  const double end = facts.rest.value_or(site.recording.end_time());
  for (const engine::Snapshot& s : site.recording.snapshots) {
    if (s.time < facts.hit.value_or(0) || s.time > end) continue;
    const Point2 p = site.plan.at(centre_of_mass(facts, site.recording, s.time));
    cairo_line_to(c, p.x(), p.y());
  }
  cairo_stroke(c);
  set_dashes(c, 0);
}

/// The length [m] that was measured between two points, on a line beside them, `offset` [mm] below on the paper.
struct LengthShown {
  Vec3 from, to;
  std::string text;
  double offset;
};

struct DimensionLine {
  Point2 a, b;         // [mm] the points
  Point2 along, down;  // directions
  Point2 p, q;         // [mm] the line's ends
};

DimensionLine line_of(const Plan& plan, const LengthShown& d) {
  DimensionLine out;
  out.a = plan.at(d.from), out.b = plan.at(d.to);
  out.along = (out.b - out.a).normalized();
  out.down = {-out.along.y(), out.along.x()};
  if (out.down.y() < 0 || (out.down.y() == 0 && out.down.x() < 0)) out.down = -out.down;
  out.p = out.a + d.offset * out.down, out.q = out.b + d.offset * out.down;
  return out;
}

constexpr double kNumber = 3.2;  // [mm] letters of a dimension

void draw_dimension(cairo_t* c, const Site& site, const LengthShown& d) {
  const auto [a, b, along, down, p, q] = line_of(site.plan, d);
  grey(c, 0.45);
  cairo_set_line_width(c, 0.15);
  draw_line(c, a.x(), a.y(), p.x() + 1.5 * down.x(), p.y() + 1.5 * down.y());
  draw_line(c, b.x(), b.y(), q.x() + 1.5 * down.x(), q.y() + 1.5 * down.y());
  grey(c, 0);
  cairo_set_line_width(c, 0.25);
  draw_line(c, p.x(), p.y(), q.x(), q.y());
  for (const Point2& end : {p, q}) {  // the draughtsman's oblique strokes
    const Point2 stroke = (along - down).normalized();
    draw_line(c, end.x() - 1.4 * stroke.x(), end.y() - 1.4 * stroke.y(), end.x() + 1.4 * stroke.x(), end.y() + 1.4 * stroke.y());
  }
  const Point2 middle = 0.5 * (p + q);
  cairo_save(c);
  cairo_translate(c, middle.x(), middle.y());
  const double angle = std::atan2(along.y(), along.x());
  cairo_rotate(c, std::abs(angle) > M_PI / 2 ? angle + M_PI : angle);
  // white behind the number: it may stand on a line of the plan
  const double width = text_width(c, d.text, kNumber);
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_rectangle(c, -width / 2 - 0.8, -4.6, width + 1.6, 4.0);
  cairo_fill(c);
  grey(c, 0);
  draw_text(c, 0, -1.4, d.text, kNumber, Align::centre);
  cairo_restore(c);
}

/// No friction follows from a slide on which a vehicle pushed: the sheet says so where it gives its length.
std::string name_of_phase(const PersonFacts& facts, const std::string& phase) {
  if (phase == "flight") return "airborne";
  return phase == "slide" && facts.dragged ? "pushed slide" : phase;
}

std::vector<LengthShown> dimensions_of(const Site& site, const PersonFacts& facts) {
  std::vector<LengthShown> out;
  if (!facts.hit) return out;
  const auto com = [&](double t) { return centre_of_mass(facts, site.recording, t); };
  const auto on_paper = [&](const Vec3& from, const Vec3& to) { return (site.plan.at(to) - site.plan.at(from)).norm(); };
  const bool alone = site.job.persons.size() == 1;  // of several the key has the parts
  const std::string whose = alone ? "" : facts.name + ": ";
  const auto text = [&](const std::string& label, double length) { return fmt::format("{}{} {:.2f} m", whose, label, length); };
  // the parts above, the whole below them; side by side where each number has room over its own line, else one below the other
  double row = 16;  // [mm] below the path
  bool crowded = false;
  for (const PhaseFacts& phase : facts.phases) {
    if (!alone) break;
    if (phase.name != "flight" && phase.name != "fall" && phase.name != "landing" && phase.name != "slide") continue;
    const Vec3 from = com(phase.from), to = com(phase.to);
    const double line = on_paper(from, to);
    if (line < 3) continue;
    if (crowded || line < kLeastLine) row += 8;
    crowded = line < kLeastLine;
    out.push_back({from, to, text(name_of_phase(facts, phase.name), phase.distance), row});
  }
  const Vec3 from = com(*facts.hit), to = com(facts.rest.value_or(site.recording.end_time()));
  for (const auto& [name, value] : facts.dimensions)
    if (name == "throw distance" && on_paper(from, to) >= 0.5)
      out.push_back({from, to, text(facts.rest ? name : "so far", value), row + 12});
  return out;
}

/// Around a number on the paper [mm].
std::array<Point2, 2> place_of(cairo_t* c, const Plan& plan, const LengthShown& d) {
  const DimensionLine line = line_of(plan, d);
  const double half = text_width(c, d.text, kNumber) / 2 + 0.8;
  const Point2 reach = half * line.along.cwiseAbs() + 2.4 * line.down.cwiseAbs();
  const Point2 middle = 0.5 * (line.p + line.q);
  return {middle - reach, middle + reach};
}

/// Of all persons: a number that would cover one before it moves down.
std::vector<LengthShown> all_dimensions(cairo_t* c, const Site& site) {
  constexpr int kMostRows = 40;
  constexpr double kRow = 2;  // [mm]
  std::vector<LengthShown> out;
  std::vector<std::array<Point2, 2>> taken;
  for (const PersonFacts& facts : site.job.persons)
    for (LengthShown& d : dimensions_of(site, facts)) {
      const auto covers = [&](const std::array<Point2, 2>& other) {
        const auto [from, to] = place_of(c, site.plan, d);
        return (from.array() < other[1].array()).all() && (other[0].array() < to.array()).all();
      };
      for (int row = 0; row < kMostRows && std::any_of(taken.begin(), taken.end(), covers); ++row) d.offset += kRow;
      taken.push_back(place_of(c, site.plan, d));
      out.push_back(std::move(d));
    }
  return out;
}

constexpr double kKeyLine = 4.4, kKeyLetters = 2.9;  // [mm]
constexpr double kDisc = 2.6;                        // [mm] radius of a number's circle

/// A circle's number and its middle [mm], the place it means, and how far to the right of the circle the name reaches.
struct Numbered {
  const PersonFacts* person;
  int number;
  Point2 at, place;
  double name = 0;
};

/// A number in a circle beside each place of each person, explained in the key; a circle makes room for those before it. Of several
/// persons each says whose it is.
std::vector<Numbered> numbers_of(cairo_t* c, const Site& site) {
  std::vector<Numbered> out;
  for (const PersonFacts& facts : site.job.persons) {
    const double name = site.job.persons.size() > 1 ? text_width(c, facts.name, kKeyLetters) + 1.6 : 0;
    int number = 0;
    for (const double t : times_of_interest(facts, site.recording)) {
      const Point2 place = site.plan.at(centre_of_mass(facts, site.recording, t));
      Point2 p = place + Point2(0, -11);
      const auto taken = [&](const Numbered& other) {
        if (name <= 0) return (other.at - p).norm() < 2 * kDisc + 0.4;
        const bool beside = p.x() + name > other.at.x() - 2 * kDisc && other.at.x() + other.name > p.x() - 2 * kDisc;
        return beside && std::abs(other.at.y() - p.y()) < 2 * kDisc + 0.4;
      };
      while (std::any_of(out.begin(), out.end(), taken)) p.y() -= 1;
      out.push_back({&facts, ++number, p, place, name});
    }
  }
  return out;
}

void draw_numbers(cairo_t* c, const Site& site) {
  const std::vector<Numbered> numbers = numbers_of(c, site);
  grey(c, 0.3);
  cairo_set_line_width(c, 0.15);
  for (const Numbered& n : numbers) draw_line(c, n.at.x(), n.at.y(), n.place.x(), n.place.y());
  for (const auto& [facts, number, p, place, name] : numbers) {
    if (name > 0) {
      cairo_set_source_rgb(c, 1, 1, 1);
      cairo_rectangle(c, p.x() + kDisc, p.y() - 1.6, name, 3.4);
      cairo_fill(c);
      grey(c, 0);
      draw_text(c, p.x() + kDisc + 0.8, p.y() + 1.0, facts->name, kKeyLetters);
    }
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_arc(c, p.x(), p.y(), kDisc, 0, 2 * M_PI);
    cairo_fill_preserve(c);
    grey(c, 0);
    cairo_set_line_width(c, 0.3);
    cairo_stroke(c);
    draw_text(c, p.x(), p.y() + 1.2, fmt::format("{}", number), 3.4, Align::centre);
  }
}

/// What is written into the plan and has its size on the paper [mm], not in the world.
std::vector<Point2> written_into(cairo_t* c, const Site& site) {
  std::vector<Point2> out;
  for (const Numbered& n : numbers_of(c, site)) {
    out.push_back(n.at - Point2(kDisc + 0.5, kDisc + 0.5));
    out.push_back(n.at + Point2(kDisc + 0.5 + n.name, kDisc + 0.5));
  }
  for (const LengthShown& d : all_dimensions(c, site)) {
    const DimensionLine line = line_of(site.plan, d);
    const double half = std::max(text_width(c, d.text, kNumber), (line.q - line.p).norm()) / 2 + 1.5;
    for (const double side : {-1.0, 1.0}) out.push_back(0.5 * (line.p + line.q) + side * half * line.along + 2 * line.down);
  }
  return out;
}

/// The largest usual scale at which the box [m] and what is written into the plan fit the sheet below `top` [mm].
Plan plan_with_writing(cairo_t* c, const Site& site, Point2 lower, Point2 upper, double top) {
  Site tried = site;
  // a smaller scale moves what is written further out in the world
  for (int i = 0; i < 4; ++i) {
    tried.plan = plan_for(lower, upper, top);
    bool fits = true;
    for (const Point2& p : written_into(c, tried)) {
      const bool inside = p.x() >= kPlanLeft && p.x() <= kPlanRight && p.y() >= top && p.y() <= kPlanBottom;
      if (inside) continue;
      fits = false;
      lower = lower.cwiseMin(tried.plan.back(p));
      upper = upper.cwiseMax(tried.plan.back(p));
    }
    if (fits) break;
  }
  return tried.plan;
}

/// What stands above the plan: of each person when and how far, then the impacts; in lines that leave the title its place.
std::vector<std::string> key_of(const engine::Recording& recording, const FigureJob& job) {
  constexpr std::size_t kLongest = 80;  // letters: 125 mm
  std::vector<std::string> out;
  for (const PersonFacts& facts : job.persons) {
    const std::vector<double> times = times_of_interest(facts, recording);
    std::string text = facts.name + ":";
    for (std::size_t i = 0; i < times.size(); ++i) {
      const bool last = i + 1 == times.size();
      const char* what = last ? (facts.rest ? "rest" : "end of run") : i == 0 && facts.hit ? "struck" : "on the ground";
      text += fmt::format("  {} {} {:.3f} s", i + 1, what, times[i]);
    }
    out.push_back(text);
    text.clear();
    for (const auto& [name, value] : facts.dimensions) {
      const bool under_way = name == "throw distance" && !facts.rest;
      const std::string next = fmt::format("{} {:.2f} m{}", name_of_phase(facts, name), value, under_way ? " so far" : "");
      if (!text.empty() && text.size() + next.size() > kLongest) out.push_back(std::exchange(text, "") + ",");
      text += (text.empty() ? "" : ", ") + next;
    }
    if (!text.empty()) out.push_back(text);
  }
  out.insert(out.end(), job.impacts.begin(), job.impacts.end());
  return out;
}

/// [mm] of the key's first line: beside the title, or below it where both have no room.
double top_of_key(cairo_t* c, const Stage& stage, const std::vector<std::string>& lines) {
  double widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, text_width(c, line, kKeyLetters));
  return kMargin + (width_of_title(c, stage) + 6 + widest <= kSheetWidth - 2 * kMargin ? 3 : 15);
}

void draw_key(cairo_t* c, const std::vector<std::string>& lines, double y) {
  grey(c, 0);
  for (const std::string& line : lines) {
    draw_text(c, kSheetWidth - kMargin, y, line, kKeyLetters, Align::right);
    y += kKeyLine;
  }
}

bool is_vehicle(const Stage& stage, int body) {
  return std::any_of(stage.wheels.begin(), stage.wheels.end(), [&](const WheelActor& w) { return w.body == body; });
}

/// On the sheet [mm].
struct Box {
  Point2 lower{1e9, 1e9}, upper{-1e9, -1e9};
  void take(const Point2& p) { lower = lower.cwiseMin(p), upper = upper.cwiseMax(p); }
  bool meets(const Box& other) const {
    return (lower.array() < other.upper.array()).all() && (other.lower.array() < upper.array()).all();
  }
};

/// A vehicle where it stands at one of the times shown. Its axes meet the sheet at the middle of its outline's ends and sides.
struct Standing {
  const MeshActor& vehicle;
  Point2 front, rear, left, right, tip, centre;  // [mm]; the tip is that of the chevron
  double half = 0;                               // [mm] of the chevron
  double width = 0;                              // [mm]
  Box box;
};

Standing standing(const Site& site, const MeshActor& vehicle, const engine::Pose& X_WB) {
  Point2 lower(1e9, 1e9), upper(-1e9, -1e9);  // [m] of the outline, body axes
  for (const Point2& p : seen_from_above(*vehicle.mesh, vehicle.X_BM)) lower = lower.cwiseMin(p), upper = upper.cwiseMax(p);
  const auto at = [&](double x, double y) { return site.plan.at(X_WB * Vec3(x, y, 0)); };
  const Point2 middle = 0.5 * (lower + upper);
  Standing out{.vehicle = vehicle,
               .front = at(upper.x(), middle.y()),
               .rear = at(lower.x(), middle.y()),
               .left = at(middle.x(), upper.y()),
               .right = at(middle.x(), lower.y()),
               .tip = at(upper.x() - 0.06 * (upper.x() - lower.x()), middle.y()),
               .centre = at(middle.x(), middle.y()),
               .box = {}};
  out.width = 1000 / site.plan.denominator * (upper.y() - lower.y());
  out.half = 0.16 * out.width;
  for (const Point2& p : seen_from_above(*vehicle.mesh, X_WB * vehicle.X_BM)) out.box.take(site.plan.at({p.x(), p.y(), 0}));
  return out;
}

/// Where the front of an outline is.
void draw_chevron(cairo_t* c, const Standing& it) {
  const Point2 ahead = (it.front - it.rear).normalized(), aside(-ahead.y(), ahead.x());
  grey(c, 0.3);
  cairo_set_line_width(c, 0.25);
  for (const double side : {-1.0, 1.0}) {
    const Point2 end = it.tip - it.half * (2 * ahead - side * aside);
    draw_line(c, end.x(), end.y(), it.tip.x(), it.tip.y());
  }
}

/// A name beside an outline: behind it if there is room, else before it or at a side, where it lies on no vehicle and no other
/// name.
void draw_name_beside(cairo_t* c, const Standing& it, const std::vector<Standing>& all, std::vector<Box>& names) {
  constexpr double kBeside = 3;  // [mm] from the outline
  struct Place {
    Point2 at;
    Align align;
    Box box;
    int covers = 0;
  };
  std::optional<Place> best;
  const double length = text_width(c, it.vehicle.name, kKeyLetters);
  for (const Point2& from : {it.rear, it.front, it.left, it.right}) {
    const Point2 away = (from - it.centre).normalized();
    Place place{from + kBeside * away + Point2(0, 1),
                away.x() > 0.5    ? Align::left
                : away.x() < -0.5 ? Align::right
                                  : Align::centre,
                {}};
    const double share = place.align == Align::left ? 0 : place.align == Align::right ? 1 : 0.5;  // of the name, left of the place
    place.box.take(place.at - Point2(share * length, kKeyLetters));
    place.box.take(place.at + Point2((1 - share) * length, 0.3 * kKeyLetters));
    for (const Standing& other : all) place.covers += other.box.meets(place.box);
    for (const Box& name : names) place.covers += name.meets(place.box);
    if (!best || place.covers < best->covers) best = place;
  }
  if (best->covers == 0) {  // on the lines of the road
    grey(c, 1);
    const Point2 size = best->box.upper - best->box.lower;
    cairo_rectangle(c, best->box.lower.x(), best->box.lower.y(), size.x(), size.y());
    cairo_fill(c);
  }
  grey(c, 0.3);
  draw_text(c, best->at.x(), best->at.y(), it.vehicle.name, kKeyLetters, best->align);
  names.push_back(best->box);
}

/// Which vehicle an outline is.
void draw_name(cairo_t* c, const Standing& it, const std::vector<Standing>& all, std::vector<Box>& names) {
  constexpr double kChevron = 4;  // [mm] beside a name within
  const double length = text_width(c, it.vehicle.name, kKeyLetters);
  if ((it.tip - it.rear).norm() <= length + 2 * kChevron) return draw_name_beside(c, it, all, names);
  const Point2 ahead = it.tip - it.centre;
  cairo_save(c);
  cairo_translate(c, it.centre.x(), it.centre.y());
  const double angle = std::atan2(ahead.y(), ahead.x());
  cairo_rotate(c, std::abs(angle) > M_PI / 2 ? angle + M_PI : angle);
  // beside its middle, where ways lead
  draw_text(c, 0, 1 - 0.22 * it.width, it.vehicle.name, kKeyLetters, Align::centre);
  cairo_restore(c);
}

/// At both times; once where it stands for both.
void draw_names(cairo_t* c, const Site& site, double first) {
  constexpr double kOwnName = 12;  // [mm] apart
  const engine::Snapshot end = site.recording.at(site.recording.end_time()), then = site.recording.at(first);
  std::vector<Standing> all;
  for (const MeshActor& actor : site.stage.meshes) {
    if (actor.body < 0 || !is_vehicle(site.stage, actor.body)) continue;
    all.push_back(standing(site, actor, pose(end, actor.body)));
    const double apart = (site.plan.at(pose(end, actor.body).p) - site.plan.at(pose(then, actor.body).p)).norm();
    if (apart > kOwnName) all.push_back(standing(site, actor, pose(then, actor.body)));
  }
  std::vector<Box> names;
  for (const Standing& it : all) draw_chevron(c, it);
  grey(c, 0.3);
  for (const Standing& it : all) draw_name(c, it, all, names);
}

/// The ways of free bodies.
void draw_body_paths(cairo_t* c, const Site& site) {
  grey(c, 0);
  cairo_set_line_width(c, 0.35);
  set_dashes(c, 4);
  for (const EllipsoidActor& actor : site.stage.ellipsoids) {
    for (const engine::Snapshot& s : site.recording.snapshots) {
      const Point2 p = site.plan.at(pose(s, actor.body).p);
      cairo_line_to(c, p.x(), p.y());
    }
    cairo_stroke(c);
  }
  set_dashes(c, 0);
}

}  // namespace

double dashed_at(const engine::Recording& recording, const FigureJob& job) {
  std::optional<double> first;
  for (const PersonFacts& p : job.persons)
    if (p.hit && (!first || *p.hit < *first)) first = p.hit;
  if (first) return *first;
  const auto met = std::find_if(recording.events.begin(), recording.events.end(),
                                [](const engine::Event& e) { return e.kind == "collision" || e.kind == "impact"; });
  return met == recording.events.end() ? 0 : met->time;
}

Vec3 centre_of_mass(const PersonFacts& person, const engine::Recording& recording, double time) {
  const engine::Snapshot s = recording.at(time);
  Vec3 sum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < person.bodies.size(); ++i) {
    sum += person.masses[i] * pose(s, person.bodies[i]).p;
    mass += person.masses[i];
  }
  return sum / mass;
}

std::vector<std::string> site_diagram(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  Point2 lower(1e9, 1e9), upper(-1e9, -1e9);
  auto take = [&](const Point2& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  };
  const double hit = dashed_at(recording, job);
  for (const PersonFacts& p : job.persons) {
    for (const engine::Snapshot& s : recording.snapshots)
      if (s.time >= p.hit.value_or(0)) take(centre_of_mass(p, recording, s.time).head<2>());
  }
  for (const double time : {hit, recording.end_time()})
    for (const MeshActor& actor : stage.meshes)
      if (actor.body >= 0)
        for (const Point2& p : seen_from_above(*actor.mesh, pose(recording.at(time), actor.body) * actor.X_BM)) take(p);
  for (const EllipsoidActor& actor : stage.ellipsoids)
    for (const engine::Snapshot& s : recording.snapshots) take(pose(s, actor.body).p.head<2>());
  if (lower.x() > upper.x()) return {};
  const Point2 around(kAround, kAround);
  std::vector<std::string> key = key_of(recording, job);
  key.push_back(fmt::format("dashed: {:.3f} s, solid: {:.3f} s{}", hit, recording.end_time(),
                            any_skids(recording) ? fmt::format(", grey: tyre marks, slip above {} m/s", kSkids) : ""));
  return write_sheets(job.folder, "site_diagram", "Site diagram: " + stage.title, [&](cairo_t* c) {
    draw_frame_of_sheet(c, stage, "Site diagram");
    const double key_top = top_of_key(c, stage, key),
                 below = std::max(kPlanTop, key_top + kKeyLine * static_cast<double>(key.size()));
    Site site{stage, recording, job, {}};
    site.plan = plan_with_writing(c, site, lower - around, upper + around, below);
    cairo_save(c);
    cairo_rectangle(c, kPlanLeft, below, kPlanRight - kPlanLeft, kPlanBottom - below);
    cairo_clip(c);
    draw_road(c, stage, site.plan);
    draw_skids(c, site);
    draw_vehicles(c, stage, site.plan, recording.at(hit), {0.97, 1});
    draw_vehicles(c, stage, site.plan, recording.at(recording.end_time()), {0.90, 0});
    draw_names(c, site, hit);
    draw_bodies(c, stage, site.plan, recording.at(hit), {0.97, 1});
    draw_bodies(c, stage, site.plan, recording.at(recording.end_time()), {0.90, 0});
    draw_body_paths(c, site);
    for (const PersonFacts& p : job.persons) {
      const std::vector<double> times = times_of_interest(p, recording);
      for (std::size_t i = 0; i < times.size(); ++i)
        draw_person(c, stage, site.plan, p.name, recording.at(times[i]),
                    {0.92 - 0.42 * static_cast<double>(i + 1) / static_cast<double>(times.size()), 0});
      draw_path(c, site, p);
    }
    for (const LengthShown& d : all_dimensions(c, site)) draw_dimension(c, site, d);
    draw_numbers(c, site);
    cairo_restore(c);
    draw_key(c, key, key_top);
    draw_scale(c, stage, site.plan);
  });
}

}  // namespace render
