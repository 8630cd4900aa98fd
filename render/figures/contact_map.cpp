// The struck vehicle unrolled, with its parts, and on it the touches as marks: the shape tells the part of the body, the lightness
// the time, the size the impulse.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/figures.h"
#include "render/figures/sheet.h"
#include "render/figures/unrolled.h"
#include "render/overlays/overlay.h"

namespace render {
namespace {

constexpr double kLeft = 34, kTop = 34, kRight = 215, kBottom = kSheetHeight - 26;  // [mm]
constexpr double kLeast = 0.2;                                                      // [N s]
constexpr double kSpread = 0.04;  // [m] one mark a cell and part: the strongest touch

struct Touch {
  int part = 5;
  double along = 0, across = 0;  // [m] tape from the ground; to the left
  double time = 0, impulse = 0;
};

/// The touches the map shows, and between which times others are not on it.
struct Touches {
  std::vector<Touch> marks;
  double first_below = 1e300, last_below = -1e300;  // [s]
};

Touches touches(const engine::Recording& recording, const std::vector<Point2>& tape, int body, const FigureJob& job) {
  const auto of_another = [&job](int b) {
    for (std::size_t p = 0; p < job.persons.size(); ++p)
      if (p != job.person && std::count(job.persons[p].bodies.begin(), job.persons[p].bodies.end(), b) > 0) return true;
    return false;
  };
  Touches all;
  std::vector<Touch>& out = all.marks;
  for (const engine::Snapshot& s : recording.snapshots)
    for (const engine::ContactRecord& c : s.contacts) {
      if (!c.shapes.on_vehicle() || c.body_b != body || c.impulse.norm() < kLeast || of_another(c.body_a)) continue;
      const Pose& X = s.bodies[static_cast<std::size_t>(body)].X_WB;
      const Vec3 p = X.q.conjugate() * (c.point - X.p);
      const OnTape place = on_tape(tape, {p.x(), p.z()});
      if (!lies_above(c, X, place.off)) {
        all.first_below = std::min(all.first_below, s.time);
        all.last_below = std::max(all.last_below, s.time);
        continue;
      }
      const Touch touch{part_of(recording.body_names[static_cast<std::size_t>(c.body_a)]), place.along, p.y(), s.time,
                        c.impulse.norm()};
      const auto same = std::find_if(out.begin(), out.end(), [&](const Touch& t) {
        return t.part == touch.part && std::hypot(t.along - touch.along, t.across - touch.across) < kSpread;
      });
      if (same == out.end())
        out.push_back(touch);
      else if (touch.impulse > same->impulse)
        *same = touch;
    }
  // the largest first, so that small ones are not covered
  std::stable_sort(out.begin(), out.end(), [](const Touch& a, const Touch& b) { return a.impulse > b.impulse; });
  return all;
}

struct Scales {
  double length, half_width;  // [m] shown
  double x(double along) const { return kLeft + (kRight - kLeft) * along / length; }
  double y(double across) const { return (kTop + kBottom) / 2 - (kRight - kLeft) * across / length; }
};

/// Calls `each` for every run of equal answers of `what` to 0 .. count - 1.
template <typename What, typename Each>
void for_runs(int count, const What& what, const Each& each) {
  for (int i = 0, end = 0; i < count; i = end) {
    const auto value = what(i);
    for (end = i + 1; end < count && what(end) == value;) ++end;
    each(i, end, value);
  }
}

/// The vehicle: its surfaces in greys, and lines where they meet. One path a grey, so that the file stays small.
void draw_vehicle(cairo_t* c, const Scales& s, const UnrolledPicture& picture) {
  constexpr double kGreys[] = {1, 0.96, 0.84, 0.90, 0.74};  // nothing, body, glass, lamp, trim
  constexpr double kCell = UnrolledPicture::kCell;
  const auto x = [&](int i) { return s.x(i * kCell); };
  const auto y = [&](int j) { return s.y(j * kCell - s.half_width); };
  for (const auto surface : {UnrolledPicture::body, UnrolledPicture::glass, UnrolledPicture::lamp, UnrolledPicture::trim}) {
    for (int j = 0; j < picture.width; ++j)
      for_runs(
          picture.length, [&](int i) { return picture.at(i, j) == surface; },
          [&](int from, int to, bool here) {
            if (here) cairo_rectangle(c, x(from), y(j + 1), x(to) - x(from), y(j) - y(j + 1));
          });
    grey(c, kGreys[surface]);
    cairo_fill(c);
  }
  const auto segment = [c](double x0, double y0, double x1, double y1) {
    cairo_move_to(c, x0, y0);
    cairo_line_to(c, x1, y1);
  };
  for (int j = 0; j <= picture.width; ++j)
    for_runs(
        picture.length, [&](int i) { return picture.at(i, j) != picture.at(i, j - 1); },
        [&](int from, int to, bool border) {
          if (border) segment(x(from), y(j), x(to), y(j));
        });
  for (int i = 0; i <= picture.length; ++i)
    for_runs(
        picture.width, [&](int j) { return picture.at(i, j) != picture.at(i - 1, j); },
        [&](int from, int to, bool border) {
          if (border) segment(x(i), y(from), x(i), y(to));
        });
  grey(c, 0.45);
  cairo_set_line_width(c, 0.18);
  cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  cairo_stroke(c);
}

void draw_names(cairo_t* c, const Scales& s, const std::vector<Stretch>& names) {
  grey(c, 0.3);
  for (const Stretch& stretch : names)
    draw_text(c, s.x((stretch.from + stretch.to) / 2), s.y(s.half_width) - 2, stretch.name, 3.0, Align::centre);
}

void draw_grid(cairo_t* c, const Scales& s) {
  cairo_set_line_width(c, 0.15);
  for (double v = 0; v <= s.length + 1e-9; v += 0.5) {
    grey(c, 0.75);
    draw_line(c, s.x(v), s.y(s.half_width), s.x(v), s.y(-s.half_width));
    grey(c, 0);
    draw_text(c, s.x(v), s.y(-s.half_width) + 4.5, fmt::format("{:.1f}", v), 2.9, Align::centre);
  }
  for (double v = -std::floor(2 * s.half_width) / 2; v <= s.half_width + 1e-9; v += 0.5) {
    grey(c, 0.75);
    draw_line(c, s.x(0), s.y(v), s.x(s.length), s.y(v));
    grey(c, 0);
    draw_text(c, s.x(0) - 2, s.y(v) + 1, fmt::format("{:.1f}", v), 2.9, Align::right);
  }
  draw_text(c, s.x(s.length / 2), s.y(-s.half_width) + 10,
            "along the vehicle, tape over its side view, m (a wrap-around distance is of the section at its place)", 3.2,
            Align::centre);
  cairo_save(c);
  cairo_translate(c, s.x(0) - 14, s.y(0));
  cairo_rotate(c, -M_PI / 2);
  draw_text(c, 0, 0, "across, to the left, m", 3.2, Align::centre);
  cairo_restore(c);
}

void draw_key(cairo_t* c, const std::vector<Touch>& marks, double first, double last) {
  double y = kTop + 6;
  const double x = kRight + 16;
  grey(c, 0);
  draw_text(c, x, y, "part (shape)", 3.2);
  for (int part = 0; part < 6; ++part) {
    if (std::none_of(marks.begin(), marks.end(), [part](const Touch& t) { return t.part == part; })) continue;
    y += 6;
    grey(c, 0.8);
    draw_mark(c, part, x + 3, y - 1.1, 1.6);
    draw_text(c, x + 8, y, name_of_part(part), 3.0);
  }
  y += 10;
  draw_text(c, x, y, "time (lightness)", 3.2);
  constexpr double kTold = 5e-4;  // [s] times are told to a millisecond
  for (const double share : {0.0, 0.5, 1.0}) {
    if (share > 0 && last - first < kTold) break;
    y += 6;
    const Float4 k = colour_of_share(share);
    cairo_set_source_rgb(c, k[0], k[1], k[2]);
    draw_mark(c, 0, x + 3, y - 1.1, 1.6);
    draw_text(c, x + 8, y, fmt::format("{:.3f} s", first + share * (last - first)), 3.0);
  }
  y += 10;
  draw_text(c, x, y, "impulse (size)", 3.2);
  for (const double impulse : {1.0, 10.0, 50.0}) {
    y += 7;
    grey(c, 0.8);
    draw_mark(c, 0, x + 3, y - 1.1, 0.6 + 0.42 * std::sqrt(impulse));
    draw_text(c, x + 8, y, fmt::format("{:g} N s", impulse), 3.0);
  }
}

}  // namespace

std::vector<std::string> contact_map(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  if (job.persons.empty() || job.persons[job.person].vehicle_body < 0) return {};
  const PersonFacts& struck = job.persons[job.person];
  const int body = struck.vehicle_body;
  const double ground = stage.road.height - recording.snapshots.front().bodies[static_cast<std::size_t>(body)].X_WB.p.z();
  const std::vector<Point2> tape = tape_of(stage, body, ground);
  if (tape.size() < 3) return {};
  const Touches all = touches(recording, tape, body, job);
  const std::vector<Touch>& marks = all.marks;
  if (marks.empty()) return {};
  double half_width = 0.5, first = 1e9, last = 0, farthest = 0;
  for (const MeshActor& actor : stage.meshes)
    if (actor.body == body)
      for (std::size_t i = 1; i < actor.mesh->positions.size(); i += 3)
        half_width = std::max(half_width, std::abs(static_cast<double>(actor.mesh->positions[i])));
  for (const Touch& t : marks) {
    first = std::min(first, t.time);
    last = std::max(last, t.time);
    farthest = std::max(farthest, t.along);
  }
  const double shown = std::ceil(2 * half_width + 0.2) / 2;
  Scales scales{std::max(std::ceil(2 * farthest + 0.6) / 2, 2.0), shown};
  // as long as it must be to keep the width on the paper
  scales.length = std::max(scales.length, std::ceil(2 * 2 * shown * (kRight - kLeft) / (kBottom - kTop)) / 2);
  const UnrolledPicture picture = unroll(stage, body, tape, scales.length, scales.half_width);
  const std::vector<Stretch> names = stretches(picture, tape);
  return write_sheets(job.folder, "contact_map" + job.name_after, "Contact map: " + stage.title, [&](cairo_t* c) {
    draw_frame_of_sheet(
        c, stage, "Contact map of " + recording.body_names[static_cast<std::size_t>(body)] + ", unrolled, with " + struck.name);
    draw_vehicle(c, scales, picture);
    draw_grid(c, scales);
    draw_names(c, scales, names);
    for (const Touch& t : marks) {
      const Float4 k = colour_of_share(last > first ? (t.time - first) / (last - first) : 0);
      cairo_set_source_rgb(c, k[0], k[1], k[2]);
      draw_mark(c, t.part, scales.x(t.along), scales.y(t.across), 0.6 + 0.42 * std::sqrt(std::min(t.impulse, 60.0)));
    }
    draw_key(c, marks, first, last);
    if (all.first_below > all.last_below) return;
    grey(c, 0);
    draw_text(c, scales.x(scales.length / 2), scales.y(-scales.half_width) + 15,
              fmt::format("Not on this map: touches of the underside and the wheels, {:.3f} to {:.3f} s.", all.first_below,
                          all.last_below),
              2.9, Align::centre);
  });
}

}  // namespace render
