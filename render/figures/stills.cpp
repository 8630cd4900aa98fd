// Stills made of several moments: the stroboscopic one from the side of the throw, and a sheet of the film's instants.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/figures/figures.h"
#include "render/figures/rest_cloud.h"
#include "render/image/png.h"
#include "render/painter.h"
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

/// At how many of some instants from the touch to the landing something as high as a car stands between a person and who looks from
/// that far beside it.
int times_hidden(const Stage& stage, const PersonFacts& p, const engine::Recording& recording, const Vec3& beside) {
  constexpr int kInstants = 6, kPoints = 40;
  constexpr double kHigh = 1;  // [m]
  const double from = p.hit.value_or(0), to = p.landed.value_or(recording.end_time());
  int hidden = 0;
  for (const MeshActor& actor : stage.meshes) {
    if (actor.body < 0) continue;
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i + 2 < actor.mesh->positions.size(); i += 3)
      box.extend(Eigen::Vector3d(actor.mesh->positions[i], actor.mesh->positions[i + 1], actor.mesh->positions[i + 2]));
    if (box.sizes().z() < kHigh) continue;
    box.min().z() = -1e3;
    box.max().z() = 1e3;
    for (int k = 0; k < kInstants; ++k) {
      const double time = from + (to - from) * k / (kInstants - 1);
      const Vec3 person = centre_of_mass(p, recording, time);
      const engine::Pose X_MW = (recording.at(time).bodies[static_cast<std::size_t>(actor.body)].X_WB * actor.X_BM).inverse();
      bool between = false;
      for (int i = 1; i <= kPoints; ++i) between = between || box.contains(X_MW * Vec3(person + i * beside / kPoints));
      hidden += between;
    }
  }
  return hidden;
}

/// Goes along with a person, square to the way from where it is struck to where it ends, on the side where the vehicle that struck
/// does not stand between: it was struck at a corner, say.
Camera beside_person(const Stage& stage, const PersonFacts& p, const engine::Recording& recording) {
  Vec3 way = centre_of_mass(p, recording, recording.end_time()) - centre_of_mass(p, recording, p.hit.value_or(0));
  way.z() = 0;
  way = way.norm() > 0.2 ? Vec3(way.normalized()) : Vec3(Vec3::UnitX());
  constexpr double kAway = 9.5;  // [m]
  Vec3 side(way.y(), -way.x(), 0);
  if (times_hidden(stage, p, recording, kAway * side) > times_hidden(stage, p, recording, -kAway * side)) side = -side;
  Camera camera;
  camera.name = "beside";
  camera.kind = CameraKind::follow;
  camera.follow = p.name;
  camera.vertical_fov = 0.5;
  // what struck it comes from behind, and is to be seen too
  camera.target = -1.1 * way + Vec3(0, 0, 0.9);
  camera.position = camera.target + kAway * side + Vec3(0, 0, 1.4);
  return camera;
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

std::vector<std::string> stroboscopic_still(const Stage& stage, const engine::Recording& recording, const FigureJob& job) {
  const auto [from, to] = span_of(recording, job);
  const std::vector<Vec3> points = places(stage, recording, job, from);
  if (points.empty()) return {};
  Stage scene = stage;
  scene.cameras.insert(scene.cameras.begin(), beside(points, static_cast<double>(job.width) / job.height));
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
  DrawList list;
  LabelItem key;
  key.lines = {"solid: " + figure.middle};
  for (const RestGhost& g : figure.ghosts) key.lines.push_back("pale: " + g.label);
  key.sizes.assign(key.lines.size(), 26);
  key.colours.assign(key.lines.size(), {1, 1, 1, 1});
  key.anchor = {0.02f, 0.03f};
  list.labels.push_back(key);
  draw_labels(list, image);
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
  if (!job.persons.empty()) scene.cameras.insert(scene.cameras.begin(), beside_person(stage, job.persons[job.person], recording));
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
