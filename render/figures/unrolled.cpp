#include "render/figures/unrolled.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace render {
namespace {

using Surface = UnrolledPicture::Surface;

Surface surface_of(const Material& m) {
  switch (m.kind) {
    case MaterialKind::glass:
      return Surface::glass;
    case MaterialKind::lamp:
      return Surface::lamp;
    case MaterialKind::paint:
      return Surface::body;
    default:
      return Surface::trim;
  }
}

/// Corner of a triangle on the unrolled vehicle [cells], with its distance from the tape [m].
struct Corner {
  double along, across, off;
};

struct Canvas {
  UnrolledPicture& picture;
  std::vector<double> off;  // [m] of what each cell shows

  void triangle(const std::array<Corner, 3>& c, Surface surface) {
    const auto [a, b, d] = c;
    const double area = (b.along - a.along) * (d.across - a.across) - (d.along - a.along) * (b.across - a.across);
    if (std::abs(area) < 1e-9) return;
    const auto range = [](double x, double y, double z, int size) {
      return std::array<int, 2>{std::max(0, static_cast<int>(std::ceil(std::min({x, y, z}) - 0.5))),
                                std::min(size - 1, static_cast<int>(std::floor(std::max({x, y, z}) - 0.5)))};
    };
    const auto rows = range(a.across, b.across, d.across, picture.width),
               columns = range(a.along, b.along, d.along, picture.length);
    for (int j = rows[0]; j <= rows[1]; ++j)
      for (int i = columns[0]; i <= columns[1]; ++i) {
        const double x = i + 0.5 - a.along, y = j + 0.5 - a.across;
        const double v = (x * (d.across - a.across) - (d.along - a.along) * y) / area;
        const double w = ((b.along - a.along) * y - x * (b.across - a.across)) / area;
        if (v < 0 || w < 0 || v + w > 1) continue;
        const std::size_t cell =
            static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.length) + static_cast<std::size_t>(i);
        const double here = a.off + v * (b.off - a.off) + w * (d.off - a.off);
        if (here >= off[cell]) continue;
        off[cell] = here;
        picture.cells[cell] = surface;
      }
  }
};

}  // namespace

std::vector<Point2> tape_of(const Stage& stage, int body, double ground) {
  std::vector<Point2> points;
  for (const MeshActor& actor : stage.meshes) {
    if (actor.body != body) continue;
    for (std::size_t i = 0; i + 2 < actor.mesh->positions.size(); i += 3) {
      const float* p = &actor.mesh->positions[i];
      const Vec3 q = actor.X_BM * Vec3(p[0], p[1], p[2]);
      points.emplace_back(q.x(), q.z());
    }
  }
  const std::vector<Point2> hull = convex_hull(points);
  if (hull.size() < 3) return {};
  // counter-clockwise, x forward and z up: from the foremost point upwards and backwards, to where the roof falls off
  const auto front = std::max_element(hull.begin(), hull.end(), [](const Point2& a, const Point2& b) { return a.x() < b.x(); });
  std::vector<Point2> tape{{front->x(), ground}};
  for (auto at = front;; at = at + 1 == hull.end() ? hull.begin() : at + 1) {
    const Point2 step = *at - tape.back();
    if (tape.size() > 2 && step.y() < 0.4 * step.x()) break;  // steeper down than 22 degrees
    tape.push_back(*at);
    if (tape.size() > hull.size()) break;
  }
  return tape;
}

OnTape on_tape(const std::vector<Point2>& tape, const Point2& p) {
  OnTape best{0, 1e300};
  double length = 0;
  for (std::size_t i = 1; i < tape.size(); ++i) {
    const Point2 side = tape[i] - tape[i - 1];
    const double s = std::clamp((p - tape[i - 1]).dot(side) / std::max(side.squaredNorm(), 1e-12), 0.0, 1.0);
    const double off = (tape[i - 1] + s * side - p).norm();
    if (off < best.off) best = {length + s * side.norm(), off};
    length += side.norm();
  }
  return best;
}

bool lies_above(const engine::ContactRecord& touch, const Pose& X_WB, double off) {
  constexpr double kUnderside = -0.5;  // [-] of the normal out of the vehicle: within 60 degrees of straight down
  constexpr double kEdge = 0.2;        // [m] a bumper's lower edge is so near the tape, a floor is not
  if (touch.shapes.b == engine::ShapeKind::tyre) return false;
  return off < kEdge || (X_WB.q.conjugate() * touch.normal).z() > kUnderside;
}

UnrolledPicture::Surface UnrolledPicture::at(int along, int across) const {
  if (along < 0 || across < 0 || along >= length || across >= width) return nothing;
  return cells[static_cast<std::size_t>(across) * static_cast<std::size_t>(length) + static_cast<std::size_t>(along)];
}

UnrolledPicture unroll(const Stage& stage, int body, const std::vector<Point2>& tape, double length, double half_width) {
  constexpr double kCell = UnrolledPicture::kCell;
  UnrolledPicture out;
  out.length = static_cast<int>(length / kCell);
  out.width = static_cast<int>(2 * half_width / kCell);
  const std::size_t count = static_cast<std::size_t>(out.length) * static_cast<std::size_t>(out.width);
  out.cells.assign(count, UnrolledPicture::nothing);
  Canvas canvas{out, std::vector<double>(count, 1e300)};
  for (const MeshActor& actor : stage.meshes) {
    if (actor.body != body) continue;
    const Mesh& mesh = *actor.mesh;
    std::vector<Corner> corners;
    for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
      const Vec3 q = actor.X_BM * Vec3(mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]);
      const OnTape place = on_tape(tape, {q.x(), q.z()});
      corners.push_back({place.along / kCell, (q.y() + half_width) / kCell, place.off});
    }
    std::vector<Mesh::Part> parts = mesh.parts;
    if (parts.empty()) parts.push_back({0, static_cast<std::uint32_t>(mesh.indices.size()), -1});
    for (const Mesh::Part& part : parts) {
      const bool known = part.material >= 0 && static_cast<std::size_t>(part.material) < mesh.materials.size();
      const Surface surface = known ? surface_of(mesh.materials[static_cast<std::size_t>(part.material)]) : Surface::body;
      for (std::size_t i = part.first; i + 2 < part.first + part.count; i += 3)
        canvas.triangle({corners[mesh.indices[i]], corners[mesh.indices[i + 1]], corners[mesh.indices[i + 2]]}, surface);
    }
  }
  return out;
}

std::vector<Stretch> stretches(const UnrolledPicture& picture, const std::vector<Point2>& tape) {
  constexpr double kLeast = 0.25;  // [m] worth a name
  double length = 0, level = -1;   // [m] along the tape; where it first lies flatter than it stands
  for (std::size_t i = 1; i < tape.size(); ++i) {
    const Point2 side = tape[i] - tape[i - 1];
    if (level < 0 && std::abs(side.x()) > std::abs(side.y())) level = length;
    length += side.norm();
  }
  // the longest run of glass on the middle line: the windscreen
  const int middle = picture.width / 2;
  int best = 0, first = 0;
  for (int i = 0, run = 0; i <= picture.length; ++i) {
    if (picture.at(i, middle) == UnrolledPicture::glass) {
      ++run;
      continue;
    }
    if (run > best) best = run, first = i - run;
    run = 0;
  }
  const double from = first * UnrolledPicture::kCell, to = (first + best) * UnrolledPicture::kCell;
  std::vector<Stretch> out;
  const auto add = [&out](const char* name, double a, double b) {
    if (b - a > kLeast) out.push_back({name, a, b});
  };
  if (to - from < kLeast) return out;
  add("front", (tape[1] - tape[0]).norm(), std::min(std::max(level, 0.0), from));
  add("bonnet", std::min(std::max(level, 0.0), from), from);
  add("windscreen", from, to);
  add("roof", to, std::min(length, picture.length * UnrolledPicture::kCell));
  return out;
}

}  // namespace render
