// Surface nets (S. Gibson, 1998): a vertex in each cell of a grid the surface passes through, a quadrilateral across each edge of
// the grid it cuts; then the vertices are moved onto the surface and triangles between two cloths are cut where they meet.
#include "render/surface/skin.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "render/surface/skin_field.h"

namespace render {
namespace {

constexpr double kCell = 0.014;   // [m] of the grid: about five thousand cells on a person, a neck 8 cells across
constexpr double kReach = 0.045;  // [m] a segment this much farther than the nearest one has no say

using Triangle = std::array<std::uint32_t, 3>;

struct Net {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

class Grid {
 public:
  explicit Grid(const SkinField& field) {
    Vec3 upper;
    field.bounds(origin_, upper);
    for (int i = 0; i < 3; ++i) n_[i] = static_cast<int>(std::ceil((upper[i] - origin_[i]) / kCell)) + 2;
    values_.resize(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(n_[2]));
    std::vector<double> distances;
    for (int k = 0; k < n_[2]; ++k)
      for (int j = 0; j < n_[1]; ++j)
        for (int i = 0; i < n_[0]; ++i) values_[index({i, j, k})] = field.at(place({i, j, k}), distances);
  }
  using Node = std::array<int, 3>;
  std::size_t index(const Node& a) const {
    return (static_cast<std::size_t>(a[2]) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(a[1])) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(a[0]);
  }
  Vec3 place(const Node& a) const { return origin_ + kCell * Vec3(a[0], a[1], a[2]); }
  double value(const Node& a) const { return values_[index(a)]; }
  int size(int axis) const { return n_[static_cast<std::size_t>(axis)]; }

 private:
  Vec3 origin_;
  std::array<int, 3> n_{};
  std::vector<double> values_;
};

/// Mean of the places where the surface cuts the edges of the cell at a, if it does.
bool cell_vertex(const Grid& grid, const Grid::Node& a, Vec3& out) {
  Vec3 sum = Vec3::Zero();
  int cuts = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 4; ++side) {
      Grid::Node p = a, q;
      p[static_cast<std::size_t>((axis + 1) % 3)] += side & 1;
      p[static_cast<std::size_t>((axis + 2) % 3)] += side >> 1;
      q = p;
      ++q[static_cast<std::size_t>(axis)];
      const double u = grid.value(p), v = grid.value(q);
      if ((u < 0) == (v < 0)) continue;
      sum += grid.place(p) + u / (u - v) * (grid.place(q) - grid.place(p));
      ++cuts;
    }
  if (cuts > 0) out = sum / cuts;
  return cuts > 0;
}

Net surface_net(const SkinField& field) {
  const Grid grid(field);
  Net net;
  std::map<std::size_t, std::uint32_t> known;
  auto vertex = [&](const Grid::Node& cell) {
    const auto [at, fresh] = known.emplace(grid.index(cell), static_cast<std::uint32_t>(net.vertices.size()));
    if (fresh) {
      Vec3 p = Vec3::Zero();
      cell_vertex(grid, cell, p);
      net.vertices.push_back(field.onto_surface(p));
    }
    return at->second;
  };
  for (int k = 1; k + 1 < grid.size(2); ++k)
    for (int j = 1; j + 1 < grid.size(1); ++j)
      for (int i = 1; i + 1 < grid.size(0); ++i)
        for (int axis = 0; axis < 3; ++axis) {
          const Grid::Node p{i, j, k};
          Grid::Node q = p;
          ++q[static_cast<std::size_t>(axis)];
          const bool from_inside = grid.value(p) < 0;
          if (from_inside == (grid.value(q) < 0)) continue;
          std::array<std::uint32_t, 4> corner{};
          constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
          for (std::size_t c = 0; c < 4; ++c) {
            Grid::Node cell = p;
            cell[static_cast<std::size_t>((axis + 1) % 3)] += kAround[c][0];
            cell[static_cast<std::size_t>((axis + 2) % 3)] += kAround[c][1];
            corner[c] = vertex(cell);
          }
          if (!from_inside) std::swap(corner[1], corner[3]);
          net.triangles.push_back({corner[0], corner[1], corner[2]});
          net.triangles.push_back({corner[0], corner[2], corner[3]});
        }
  return net;
}

/// Which material covers a vertex, and how far each material's nearest segment is.
class Wardrobe {
 public:
  Wardrobe(const PersonActor& person, const SkinField& field) : field_(field) {
    for (const PersonActor::Segment& s : person.segments) {
      const auto at = std::find_if(materials_.begin(), materials_.end(), [&](const Material& m) {
        return m.kind == s.material.kind && m.colour == s.material.colour && m.roughness == s.material.roughness;
      });
      of_segment_.push_back(static_cast<int>(at - materials_.begin()));
      if (at == materials_.end()) materials_.push_back(s.material);
    }
    for (std::size_t i = 0; i < person.segments.size(); ++i)
      if (person.segments[i].name.ends_with("head") && person.segments[i].material.kind == MaterialKind::skin) head_ = i;
    if (!head_) return;
    head_axes_ = person.segments[*head_].shape.semi_axes;
    Material hair;
    hair.name = "hair";
    hair.kind = MaterialKind::cloth;
    hair.colour = {0.035f, 0.022f, 0.014f};
    materials_.push_back(hair);
  }
  std::vector<double> distances(const Vec3& x) const {
    std::vector<double> each, out(materials_.size(), 1e9);
    field_.at(x, each);
    for (std::size_t i = 0; i < each.size(); ++i) {
      double& d = out[static_cast<std::size_t>(of_segment_[i])];
      d = std::min(d, each[i]);
    }
    if (head_) out.back() = each[*head_] - hair(field_.poses()[*head_].inverse() * x);
    return out;
  }
  const std::vector<Material>& materials() const { return materials_; }

 private:
  /// [m] grows from the hairline into the hair, which is high over the face and low at the neck. x in the head's axes: x forward, z
  /// up.
  double hair(const Vec3& x) const {
    constexpr double kHairline = 0.08, kRise = 0.62;  // [-] of the head's height over its middle; from back to front
    return x.z() - head_axes_.z() * (kHairline + kRise * x.x() / head_axes_.x());
  }

  const SkinField& field_;
  std::vector<Material> materials_;
  std::vector<int> of_segment_;
  std::optional<std::size_t> head_;
  Vec3 head_axes_ = Vec3::Ones();
};

/// Triangles by material; those between two are cut where both are equally near.
std::vector<std::vector<Triangle>> dressed(Net& net, const Wardrobe& wardrobe, const SkinField& field) {
  std::vector<std::vector<double>> distances;
  std::vector<std::size_t> wears;
  auto look_up = [&](const Vec3& x) {
    distances.push_back(wardrobe.distances(x));
    const auto& d = distances.back();
    wears.push_back(static_cast<std::size_t>(std::min_element(d.begin(), d.end()) - d.begin()));
  };
  for (const Vec3& x : net.vertices) look_up(x);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> cuts;
  auto cut = [&](std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [at, fresh] = cuts.emplace(std::array{a, b}, static_cast<std::uint32_t>(net.vertices.size()));
    if (fresh) {
      const double u = distances[a][wears[b]] - distances[a][wears[a]], v = distances[b][wears[a]] - distances[b][wears[b]];
      const double s = u + v > 0 ? std::clamp(u / (u + v), 0.1, 0.9) : 0.5;
      net.vertices.push_back(field.onto_surface(net.vertices[a] + s * (net.vertices[b] - net.vertices[a])));
      look_up(net.vertices.back());
    }
    return at->second;
  };
  std::vector<std::vector<Triangle>> out(wardrobe.materials().size());
  for (Triangle t : net.triangles) {
    // turn it until the odd one comes first
    for (int turn = 0; turn < 2 && wears[t[1]] != wears[t[2]]; ++turn) std::rotate(t.begin(), t.begin() + 1, t.end());
    const auto [a, b, c] = t;
    if (wears[a] == wears[b] && wears[b] == wears[c]) {
      out[wears[a]].push_back(t);
    } else if (wears[b] == wears[c]) {
      const std::uint32_t ab = cut(a, b), ca = cut(c, a);
      out[wears[a]].push_back({a, ab, ca});
      out[wears[b]].push_back({ab, b, c});
      out[wears[b]].push_back({ab, c, ca});
    } else {
      const std::uint32_t ab = cut(a, b), bc = cut(b, c), ca = cut(c, a);
      out[wears[a]].push_back({a, ab, ca});
      out[wears[b]].push_back({b, bc, ab});
      out[wears[c]].push_back({c, ca, bc});
      out[wears[a]].push_back({ab, bc, ca});
    }
  }
  return out;
}

/// The nearest segment and those that hang on it, by how near they are.
std::array<Skin::Weight, Skin::kWeights> weights_at(const SkinField& field, const Vec3& x) {
  std::vector<double> distances;
  field.at(x, distances);
  const std::size_t nearest = static_cast<std::size_t>(std::min_element(distances.begin(), distances.end()) - distances.begin());
  std::vector<Skin::Weight> all;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool neighbour =
        i == nearest || field.parent(i) == static_cast<int>(nearest) || field.parent(nearest) == static_cast<int>(i);
    const double near = 1 - (distances[i] - distances[nearest]) / kReach;
    if (neighbour && near > 0) all.push_back({static_cast<int>(i), static_cast<float>(near * near * (3 - 2 * near))});
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  std::array<Skin::Weight, Skin::kWeights> out{};
  float sum = 0;
  for (std::size_t i = 0; i < std::min(all.size(), out.size()); ++i) {
    out[i] = all[i];
    sum += all[i].share;
  }
  for (Skin::Weight& w : out) w.share /= sum;
  return out;
}

void push(std::vector<float>& to, const Vec3& v) {
  for (int i = 0; i < 3; ++i) to.push_back(static_cast<float>(v[i]));
}

}  // namespace

std::shared_ptr<const Skin> build_skin(const PersonActor& person) {
  const SkinField field(person);
  const Wardrobe wardrobe(person, field);
  Net net = surface_net(field);
  auto mesh = std::make_shared<Mesh>();
  mesh->materials = wardrobe.materials();
  const auto by_material = dressed(net, wardrobe, field);
  for (std::size_t m = 0; m < by_material.size(); ++m) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh->indices.size());
    for (const Triangle& t : by_material[m]) mesh->indices.insert(mesh->indices.end(), t.begin(), t.end());
    mesh->parts.push_back({first, static_cast<std::uint32_t>(mesh->indices.size()) - first, static_cast<int>(m)});
  }
  auto skin = std::make_shared<Skin>();
  for (const Vec3& x : net.vertices) {
    push(mesh->positions, x);
    push(mesh->normals, field.normal(x));
    skin->weights.push_back(weights_at(field, x));
  }
  for (const Pose& X_MS : field.poses()) skin->X_SM.push_back(X_MS.inverse());
  skin->mesh = mesh;
  return skin;
}

void bend_skin(const Skin& skin, std::span<const Pose> X_WS, std::vector<float>& positions, std::vector<float>& normals) {
  struct Motion {
    engine::Quat real, dual;
  };
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < skin.X_SM.size(); ++i) {
    const Pose X = X_WS[i] * skin.X_SM[i];
    const engine::Quat t(0, X.p.x(), X.p.y(), X.p.z());
    engine::Quat dual = t * X.q;
    dual.coeffs() *= 0.5;
    motions.push_back({X.q, dual});
  }
  const Mesh& mesh = *skin.mesh;
  positions.resize(mesh.positions.size());
  normals.resize(mesh.normals.size());
  for (std::size_t v = 0; v < skin.weights.size(); ++v) {
    const auto& weights = skin.weights[v];
    Eigen::Vector4d real = Eigen::Vector4d::Zero(), dual = Eigen::Vector4d::Zero();
    const Eigen::Vector4d lead = motions[static_cast<std::size_t>(weights[0].segment)].real.coeffs();
    for (const Skin::Weight& w : weights) {
      if (w.share == 0) continue;
      const Motion& m = motions[static_cast<std::size_t>(w.segment)];
      // a rotation is two quaternions: blend those on one side
      const double share = static_cast<double>(w.share) * (lead.dot(m.real.coeffs()) < 0 ? -1 : 1);
      real += share * m.real.coeffs();
      dual += share * m.dual.coeffs();
    }
    const double length = real.norm();
    const engine::Quat q(Eigen::Vector4d(real / length)), d(Eigen::Vector4d(dual / length));
    const Vec3 shift = 2 * (d * q.conjugate()).vec();
    const Vec3 p(mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]);
    const Vec3 n(mesh.normals[3 * v], mesh.normals[3 * v + 1], mesh.normals[3 * v + 2]);
    const Vec3 p_W = q * p + shift, n_W = q * n;
    for (int i = 0; i < 3; ++i) {
      positions[3 * v + static_cast<std::size_t>(i)] = static_cast<float>(p_W[i]);
      normals[3 * v + static_cast<std::size_t>(i)] = static_cast<float>(n_W[i]);
    }
  }
}

}  // namespace render
