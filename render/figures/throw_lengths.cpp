// The throw and its parts as dimensions of the site diagram.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/figures/site.h"

namespace render {
namespace {

constexpr double kLeastLine = 32;  // [mm] of a dimension that holds its own number
constexpr double kNumber = 3.2;    // [mm] letters of a dimension

}  // namespace

std::string name_of_phase(const PersonFacts& facts, const std::string& phase) {
  if (phase == "flight") return "airborne";
  return phase == "slide" && facts.dragged ? "pushed slide" : phase;
}

struct ThrowLengths::Line {
  Point2 a, b;         // [mm] the points
  Point2 along, down;  // directions
  Point2 p, q;         // [mm] the line's ends
};

ThrowLengths::Line ThrowLengths::line_of(const Length& d) const {
  const Plan& plan = site_.plan;
  Line out;
  out.a = plan.at(d.from), out.b = plan.at(d.to);
  out.along = (out.b - out.a).normalized();
  out.down = {-out.along.y(), out.along.x()};
  if (out.down.y() < 0 || (out.down.y() == 0 && out.down.x() < 0)) out.down = -out.down;
  out.p = out.a + d.offset * out.down, out.q = out.b + d.offset * out.down;
  return out;
}

void ThrowLengths::draw(const Length& d) const {
  cairo_t* c = c_;
  const auto [a, b, along, down, p, q] = line_of(d);
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

std::vector<ThrowLengths::Length> ThrowLengths::lengths_of(const PersonFacts& facts) const {
  const Site& site = site_;
  std::vector<Length> out;
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
std::array<Point2, 2> ThrowLengths::place_of(const Length& d) const {
  const Line line = line_of(d);
  const double half = text_width(c_, d.text, kNumber) / 2 + 0.8;
  const Point2 reach = half * line.along.cwiseAbs() + 2.4 * line.down.cwiseAbs();
  const Point2 middle = 0.5 * (line.p + line.q);
  return {middle - reach, middle + reach};
}

/// Of all persons: a number that would cover one before it moves down.
ThrowLengths::ThrowLengths(cairo_t* c, const Site& site) : c_(c), site_(site) {
  constexpr int kMostRows = 40;
  constexpr double kRow = 2;  // [mm]
  std::vector<std::array<Point2, 2>> taken;
  for (const PersonFacts& facts : site.job.persons)
    for (Length& d : lengths_of(facts)) {
      const auto covers = [&](const std::array<Point2, 2>& other) {
        const auto [from, to] = place_of(d);
        return (from.array() < other[1].array()).all() && (other[0].array() < to.array()).all();
      };
      for (int row = 0; row < kMostRows && std::any_of(taken.begin(), taken.end(), covers); ++row) d.offset += kRow;
      taken.push_back(place_of(d));
      all_.push_back(std::move(d));
    }
}

void ThrowLengths::draw() const {
  for (const Length& d : all_) draw(d);
}

std::vector<Point2> ThrowLengths::reach() const {
  std::vector<Point2> out;
  for (const Length& d : all_) {
    const Line line = line_of(d);
    const double half = std::max(text_width(c_, d.text, kNumber), (line.q - line.p).norm()) / 2 + 1.5;
    for (const double side : {-1.0, 1.0}) out.push_back(0.5 * (line.p + line.q) + side * half * line.along + 2 * line.down);
  }
  return out;
}

}  // namespace render
