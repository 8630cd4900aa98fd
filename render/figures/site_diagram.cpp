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
#include "render/figures/site.h"

namespace render {
namespace {

constexpr double kAround = 1.2;  // [m] kept free around what moves
constexpr double kSkids = 0.3;   // [m/s] slip that leaves a mark

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

constexpr double kKeyLine = 4.4;  // [mm]
constexpr double kDisc = 2.6;     // [mm] radius of a number's circle

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
  for (const Point2& p : ThrowLengths(c, site).reach()) out.push_back(p);
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
    draw_vehicle_names(c, site, hit);
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
    ThrowLengths(c, site).draw();
    draw_numbers(c, site);
    cairo_restore(c);
    draw_key(c, key, key_top);
    draw_scale(c, stage, site.plan);
  });
}

}  // namespace render
