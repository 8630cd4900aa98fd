// Speeds, impulses and energies over time, one panel each, with the events as upright lines. Curves differ in dashes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

#include "render/figures/figures.h"
#include "render/figures/sheet.h"
#include "render/video/story.h"

namespace render {
namespace {

constexpr double kLeft = 30, kRight = 222, kTop = 30, kBottom = kSheetHeight - 24, kGap = 9;  // [mm]

constexpr double kEventLine = 3.8;                                                   // [mm]
constexpr double kKeyLetters = 2.8, kKeyRoom = kSheetWidth - kMargin - kRight - 19;  // [mm] of a curve's name
constexpr double kMarkEvery = 14, kCurveMark = 0.9;  // [mm] on curves beyond the line styles there are

struct Curve {
  std::string name;
  std::vector<double> values;  // one a snapshot
};

struct Panel {
  std::string title;  // with its unit
  std::vector<Curve> curves;
};

template <typename Value>
Curve curve(const std::string& name, const engine::Recording& recording, Value value) {
  Curve out{name, {}};
  for (const engine::Snapshot& s : recording.snapshots) out.values.push_back(value(s));
  return out;
}

Panel speeds(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  Panel panel{"speed, km/h", {}};
  auto add = [&](const std::string& name, int body) {
    panel.curves.push_back(curve(name, recording, [b = static_cast<std::size_t>(body)](const engine::Snapshot& s) {
      return 3.6 * s.bodies[b].V_WB.v.norm();
    }));
  };
  for (const auto& [body, name, masses] : stage.speeds) {
    const bool person =
        std::any_of(job.persons.begin(), job.persons.end(), [&n = name](const PersonFacts& p) { return p.name == n; });
    add(person ? name + ", hips" : name, body);
  }
  for (std::size_t b = 0; b < recording.body_names.size(); ++b)
    if (recording.body_names[b].ends_with("/head"))
      add(recording.body_names[b].substr(0, recording.body_names[b].size() - 5) + ", head", static_cast<int>(b));
  return panel;
}

/// What vehicles and ground have given to the persons so far.
Panel impulses(const engine::Recording& recording) {
  Panel panel{"impulse on persons, N s, summed", {}};
  for (const bool vehicle : {true, false}) {
    double sum = 0;
    panel.curves.push_back(curve(vehicle ? "from vehicles" : "from the ground", recording, [&](const engine::Snapshot& s) {
      for (const engine::ContactRecord& c : s.contacts)
        if ((vehicle ? c.shapes.on_vehicle() : c.shapes.on_ground()) &&
            recording.body_names[static_cast<std::size_t>(c.body_a)].find('/') != std::string::npos)
          sum += c.impulse.norm();
      return sum;
    }));
  }
  return panel;
}

Panel energies(const engine::Recording& recording) {
  Panel panel{"energy, kJ", {}};
  panel.curves.push_back(curve("kinetic", recording, [](const engine::Snapshot& s) { return s.energies.kinetic / 1000; }));
  panel.curves.push_back(curve("dissipated", recording, [](const engine::Snapshot& s) {
    return std::accumulate(s.energies.dissipated.begin(), s.energies.dissipated.end(), 0.0) / 1000;
  }));
  const double least = std::min_element(recording.snapshots.begin(), recording.snapshots.end(), [](const auto& a, const auto& b) {
                         return a.energies.potential < b.energies.potential;
                       })->energies.potential;
  panel.curves.push_back(curve("potential above its least", recording,
                               [least](const engine::Snapshot& s) { return (s.energies.potential - least) / 1000; }));
  return panel;
}

/// Curves of every vehicle; what is asked of it follows from its snapshots so far.
template <typename Value>
Panel of_vehicles(const std::string& title, const Stage& stage, const engine::Recording& recording, Value value) {
  Panel panel{title, {}};
  for (const int body : stage.vehicles) {
    const engine::Snapshot* before = nullptr;
    double last = 0;
    panel.curves.push_back(curve(recording.body_names[static_cast<std::size_t>(body)], recording,
                                 [&, b = static_cast<std::size_t>(body)](const engine::Snapshot& s) {
                                   if (before) last = value(before->bodies[b], s.bodies[b], s.time - before->time, last);
                                   before = &s;
                                   return last;
                                 }));
  }
  return panel;
}

Panel distances(const Stage& stage, const engine::Recording& recording) {
  // level, as path_m of the summary: who rolls over rises and falls besides
  return of_vehicles("level distance, m", stage, recording, [](const auto& from, const auto& to, double, double so_far) {
    return so_far + (to.X_WB.p - from.X_WB.p).template head<2>().norm();
  });
}

constexpr double kPedals = 15;  // [m/s^2] more than tyres can do: impacts leave the panel, and the title says so

Panel accelerations(const Stage& stage, const engine::Recording& recording) {
  Panel panel = of_vehicles("acceleration, m/s^2", stage, recording, [](const auto& from, const auto& to, double dt, double last) {
    return dt > 0 ? (to.V_WB.v.norm() - from.V_WB.v.norm()) / dt : last;
  });
  bool cut = false;
  for (Curve& k : panel.curves)
    for (double& v : k.values) {
      cut = cut || std::abs(v) > kPedals;
      v = std::clamp(v, -kPedals, kPedals);
    }
  if (cut) panel.title += fmt::format(", cut at {:g}", kPedals);
  return panel;
}

/// Distance between the numbers of an axis: 1, 2 or 5 times a power of ten, six numbers at most.
double spacing(double range) {
  const double least = std::max(range, 1e-9) / 6, power = std::pow(10, std::floor(std::log10(least)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= least) return m * power;
  return 10 * power;
}

struct Box {
  double top, bottom, end, ceiling, floor = 0;
  double x(double t) const { return kLeft + (kRight - kLeft) * t / end; }
  double y(double v) const { return bottom - (bottom - top) * (v - floor) / (ceiling - floor); }
};

void draw_axes(cairo_t* c, const Panel& panel, const Box& box, bool last) {
  cairo_set_line_width(c, 0.12);
  const double dv = spacing(box.ceiling - box.floor), dt = spacing(box.end);
  for (double v = box.floor; v <= box.ceiling + 1e-9 * dv; v += dv) {
    grey(c, 0.8);
    draw_line(c, kLeft, box.y(v), kRight, box.y(v));
    grey(c, 0);
    draw_text(c, kLeft - 2, box.y(v) + 1, fmt::format("{:g}", std::round(v / dv) * dv), 2.8, Align::right);
  }
  for (double t = 0; t <= box.end * (1 + 1e-9); t += dt) {
    grey(c, 0.8);
    draw_line(c, box.x(t), box.top, box.x(t), box.bottom);
    grey(c, 0);
    if (last) draw_text(c, box.x(t), box.bottom + 4.2, fmt::format("{:g}", std::round(t / dt) * dt), 2.8, Align::centre);
  }
  if (last) draw_text(c, (kLeft + kRight) / 2, box.bottom + 9, "time, s", 3.2, Align::centre);
  cairo_save(c);
  cairo_translate(c, kLeft - 14, (box.top + box.bottom) / 2);
  cairo_rotate(c, -M_PI / 2);
  draw_text(c, 0, 0, panel.title, panel.title.size() > 20 ? 2.7 : 3.2, Align::centre);
  cairo_restore(c);
}

void draw_panel(cairo_t* c, const Panel& panel, const Box& box, const engine::Recording& recording, bool last) {
  draw_axes(c, panel, box, last);
  double key = box.top + 3;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const int style = static_cast<int>(i);
    grey(c, i % 2 == 0 ? 0 : 0.3);
    cairo_set_line_width(c, i % 2 == 0 ? 0.45 : 0.35);
    set_dashes(c, style);
    for (std::size_t k = 0; k < panel.curves[i].values.size(); ++k)
      cairo_line_to(c, box.x(recording.snapshots[k].time), box.y(std::clamp(panel.curves[i].values[k], box.floor, box.ceiling)));
    cairo_stroke(c);
    draw_line(c, kRight + 5, key - 1, kRight + 17, key - 1);
    set_dashes(c, 0);
    grey(c, 0);
    if (style >= kLineStyles) {
      const int shape = style / kLineStyles - 1;
      draw_mark(c, shape, kRight + 11, key - 1, kCurveMark);
      // those of two such curves stand apart
      double next = kLeft + kMarkEvery * (0.3 + 0.25 * (style % kLineStyles));
      for (std::size_t k = 0; k < panel.curves[i].values.size(); ++k) {
        const double x = box.x(recording.snapshots[k].time);
        if (x < next) continue;
        draw_mark(c, shape, x, box.y(std::clamp(panel.curves[i].values[k], box.floor, box.ceiling)), kCurveMark);
        next += kMarkEvery;
      }
    }
    draw_text(c, kRight + 19, key, shortened(c, panel.curves[i].name, kKeyLetters, kKeyRoom), kKeyLetters);
    key += 5;
  }
}

/// A text of the list in lines that end before the margin.
std::vector<std::string> broken(cairo_t* c, const std::string& text) {
  constexpr double kRoom = kSheetWidth - kMargin - kRight - 5;  // [mm]
  std::vector<std::string> out{""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    word = shortened(c, word, 2.5, kRoom - text_width(c, "     ", 2.5));
    // a number at the start keeps its two spaces; what goes on stands to the right of it
    const std::string longer = out.back() +
                               (out.back().empty()                         ? ""
                                : out.size() == 1 && out.back().size() < 3 ? "  "
                                                                           : " ") +
                               word;
    if (text_width(c, longer, 2.5) < kRoom || out.back().empty())
      out.back() = longer;
    else
      out.push_back("     " + word);
  }
  return out;
}

/// Room at the right of the panels [mm], from above.
struct Room {
  double from, to;
};

/// What happened when: an upright line through all panels, and its number in the list at the right, which fills one room after the
/// other.
void draw_events(cairo_t* c, const engine::Recording& recording, double end, std::vector<Room> rooms) {
  const Box box{kTop, kBottom, end, 1};
  double taken = -10;
  int number = 0;
  for (const Told& e : told(recording)) {
    ++number;
    const std::vector<std::string> lines = broken(c, fmt::format("{}  {:.3f} s {}", number, e.time, e.text));
    while (!rooms.empty() && rooms[0].from + kEventLine * static_cast<double>(lines.size() - 1) > rooms[0].to)
      rooms.erase(rooms.begin());
    if (rooms.empty()) {
      grey(c, 0);
      draw_text(c, kRight + 5, kBottom + 1.5 * kEventLine, "and later ones: summary.json", 2.5);
      break;
    }
    grey(c, 0.45);
    cairo_set_line_width(c, 0.2);
    set_dashes(c, 2);
    draw_line(c, box.x(e.time), kTop, box.x(e.time), kBottom);
    set_dashes(c, 0);
    grey(c, 0);
    // numbers of events close in time stand side by side
    const std::string told = fmt::format("{}", number);
    const double half = 0.5 * text_width(c, told, 3) + 0.6;
    taken = std::max(taken + half, box.x(e.time));
    draw_text(c, taken, kTop - 1.5, told, 3, Align::centre);
    taken += half;
    for (const std::string& line : lines) {
      draw_text(c, kRight + 5, rooms[0].from, line, 2.5);
      rooms[0].from += kEventLine;
    }
  }
}

double extreme(const Panel& panel, double sign) {
  double out = 0;
  for (const Curve& k : panel.curves)
    for (const double v : k.values) out = std::max(out, sign * v);
  return out;
}

std::vector<std::string> sheet_of(std::vector<Panel> panels, const std::string& file, const std::string& heading,
                                  const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  std::erase_if(panels, [](const Panel& p) { return extreme(p, 1) <= 0 && extreme(p, -1) <= 0; });
  const double end = recording.end_time();
  if (panels.empty() || end <= 0) return {};
  return write_sheets(job.folder, file, heading + ": " + stage.title, [&](cairo_t* c) {
    draw_frame_of_sheet(c, stage, heading);
    const double height = (kBottom - kTop - kGap * static_cast<double>(panels.size() - 1)) / static_cast<double>(panels.size());
    for (std::size_t i = 0; i < panels.size(); ++i) {
      const double highest = extreme(panels[i], 1), deepest = extreme(panels[i], -1);
      const double step = spacing(highest + deepest), top = kTop + static_cast<double>(i) * (height + kGap);
      draw_panel(c, panels[i],
                 {top, top + height, end, std::ceil(highest / step - 1e-9) * step, -std::ceil(deepest / step - 1e-9) * step},
                 recording, i + 1 == panels.size());
    }
    std::vector<Room> rooms;
    for (std::size_t i = 0; i < panels.size(); ++i) {
      const double top = kTop + static_cast<double>(i) * (height + kGap);
      // below the last one stands that there are more
      rooms.push_back({top + 3 + 5 * static_cast<double>(panels[i].curves.size()) + 4, std::min(top + height + kGap - 3, kBottom)});
    }
    draw_events(c, recording, end, rooms);
  });
}

}  // namespace

std::vector<std::string> time_histories(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  return sheet_of({speeds(stage, recording, job), impulses(recording), energies(recording)}, "time_histories", "Time histories",
                  stage, recording, job);
}

std::vector<std::string> vehicle_histories(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  Panel speed = of_vehicles("speed, km/h", stage, recording,
                            [](const auto&, const auto& to, double, double) { return 3.6 * to.V_WB.v.norm(); });
  for (Curve& k : speed.curves)
    if (k.values.size() > 1) k.values[0] = k.values[1];
  return sheet_of({std::move(speed), distances(stage, recording), accelerations(stage, recording)}, "vehicle_histories",
                  "Vehicles over time", stage, recording, job);
}

}  // namespace render
