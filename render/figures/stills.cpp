// Stills made of several moments: the stroboscopic one from the side of the throw, and a sheet of the film's instants.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/arrange.h"
#include "render/cameras.h"
#include "render/figures/figures.h"
#include "render/figures/rest_cloud.h"
#include "render/image/png.h"
#include "render/painter.h"
#include "render/sight.h"
#include "render/text/labels.h"

namespace render {
namespace {

constexpr double kFigures = 9;          // stroboscopic ones
constexpr int kColumns = 3, kRows = 3;  // of the contact sheet
constexpr double kAspectOfFilm = 16.0 / 9.0;

std::vector<std::string> write(const FigureJob& job, const std::string& name, const Image& image) {
  const std::filesystem::path file = job.folder / name;
  write_png(file, image, TextChunks(job.metadata.begin(), job.metadata.end()));
  return {file.string()};
}

/// What moves after `from`: persons, else free bodies.
std::vector<Vec3> places(const Stage& stage, const engine::Recording& recording, const FigureJob& job, double from) {
  std::vector<Vec3> out;
  for (const engine::Snapshot& s : recording.snapshots) {
    if (s.time < from) continue;
    for (const PersonFacts& p : job.persons) out.push_back(s.bodies[static_cast<std::size_t>(p.bodies.front())].X_WB.p);
    for (const EllipsoidActor& actor : stage.ellipsoids) out.push_back(s.bodies[static_cast<std::size_t>(actor.body)].X_WB.p);
  }
  return out;
}

/// A long lens square to the way of what moves, far enough to see all of it, from its right.
Camera beside(const std::vector<Vec3>& points, double aspect) {
  const Vec3 first = points.front(), last = points.back();
  Vec3 way = last - first;
  way.z() = 0;
  way = way.norm() > 0.2 ? Vec3(way.normalized()) : Vec3(Vec3::UnitX());
  const Vec3 side(way.y(), -way.x(), 0);
  double low = 1e9, high = -1e9, tallest = 0;
  for (const Vec3& p : points) {
    low = std::min(low, (p - first).dot(way));
    high = std::max(high, (p - first).dot(way));
    tallest = std::max(tallest, p.z());
  }
  Camera camera;
  camera.name = "stroboscopic";
  camera.vertical_fov = 0.35;
  const double width = high - low + 4, height = std::max(tallest + 1.2, width / aspect);  // [m] seen, a person's length around
  const double distance = height / 2 / std::tan(camera.vertical_fov / 2);
  camera.target = first + 0.5 * (low + high) * way;
  camera.target.z() = 0.8 + 0.04 * height;  // a little above what lies on the road: the caption stands in the lower part
  camera.position = camera.target + distance * (side + Vec3(0, 0, 0.22));
  return camera;
}

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from + (to - from) * i / (count - 1));
  return out;
}

/// Parts of a person whose middle a camera sees, summed over some instants.
int parts_seen(const Camera& camera, const PersonFacts& person, const Stage& stage, const engine::Recording& recording,
               const std::vector<double>& times) {
  int seen = 0;
  for (const double time : times) {
    const engine::Snapshot now = recording.at(time);
    const Float3 eye = view_of(camera, recording, time, kAspectOfFilm).eye;
    for (const int body : person.bodies) {
      const Vec3& part = now.bodies[static_cast<std::size_t>(body)].X_WB.p;
      seen += free_share(stage, now, part, Vec3(eye[0], eye[1], eye[2]) - part) == 1;
    }
  }
  return seen;
}

/// Beside the way of what moves, with what struck as it stood then, from the side where more of the persons is seen.
Camera camera_of_stroboscope(const Stage& stage, const engine::Recording& recording, const FigureJob& job, std::vector<Vec3> points,
                             double met, double end) {
  for (const PersonFacts& p : job.persons)
    if (p.vehicle_body >= 0)
      points.insert(points.begin() + 1, recording.at(met).bodies[static_cast<std::size_t>(p.vehicle_body)].X_WB.p);
  const Camera right = beside(points, static_cast<double>(job.width) / job.height);
  Camera left = right;
  left.position.head<2>() = 2 * right.target.head<2>() - right.position.head<2>();
  const std::vector<double> times = evenly(met, end, static_cast<int>(kFigures));
  int more_from_left = 0;
  for (const PersonFacts& p : job.persons)
    more_from_left += parts_seen(left, p, stage, recording, times) - parts_seen(right, p, stage, recording, times);
  return more_from_left > 0 ? left : right;
}

void add_key(const std::vector<std::string>& lines, Image& image) {
  DrawList list;
  LabelItem key;
  key.lines = lines;
  key.sizes.assign(lines.size(), 26);
  key.colours.assign(lines.size(), {1, 1, 1, 1});
  key.anchor = {0.02f, 0.03f};
  list.labels.push_back(key);
  draw_labels(list, image);
}

/// From the first touch of anybody to the last rest, or to the end where one who was touched came to none.
std::pair<double, double> span_of(const engine::Recording& recording, const FigureJob& job) {
  std::optional<double> hit, rest;
  for (const PersonFacts& p : job.persons) {
    if (p.hit && (!hit || *p.hit < *hit)) hit = p.hit;
    const double still = p.rest.value_or(p.hit ? recording.end_time() : 0);
    if (!rest || still > *rest) rest = still;
  }
  return {hit.value_or(0), hit ? *rest : recording.end_time()};
}

}  // namespace

Camera camera_of_sheet(const Stage& stage, const engine::Recording& recording, const PersonFacts& p) {
  constexpr int kInstants = 6;
  const double from = p.hit.value_or(0), to = p.landed.value_or(recording.end_time());
  Vec3 way = centre_of_mass(p, recording, recording.end_time()) - centre_of_mass(p, recording, from);
  way.z() = 0;
  way = way.norm() > 0.2 ? Vec3(way.normalized()) : Vec3(Vec3::UnitX());
  constexpr double kAway = 9.5;  // [m]
  const Vec3 right(way.y(), -way.x(), 0);
  Camera camera;
  camera.name = "beside";
  camera.kind = CameraKind::follow;
  camera.follow = p.name;
  camera.vertical_fov = 0.5;
  // what struck it comes from behind, and is to be seen too
  camera.target = -1.1 * way + Vec3(0, 0, 0.9);
  camera.position = camera.target + kAway * right + Vec3(0, 0, 1.4);
  Camera across = camera;
  across.position -= 2 * kAway * right;
  const std::vector<double> times = evenly(from, to, kInstants);
  const auto seen = [&](const Camera& from_there) { return parts_seen(from_there, p, stage, recording, times); };
  return seen(across) > seen(camera) ? across : camera;
}

Stage stage_of_stroboscope(const Stage& stage, const engine::Recording& recording, double met, double end) {
  constexpr double kMoved = 0.1;  // [m]
  constexpr float kOpacity = 0.25f;
  const engine::Snapshot then = recording.at(met), last = recording.at(end);
  Stage out = stage;
  for (const int body : stage.vehicles) {
    const auto b = static_cast<std::size_t>(body);
    const auto rides = [&](const PersonActor& person) { return person.mount == body; };
    if (std::any_of(stage.persons.begin(), stage.persons.end(), rides)) continue;
    if ((last.bodies[b].X_WB.p - then.bodies[b].X_WB.p).norm() < kMoved) continue;
    std::erase_if(out.meshes, [&](const MeshActor& actor) { return actor.body == body; });
    std::erase_if(out.wheels, [&](const WheelActor& actor) { return actor.body == body; });
    for (MeshActor& actor : standing(stage, body, then)) out.meshes.push_back(std::move(actor));
    for (MeshActor& actor : standing(stage, body, last)) {
      actor.repaint = placed(actor.mesh, actor.X_BM, actor.repaint).materials;
      for (Material& m : actor.repaint) m.kind = MaterialKind::glass, m.opacity = kOpacity;
      actor.solid = nullptr;
      out.meshes.push_back(std::move(actor));
    }
  }
  return out;
}

std::vector<std::string> stroboscopic_still(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  const auto [from, to] = span_of(recording, job);
  const std::vector<Vec3> points = places(stage, recording, job, from);
  if (points.empty()) return {};
  const double met = dashed_at(recording, job);
  Stage scene = stage_of_stroboscope(stage, recording, met, to);
  scene.cameras.insert(scene.cameras.begin(), camera_of_stroboscope(scene, recording, job, points, met, to));
  double way = 0;
  for (std::size_t i = job.persons.size() + stage.ellipsoids.size(), n = i; i < points.size(); i += n)
    way += (points[i] - points[i - n]).norm();
  // equal ways, not equal times: a figure at rest would otherwise be drawn over and over
  scene.overlays.set("ghost_distance", std::max(way / kFigures, 0.3));
  scene.overlays.set("traces");
  scene.overlays.hide({"ghost_interval", "contacts", "forces", "speed_chart", "energy_chart", "legend"});
  Painter painter(job.width, job.height, job.quality);
  Image image;
  painter.paint(scene, recording, {to, "stroboscopic", 1}, image);
  std::vector<std::string> key;
  // what no longer moves stands there twice
  const auto moves = [&](int body) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), [body](const MeshActor& m) { return m.body == body; });
  };
  for (const MeshActor& actor : stage.meshes)
    if (!moves(actor.body)) key.push_back(fmt::format("{}: solid at t = {:.3f} s, clear at t = {:.3f} s", actor.name, met, to));
  if (!key.empty()) add_key(key, image);
  return write(job, "stroboscopic.png", image);
}

std::vector<std::string> rest_ghosts(const Stage& stage, const engine::Recording& middle, const FigureJob& job,
                                     const RestFigure& figure) {
  // the ends of the runs as instants of one recording, the one in full last: figures of earlier instants are drawn pale
  engine::Recording ends = middle;
  ends.snapshots.clear();
  for (const RestGhost& g : figure.ghosts) ends.snapshots.push_back(g.end);
  ends.snapshots.push_back(middle.snapshots.back());
  for (std::size_t i = 0; i < ends.snapshots.size(); ++i) ends.snapshots[i].time = static_cast<double>(i);
  const std::vector<Vec3> points = places(stage, ends, job, 0);
  if (points.empty()) return {};
  Stage scene = stage;
  scene.cameras.insert(scene.cameras.begin(), beside(points, static_cast<double>(job.width) / job.height));
  scene.overlays = {};
  scene.overlays.set("ghost_interval", 0.5);  // of instants a second apart
  scene.overlays.hide({"contacts", "forces", "caption"});
  Painter painter(job.width, job.height, job.quality);
  Image image;
  painter.paint(scene, ends, {ends.end_time(), "stroboscopic", 1}, image);
  std::vector<std::string> key{"solid: " + figure.middle};
  for (const RestGhost& g : figure.ghosts) key.push_back("pale: " + g.label);
  add_key(key, image);
  return write(job, "rest_ghosts.png", image);
}

std::vector<double> times_of_sheet(const engine::Recording& recording, const FigureJob& job) {
  const PersonFacts nobody, &person = job.persons.empty() ? nobody : job.persons[job.person];
  const auto &hit = person.hit, &landed = person.landed;
  std::vector<double> times;
  const double end = recording.end_time();
  if (!landed || !hit || !(*hit < *landed)) {
    for (int i = 0; i < 9; ++i) times.push_back(hit.value_or(0) + (end - hit.value_or(0)) * i / 8.0);
    return times;
  }
  for (int i = 0; i < 6; ++i) times.push_back(*hit + (*landed - *hit) * i / 5.0);
  for (int i = 1; i <= 3; ++i) times.push_back(*landed + (end - *landed) * i / 3.0);
  return times;
}

std::vector<std::string> contact_sheet(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  const std::vector<double> times = times_of_sheet(recording, job);
  const int w = job.width / kColumns, h = static_cast<int>(std::lround(w / kAspectOfFilm));
  Stage scene = stage;
  if (!job.persons.empty()) scene.cameras.insert(scene.cameras.begin(), camera_of_sheet(stage, recording, job.persons[job.person]));
  // labels would be too small to read
  scene.overlays.hide({"contacts", "forces", "disclaimer", "caption", "legend", "speed_chart", "energy_chart"});
  scene.overlays.set("contact_history");
  scene.warnings.clear();  // they stand in the foot, where they can be read
  Painter painter(w, h, job.quality);
  Image sheet, still;
  sheet.width = w * kColumns;
  sheet.height = h * kRows;
  sheet.rgba.resize(static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height) * 4);
  for (int i = 0; i < kColumns * kRows; ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    painter.paint(scene, recording, {t, scene.cameras.front().name, 1}, still);
    DrawList list;
    LabelItem time;
    time.lines = {fmt::format("{}   t = {:.3f} s", i + 1, t)};
    time.sizes = {52};
    time.colours = {{1, 1, 1, 1}};
    time.anchor = {0.02f, 0.03f};
    list.labels.push_back(time);
    draw_labels(list, still);
    for (int y = 0; y < h; ++y)
      std::copy_n(&still.rgba[static_cast<std::size_t>(4 * y * w)], 4 * w,
                  &sheet.rgba[static_cast<std::size_t>(4 * ((i / kColumns * h + y) * sheet.width + i % kColumns * w))]);
  }
  // one foot for all
  DrawList foot;
  LabelItem label;
  label.lines = {"Simulation, not footage   " + stage.provenance};
  for (const std::string& warning : stage.warnings) label.lines.push_back("Warning: " + warning);
  label.sizes.assign(label.lines.size(), 16);
  label.colours.assign(label.lines.size(), {1, 1, 1, 1});
  label.anchor = {0.992f, 0.99f};
  label.pivot = {1, 1};
  foot.labels.push_back(label);
  draw_labels(foot, sheet);
  return write(job, "contact_sheet" + job.name_after + ".png", sheet);
}

}  // namespace render
