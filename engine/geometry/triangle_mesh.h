// A triangle mesh for contact: welded vertices, what its edges are, and a tree of bounding boxes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/math/types.h"

namespace engine {

using Triangle = std::array<std::int32_t, 3>;

struct Aabb {
  Vec3 lower = Vec3::Constant(1e300);
  Vec3 upper = Vec3::Constant(-1e300);
};

/// Whether contact normals may leave the face at this edge: a convex edge may, a flat or concave one must not be felt. slight:
/// convex, but by so little that flat sides pass over it.
enum class EdgeKind : std::uint8_t { flat, slight, convex, concave, open };

inline bool felt(EdgeKind kind) {
  return kind == EdgeKind::convex || kind == EdgeKind::open;
}

/// The point by which a round body reaches farthest goes from face to face with the normal, by its radius of curvature times the
/// angle, however slight: where it is over neither face only the edge between them is met.
inline bool felt_by_round(EdgeKind kind) {
  return felt(kind) || kind == EdgeKind::slight;
}

/// What a mesh for contact is built of: vertices closer than 1e-5 m welded, degenerate (area/edge^2 < 1e-12) and duplicate
/// triangles dropped.
struct WeldedTriangles {
  /// Indices out of range assert; the loader has audited them.
  WeldedTriangles(std::vector<Vec3> vertices, const std::vector<Triangle>& triangles);

  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  Aabb bounds;      // [m] of the triangles
  int dropped = 0;  // triangles
};

/// Immutable after construction. Triangles are counter-clockwise seen from outside.
class TriangleMesh {
 public:
  /// Turns over single triangles that face against the rest of their piece, builds adjacency and the tree.
  explicit TriangleMesh(WeldedTriangles);
  TriangleMesh(std::vector<Vec3> vertices, const std::vector<Triangle>& triangles)
      : TriangleMesh(WeldedTriangles(std::move(vertices), triangles)) {}

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Vec3>& face_normals() const { return face_normals_; }
  /// Edge i of triangle t runs from vertex i to vertex (i+1)%3.
  EdgeKind edge_kind(int triangle, int edge) const { return edge_kinds_[index(triangle)][index(edge)]; }
  /// Triangle on the other side of that edge, or -1.
  int neighbour(int triangle, int edge) const { return neighbours_[index(triangle)][index(edge)]; }
  /// Triangles that share this vertex.
  std::span<const int> triangles_at(int vertex) const {
    const auto first = at_vertex_begin_[index(vertex)];
    return {at_vertex_.data() + first, at_vertex_begin_[index(vertex) + 1] - first};
  }
  const Aabb& bounds() const { return bounds_; }
  int dropped_triangles() const { return dropped_; }
  int turned_triangles() const { return turned_; }

  /// Appends to `out` the triangles whose boxes overlap `box` (mesh frame), in a fixed order. Returns nodes visited.
  int query(const Aabb& box, std::vector<int>& out) const {
    return query(box, out, [](const Vec3&, double, const Aabb&) { return false; });
  }

  /// The same, but leaves out whole branches in the middle of flat panels, where no edge and no corner is felt, if
  /// pass(normal, offset, box of the branch) says so: normal.x = offset on it.
  template <class Pass>
  int query(const Aabb& box, std::vector<int>& out, const Pass& pass) const {
    if (nodes_.empty()) return 0;
    std::array<int, 64> stack;
    int depth = 0, visited = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[index(stack[--depth])];
      ++visited;
      if ((node.box.lower.array() > box.upper.array()).any() || (node.box.upper.array() < box.lower.array()).any()) continue;
      if (node.plain && pass(node.normal, node.offset, node.box)) continue;
      if (node.count == 0) {
        stack[depth++] = node.first + 1;
        stack[depth++] = node.first;
        continue;
      }
      for (int i = node.first; i < node.first + node.count; ++i) out.push_back(order_[index(i)]);
    }
    return visited;
  }

  /// Nearest hit of the ray origin + s * direction, 0 <= s <= s_max: true, with s and the triangle. For wheels and cameras.
  bool raycast(const Vec3& origin, const Vec3& direction, double s_max, double& s, int& triangle) const;

 private:
  struct Node {
    Aabb box;
    std::int32_t first = 0;  // leaf: first triangle in order_; inner: left child
    std::int32_t count = 0;  // leaf: triangles; inner: 0 (right child is first + 1)
    bool plain = false;      // all its triangles lie in one plane, and nothing of them is felt but their faces
    double offset = 0;       // [m] of that plane along
    Vec3 normal = Vec3::Zero();
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void connect();     // adjacency and edge kinds
  void build_tree();  // median splits along the longest side
  void mark_plain();  // nodes in the middle of panels

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3> face_normals_;
  std::vector<std::array<EdgeKind, 3>> edge_kinds_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<int> at_vertex_;  // triangles by vertex, from at_vertex_begin_[v] on
  std::vector<std::size_t> at_vertex_begin_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
  Aabb bounds_;
  int dropped_ = 0, turned_ = 0;
};

}  // namespace engine
