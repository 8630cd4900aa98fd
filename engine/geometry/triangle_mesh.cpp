#include "engine/geometry/triangle_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "engine/math/functions.h"

namespace engine {
namespace {

constexpr double kWeld = 1e-5;         // [m]
constexpr double kDegenerate = 1e-12;  // [-] area / longest edge squared
constexpr double kFlat = 1e-3;         // [rad] dihedral angle below which an edge is part of a flat face
constexpr double kLevel = 1e-11;       // [rad] below which two faces are one plane, to rounding of their corners
constexpr int kLeaf = 4;               // triangles

/// Maps every vertex to the first one within the weld distance, by a grid of that pitch sorted along with its neighbours.
std::vector<int> weld(const std::vector<Vec3>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return vertices[a].x() != vertices[b].x() ? vertices[a].x() < vertices[b].x() : a < b; });
  std::vector<int> to(vertices.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (to[order[i]] >= 0) continue;
    to[order[i]] = order[i];
    for (std::size_t k = i + 1; k < order.size() && vertices[order[k]].x() - vertices[order[i]].x() <= kWeld; ++k)
      if (to[order[k]] < 0 && (vertices[order[k]] - vertices[order[i]]).norm() <= kWeld) to[order[k]] = order[i];
  }
  return to;
}

struct HalfEdge {
  int low, high;  // vertices
  int triangle, edge;
};

/// Every edge of every triangle, equal edges side by side.
std::vector<HalfEdge> sorted_edges(const std::vector<Triangle>& triangles) {
  std::vector<HalfEdge> edges;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const Triangle& v = triangles[t];
    for (int e = 0; e < 3; ++e) edges.push_back({std::min(v[e], v[(e + 1) % 3]), std::max(v[e], v[(e + 1) % 3]), t, e});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::array{a.low, a.high, a.triangle, a.edge} < std::array{b.low, b.high, b.triangle, b.edge};
  });
  return edges;
}

/// Two triangles that share an edge run along it in opposite directions, or one of them is turned over: a hole to what stands on
/// it. Within each connected piece the fewer follow the more. Returns how many were turned.
int turn_strays(std::vector<Triangle>& triangles) {
  struct Link {
    int to;
    bool agrees;
  };
  std::vector<std::vector<Link>> links(triangles.size());
  const std::vector<HalfEdge> edges = sorted_edges(triangles);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) {
      const HalfEdge &a = edges[i], &b = edges[i + 1];
      const bool agrees = triangles[a.triangle][a.edge] != triangles[b.triangle][b.edge];
      links[a.triangle].push_back({b.triangle, agrees});
      links[b.triangle].push_back({a.triangle, agrees});
    }
    i = end;
  }
  int turned = 0;
  std::vector<char> side(triangles.size(), 0);  // 0: not seen yet; 1, 2: like or unlike the first of its piece
  std::vector<int> piece;
  for (int first = 0; first < static_cast<int>(triangles.size()); ++first) {
    if (side[first]) continue;
    piece.assign(1, first);
    side[first] = 1;
    int unlike = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      unlike += side[piece[k]] == 2;
      for (const Link& link : links[piece[k]]) {
        if (side[link.to]) continue;  // a Moebius strip has no two sides: it stays as it came
        side[link.to] = link.agrees ? side[piece[k]] : static_cast<char>(3 - side[piece[k]]);
        piece.push_back(link.to);
      }
    }
    const char stray = 2 * unlike > static_cast<int>(piece.size()) ? 1 : 2;
    for (const int t : piece) {
      if (side[t] != stray) continue;
      std::swap(triangles[t][1], triangles[t][2]);
      ++turned;
    }
  }
  return turned;
}

}  // namespace

WeldedTriangles::WeldedTriangles(std::vector<Vec3> given, const std::vector<Triangle>& all) : vertices(std::move(given)) {
  const std::vector<int> to = weld(vertices);
  std::vector<std::array<int, 4>> known;  // sorted corners and index, to find duplicates
  for (Triangle t : all) {
    for (auto& v : t) {
      assert(v >= 0 && v < static_cast<int>(vertices.size()) && "the loader has checked the indices");
      v = to[v];
    }
    const Vec3 e1 = vertices[t[1]] - vertices[t[0]], e2 = vertices[t[2]] - vertices[t[0]];
    const double longest = std::max({e1.squaredNorm(), e2.squaredNorm(), (e2 - e1).squaredNorm()});
    const Vec3 n = e1.cross(e2);
    if (longest == 0 || 0.5 * n.norm() / longest < kDegenerate) {
      ++dropped;
      continue;
    }
    std::array<int, 4> sorted{t[0], t[1], t[2], static_cast<int>(triangles.size())};
    std::sort(sorted.begin(), sorted.begin() + 3);
    known.push_back(sorted);
    triangles.push_back(t);
  }
  std::sort(known.begin(), known.end());
  std::vector<char> duplicate(triangles.size(), 0);
  for (std::size_t i = 1; i < known.size(); ++i)
    if (std::equal(known[i].begin(), known[i].begin() + 3, known[i - 1].begin())) duplicate[known[i][3]] = 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (duplicate[i])
      ++dropped;
    else
      triangles[kept++] = triangles[i];
  }
  triangles.resize(kept);
  for (const Triangle& t : triangles)
    for (const std::int32_t v : t) {
      bounds.lower = bounds.lower.cwiseMin(vertices[v]);
      bounds.upper = bounds.upper.cwiseMax(vertices[v]);
    }
}

TriangleMesh::TriangleMesh(WeldedTriangles welded)
    : vertices_(std::move(welded.vertices)),
      triangles_(std::move(welded.triangles)),
      bounds_(welded.bounds),
      dropped_(welded.dropped) {
  turned_ = turn_strays(triangles_);
  connect();
  build_tree();
  mark_plain();
}

void TriangleMesh::connect() {
  at_vertex_begin_.assign(vertices_.size() + 1, 0);
  for (const Triangle& t : triangles_)
    for (const std::int32_t v : t) ++at_vertex_begin_[index(v) + 1];
  for (std::size_t v = 0; v < vertices_.size(); ++v) at_vertex_begin_[v + 1] += at_vertex_begin_[v];
  at_vertex_.resize(3 * triangles_.size());
  std::vector<std::size_t> next(at_vertex_begin_.begin(), at_vertex_begin_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const std::int32_t v : triangles_[t]) at_vertex_[next[index(v)]++] = static_cast<int>(t);

  face_normals_.clear();
  for (const Triangle& v : triangles_)
    face_normals_.push_back((vertices_[v[1]] - vertices_[v[0]]).cross(vertices_[v[2]] - vertices_[v[0]]).normalized());
  const std::vector<HalfEdge> edges = sorted_edges(triangles_);
  edge_kinds_.assign(triangles_.size(), {EdgeKind::open, EdgeKind::open, EdgeKind::open});
  neighbours_.assign(triangles_.size(), {-1, -1, -1});
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) {
      const HalfEdge& a = edges[i];
      const HalfEdge& b = edges[i + 1];
      const Vec3& n_a = face_normals_[a.triangle];
      const Vec3& n_b = face_normals_[b.triangle];
      // a face bends away from the other's plane: convex
      const Vec3 far_b = vertices_[triangles_[b.triangle][(b.edge + 2) % 3]] - vertices_[a.low];
      const double angle = math::atan2(n_a.cross(n_b).norm(), n_a.dot(n_b));
      const bool convex = n_a.dot(far_b) < 0;
      const EdgeKind kind = angle >= kFlat             ? (convex ? EdgeKind::convex : EdgeKind::concave)
                            : convex && angle > kLevel ? EdgeKind::slight
                                                       : EdgeKind::flat;
      edge_kinds_[a.triangle][a.edge] = edge_kinds_[b.triangle][b.edge] = kind;
      neighbours_[a.triangle][a.edge] = b.triangle;
      neighbours_[b.triangle][b.edge] = a.triangle;
    }
    i = end;  // an edge of three or more triangles stays open: each may be felt there
  }
}

void TriangleMesh::build_tree() {
  const int n = static_cast<int>(triangles_.size());
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centre(n);
  for (int t = 0; t < n; ++t)
    centre[t] = (vertices_[triangles_[t][0]] + vertices_[triangles_[t][1]] + vertices_[triangles_[t][2]]) / 3;
  auto box_of = [&](int first, int count) {
    Aabb box;
    for (int i = first; i < first + count; ++i)
      for (const int v : triangles_[order_[i]]) {
        box.lower = box.lower.cwiseMin(vertices_[v]);
        box.upper = box.upper.cwiseMax(vertices_[v]);
      }
    return box;
  };
  nodes_.clear();
  if (n == 0) return;
  nodes_.push_back({.box = bounds_, .first = 0, .count = n});
  for (std::size_t at = 0; at < nodes_.size(); ++at) {
    const int first = nodes_[at].first, count = nodes_[at].count;
    if (count <= kLeaf) continue;
    int axis = 0;
    (nodes_[at].box.upper - nodes_[at].box.lower).maxCoeff(&axis);
    const int half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](int a, int b) { return centre[a][axis] != centre[b][axis] ? centre[a][axis] < centre[b][axis] : a < b; });
    nodes_[at].first = static_cast<std::int32_t>(nodes_.size());
    nodes_[at].count = 0;
    nodes_.push_back({.box = box_of(first, half), .first = first, .count = half});
    nodes_.push_back({.box = box_of(first + half, count - half), .first = first + half, .count = count - half});
  }
}

void TriangleMesh::mark_plain() {
  constexpr double kSame = 1e-9;  // [-], [m]
  std::vector<char> felt_vertex(vertices_.size(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t e = 0; e < 3; ++e)
      if (felt(edge_kinds_[t][e])) felt_vertex[triangles_[t][e]] = felt_vertex[triangles_[t][(e + 1) % 3]] = 1;
  auto agree = [&](const Node& a, const Node& b) {
    return (a.normal - b.normal).norm() < kSame && std::abs(a.offset - b.offset) < kSame;
  };
  // children stand behind their parents
  for (std::size_t at = nodes_.size(); at-- > 0;) {
    Node& node = nodes_[at];
    if (node.count == 0) {
      const Node &left = nodes_[index(node.first)], &right = nodes_[index(node.first) + 1];
      node.plain = left.plain && right.plain && agree(left, right);
      node.normal = left.normal;
      node.offset = left.offset;
      continue;
    }
    node.plain = true;
    for (int i = node.first; i < node.first + node.count && node.plain; ++i) {
      const int t = order_[index(i)];
      Node own;
      own.normal = face_normals_[index(t)];
      own.offset = own.normal.dot(vertices_[triangles_[index(t)][0]]);
      if (i == node.first) node.normal = own.normal, node.offset = own.offset;
      node.plain = agree(node, own);
      for (const std::int32_t v : triangles_[index(t)]) node.plain = node.plain && !felt_vertex[v];
    }
  }
}

bool TriangleMesh::raycast(const Vec3& origin, const Vec3& direction, double s_max, double& s, int& triangle) const {
  if (nodes_.empty()) return false;
  double best = s_max;
  triangle = -1;
  auto enters = [&](const Aabb& box) {
    double low = 0, high = best;
    for (int i = 0; i < 3; ++i) {
      if (direction[i] == 0) {
        if (origin[i] < box.lower[i] || origin[i] > box.upper[i]) return false;
        continue;
      }
      const double a = (box.lower[i] - origin[i]) / direction[i], b = (box.upper[i] - origin[i]) / direction[i];
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    return low <= high;
  };
  std::array<int, 64> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    if (!enters(node.box)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const Triangle& t = triangles_[order_[i]];
      // Moeller-Trumbore, both faces
      const Vec3 e1 = vertices_[t[1]] - vertices_[t[0]], e2 = vertices_[t[2]] - vertices_[t[0]];
      const Vec3 p = direction.cross(e2);
      const double det = e1.dot(p);
      if (std::abs(det) < 1e-300) continue;
      const Vec3 r = origin - vertices_[t[0]];
      const double u = r.dot(p) / det;
      const Vec3 q = r.cross(e1);
      const double v = direction.dot(q) / det, hit = e2.dot(q) / det;
      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9 || hit < 0 || hit > best) continue;
      best = hit;
      triangle = order_[i];
    }
  }
  s = best;
  return triangle >= 0;
}

}  // namespace engine
