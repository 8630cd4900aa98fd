// Density at x of places x_i: sum of exp(-(x - x_i)^T S^-1 (x - x_i) / (2 h^2)), S their covariance, h = n^(-1/6) (Scott 1992, two
// dimensions). The region that holds a share p is where it exceeds the (1 - p) quantile of its values at the places themselves
// (Hyndman 1996). Its edge is found on a grid, by straight lines between the grid's points (marching squares).
#include "cli/inference/rest.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "cli/apart.h"
#include "cli/study/quantities.h"
#include "engine/plan.h"
#include "engine/simulate.h"

namespace cli::inference {
namespace {

using render::Point2;

constexpr double kLeastSpread = 0.02;  // [m] a cloud on a line is still given this width
constexpr int kGrid = 160;             // points along each side
constexpr double kBeyond = 3;          // [kernel widths] of the grid beyond the outermost place
constexpr double kSame = 0.005;        // [m] rest places as near as this are one place

class KernelDensity {
 public:
  explicit KernelDensity(const std::vector<Point2>& places) : places_(places) {
    const auto n = static_cast<double>(places.size());
    Point2 mean = Point2::Zero();
    for (const Point2& p : places) mean += p / n;
    Eigen::Matrix2d s = kLeastSpread * kLeastSpread * Eigen::Matrix2d::Identity();
    for (const Point2& p : places) s += (p - mean) * (p - mean).transpose() / n;
    const double h = std::pow(n, -1.0 / 6);
    inverse_ = (h * h * s).inverse();
    reach_ = kBeyond * h * Point2(std::sqrt(s(0, 0)), std::sqrt(s(1, 1)));
  }
  double at(const Point2& x) const {
    double sum = 0;
    for (const Point2& p : places_) sum += std::exp(-0.5 * (x - p).dot(inverse_ * (x - p)));
    return sum;
  }
  const Point2& reach() const { return reach_; }

 private:
  const std::vector<Point2>& places_;
  Eigen::Matrix2d inverse_;
  Point2 reach_;
};

/// Straight pieces of the line at which the density on a grid passes the level.
class Contour {
 public:
  Contour(const KernelDensity& density, Point2 lower, Point2 upper, double level)
      : lower_(lower), cell_((upper - lower) / (kGrid - 1)), level_(level), values_(kGrid * kGrid) {
    for (int j = 0; j < kGrid; ++j)
      for (int i = 0; i < kGrid; ++i) values_[index(i, j)] = density.at(place(i, j));
  }
  std::vector<std::array<Point2, 2>> pieces() const {
    std::vector<std::array<Point2, 2>> out;
    for (int j = 0; j + 1 < kGrid; ++j)
      for (int i = 0; i + 1 < kGrid; ++i) {
        // two triangles a cell: a triangle is crossed once or not at all
        add({{{i, j}, {i + 1, j}, {i, j + 1}}}, out);
        add({{{i + 1, j + 1}, {i, j + 1}, {i + 1, j}}}, out);
      }
    return out;
  }

 private:
  using Corner = std::array<int, 2>;
  static std::size_t index(int i, int j) { return static_cast<std::size_t>(j * kGrid + i); }
  Point2 place(int i, int j) const { return lower_ + cell_.cwiseProduct(Point2(i, j)); }
  void add(const std::array<Corner, 3>& triangle, std::vector<std::array<Point2, 2>>& out) const {
    std::vector<Point2> crossed;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner &a = triangle[k], &b = triangle[(k + 1) % 3];
      const double from = values_[index(a[0], a[1])] - level_, to = values_[index(b[0], b[1])] - level_;
      if ((from > 0) == (to > 0)) continue;
      crossed.push_back(place(a[0], a[1]) + from / (from - to) * (place(b[0], b[1]) - place(a[0], a[1])));
    }
    if (crossed.size() == 2) out.push_back({crossed[0], crossed[1]});
  }

  Point2 lower_, cell_;
  double level_;
  std::vector<double> values_;
};

/// The run whose value is nearest to a percentile.
std::size_t nearest_run(const std::vector<double>& values, double wanted) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(values[i] - wanted) < least) least = std::abs(values[i] - wanted), best = i;
  return best;
}

struct Repeated {
  scenes::Scene scene;
  engine::Recording recording;
  std::string label;
};

Repeated repeat(const scenes::Scene& scene, const Prior& prior, const Sample& sample, const Percentile& p) {
  const std::vector<double> values = column(sample.table, sample.main);
  const std::size_t run = nearest_run(values, p.value);
  Repeated out{scenes::variant(scene, overrides_of(prior, sample.table, sample.table.rows[run])), {}, {}};
  out.recording = engine::simulate(out.scene.model, engine::compile(out.scene.model));
  const std::string chosen = p.share < 0.5 ? "least" : p.share > 0.5 ? "greatest" : "middle";
  const std::string place = is_chosen(sample.table) ? chosen : fmt::format("{:g}th percentile of", 100 * p.share);
  out.label = fmt::format("run {}, {} {}: {:.3g} {}", run + 1, place, study::words_of(sample.main), values[run],
                          study::unit_of(sample.main));
  if (!sample.table.rows[run].answer.notes.so_far.empty()) out.label += ", still moving at the end";
  return out;
}

render::FigureJob job_for(const scenes::Scene& scene, const std::filesystem::path& folder) {
  render::FigureJob job;
  job.folder = folder;
  job.metadata = {{"title", scene.stage.title},
                  {"version", fmt::format("crashreel {}", CRASHREEL_VERSION)},
                  {"scene", scene.path.filename().string()},
                  {"scene_sha256", scene.sha256}};
  for (const engine::Person& person : scene.model.persons) {
    render::PersonFacts facts;
    facts.name = person.name;
    facts.bodies = person.bodies;
    for (const int b : person.bodies) facts.masses.push_back(scene.model.bodies[static_cast<std::size_t>(b)].mass);
    job.persons.push_back(std::move(facts));
  }
  return job;
}

}  // namespace

render::RestRegion region_of(const std::vector<Point2>& places, double share) {
  render::RestRegion out{share, {}};
  if (places.size() < kFewestPlaces) return out;
  const KernelDensity density(places);
  std::vector<double> at;
  Point2 lower = places[0], upper = places[0];
  for (const Point2& p : places) {
    at.push_back(density.at(p));
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  std::sort(at.begin(), at.end());
  const double level = at[static_cast<std::size_t>((1 - share) * static_cast<double>(at.size() - 1))];
  out.edge = Contour(density, lower - density.reach(), upper + density.reach(), level).pieces();
  return out;
}

bool holds(const render::RestRegion& region, const Point2& p) {
  bool inside = false;
  for (const auto& [a, b] : region.edge)
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  return inside;
}

std::vector<render::RestCloud> clouds_of(const Table& table) {
  std::map<std::string, std::vector<Point2>> places;
  std::size_t answered = 0;
  for (const Row& row : table.rows) {
    answered += row.answer.ok();
    for (const auto& [name, place] : row.answer.rests) places[name].emplace_back(place[0], place[1]);
  }
  std::vector<render::RestCloud> out;
  for (auto& [name, all] : places) {
    const auto far = [&first = all.front()](const Point2& p) { return (p - first).norm() > kSame; };
    if (std::none_of(all.begin(), all.end(), far)) continue;
    std::vector<render::RestRegion> regions;
    if (!is_chosen(table) && all.size() >= kFewestPlaces) regions = {region_of(all, 0.5), region_of(all, 0.95)};
    const std::size_t moving = answered - all.size();
    out.push_back({name, std::move(all), moving, std::move(regions)});
  }
  return out;
}

std::vector<std::string> draw_rests(const scenes::Scene& scene, const Prior& prior, const Sample& sample,
                                    const std::filesystem::path& folder) {
  render::RestFigure figure;
  figure.clouds = clouds_of(sample.table);
  if (figure.clouds.empty() || sample.main.empty()) return {};
  const Output* main = nullptr;
  for (const Output& o : sample.outputs)
    if (o.name == sample.main) main = &o;
  std::optional<Repeated> middle;
  for (const double share : {0.5, 0.05, 0.95})
    for (const Percentile& p : main->percentiles) {
      if (p.share != share) continue;
      Repeated run = repeat(scene, prior, sample, p);
      if (!middle)
        middle = std::move(run);
      else if (run.scene.model.bodies.size() == middle->scene.model.bodies.size())
        figure.ghosts.push_back({run.label, run.recording.snapshots.back()});
    }
  figure.middle = middle->label;
  middle->scene.stage.provenance = scene.stage.provenance;
  const render::FigureJob job = job_for(middle->scene, folder);
  std::vector<std::string> files =
      apart("rest_cloud", [&] { return rest_cloud(middle->scene.stage, middle->recording, job, figure); });
  for (std::string& file : apart("rest_ghosts", [&] { return rest_ghosts(middle->scene.stage, middle->recording, job, figure); }))
    files.push_back(std::move(file));
  for (std::string& file : files) file = std::filesystem::path(file).filename().string();
  return files;
}

}  // namespace cli::inference
