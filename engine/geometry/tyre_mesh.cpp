#include "engine/geometry/tyre_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace engine {
namespace {

/// Of a triangle what lies in the tyre's middle plane: along the disc and up [m], from its centre.
using Piece = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

struct MiddlePlane {
  Vec3 centre, axle, forward, up;  // mesh axes

  Eigen::Vector2d seen(const Vec3& p) const { return {forward.dot(p - centre), up.dot(p - centre)}; }
  Vec3 place(const Eigen::Vector2d& p) const { return centre + p.x() * forward + p.y() * up; }

  std::optional<Piece> cut(const TriangleMesh& mesh, const Triangle& triangle) const {
    std::array<Vec3, 3> v;
    std::array<double, 3> side;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = mesh.vertices()[static_cast<std::size_t>(triangle[i])];
      side[i] = axle.dot(v[i] - centre);
    }
    std::array<Eigen::Vector2d, 3> ends;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if ((side[i] < 0) == (side[k] < 0)) continue;
      ends[count++] = seen(v[i] + side[i] / (side[i] - side[k]) * (v[k] - v[i]));
    }
    if (count < 2) return std::nullopt;
    return ends[0].x() <= ends[1].x() ? Piece{ends[0], ends[1]} : Piece{ends[1], ends[0]};
  }
};

/// Where along a piece a disc of radius R stands highest, no farther out than `reach`; tangent to it or at one of its ends.
struct Stand {
  Eigen::Vector2d at;
  bool tangent = false;
};
std::optional<Stand> highest(const Piece& piece, double R, double reach) {
  const auto& [from, to] = piece;
  const double first = std::max(from.x(), -reach), last = std::min(to.x(), reach);
  if (first > last) return std::nullopt;
  const Eigen::Vector2d way = to - from;
  if (way.x() <= 1e-9) return Stand{from.y() > to.y() ? from : to};
  const double tangent = R * way.y() / way.norm();
  const double s = std::clamp(tangent, first, last);
  return Stand{{s, from.y() + (s - from.x()) / way.x() * way.y()}, s == tangent};
}

}  // namespace

std::optional<TyreTouch> move_clear(const Tyre& tyre, const TriangleMesh& mesh, const Pose& X_WM, const Vec3& along, double facing,
                                    const WayRange& range, std::vector<int>& scratch) {
  const Quat q_MW = X_WM.q.conjugate();
  MiddlePlane plane{X_WM.inverse() * tyre.centre, q_MW * tyre.axle, {}, q_MW * along};
  plane.forward = plane.axle.cross(plane.up);
  const double R = tyre.radius, reach = R * std::sqrt(1 - facing * facing);
  // from where the lowest way leaves its lower half to where the highest does
  const Vec3 low = plane.place({0, range.least - R}), high = plane.place({0, range.most});
  const Vec3 aside = R * plane.forward.cwiseAbs();
  scratch.clear();
  mesh.query({low.cwiseMin(high) - aside, low.cwiseMax(high) + aside}, scratch);
  std::optional<TyreTouch> best;
  double way_of_best = range.least;
  for (const int t : scratch) {
    const Vec3& normal = mesh.face_normals()[static_cast<std::size_t>(t)];
    if (normal.dot(plane.up) < -1e-9) continue;
    const auto piece = plane.cut(mesh, mesh.triangles()[static_cast<std::size_t>(t)]);
    const auto stand = piece ? highest(*piece, R, reach) : std::nullopt;
    if (!stand) continue;
    const double way = stand->at.y() + std::sqrt(R * R - stand->at.x() * stand->at.x());
    if (way <= way_of_best || way > range.most) continue;
    way_of_best = way;
    const Eigen::Vector2d to_hub = Eigen::Vector2d(0, way) - stand->at;
    best = {way, X_WM * plane.place(stand->at),
            X_WM.q * (stand->tangent ? normal : Vec3((to_hub.x() * plane.forward + to_hub.y() * plane.up) / R))};
  }
  return best;
}

}  // namespace engine
