#include "render/surface/orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "render/surface/simplify.h"

namespace render {

std::vector<float> vertex_normals(const std::vector<float>& p, const std::vector<std::uint32_t>& indices) {
  std::vector<float> n(p.size(), 0.0f);
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const std::size_t a = 3 * std::size_t{indices[t]}, b = 3 * std::size_t{indices[t + 1]}, c = 3 * std::size_t{indices[t + 2]};
    const Eigen::Vector3f pa(p[a], p[a + 1], p[a + 2]), pb(p[b], p[b + 1], p[b + 2]), pc(p[c], p[c + 1], p[c + 2]);
    const Eigen::Vector3f area = (pb - pa).cross(pc - pa);
    for (const std::size_t v : {a, b, c})
      for (std::size_t i = 0; i < 3; ++i) n[v + i] += area[static_cast<Eigen::Index>(i)];
  }
  for (std::size_t v = 0; v + 2 < n.size(); v += 3) {
    const float length = std::sqrt(n[v] * n[v] + n[v + 1] * n[v + 1] + n[v + 2] * n[v + 2]);
    if (length > 0)
      for (std::size_t i = 0; i < 3; ++i) n[v + i] /= length;
    else
      n[v + 2] = 1;
  }
  return n;
}

int winding(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v + 2 < mesh.positions.size(); v += 3)
    box.extend(Eigen::Vector3f::Map(&mesh.positions[v]).cast<double>());
  double volume = 0, area = 0;
  Eigen::Vector3d facing = Eigen::Vector3d::Zero();
  const Eigen::Vector3d middle = box.center();
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    std::array<Eigen::Vector3d, 3> c;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = 3 * std::size_t{mesh.indices[t + k]};
      c[k] = Eigen::Vector3d(mesh.positions[v], mesh.positions[v + 1], mesh.positions[v + 2]) - middle;
    }
    volume += c[0].dot(c[1].cross(c[2])) / 6;
    const Eigen::Vector3d part = (c[1] - c[0]).cross(c[2] - c[0]);
    facing += part;
    area += part.norm();
  }
  if (facing.norm() > 0.2 * area) return 0;
  if (std::abs(volume) <= 0.1 * box.volume()) return 0;
  return volume > 0 ? 1 : -1;
}

bool of_one_winding(const Mesh& mesh) {
  constexpr double kBorders = 0.05, kWrong = 0.002;  // of the edges
  const std::vector<std::uint32_t> vertex = welded(mesh);
  std::vector<std::uint64_t> edges, turned;
  edges.reserve(mesh.indices.size());
  turned.reserve(mesh.indices.size());
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = vertex[mesh.indices[t + k]], b = vertex[mesh.indices[t + (k + 1) % 3]];
      edges.push_back(a << 32 | b);
      turned.push_back(b << 32 | a);
    }
  std::sort(edges.begin(), edges.end());
  std::sort(turned.begin(), turned.end());
  std::size_t wrong = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) wrong += edges[i] == edges[i - 1] ? 1 : 0;
  std::vector<std::uint64_t> open;
  std::set_difference(edges.begin(), edges.end(), turned.begin(), turned.end(), std::back_inserter(open));
  const double all = static_cast<double>(edges.size());
  return static_cast<double>(open.size()) < kBorders * all && static_cast<double>(wrong) < kWrong * all;
}

}  // namespace render
