// Surface nets (S. Gibson, 1998): a vertex in each cell of a grid the surface passes through, a quadrilateral across each edge of
// the grid it cuts; then the vertices are moved onto the surface and triangles between two cloths are cut where they meet.
#include "render/surface/skin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "render/parallel.h"
#include "render/surface/skin_field.h"

namespace render {
namespace {

constexpr double kCells = 160;    // over the height of a person: 11 mm, about eight thousand on the surface, a neck 10 across
constexpr double kReach = 0.045;  // [m] a segment this much farther than the nearest one has no say

using Triangle = std::array<std::uint32_t, 3>;

struct Net {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/// The field at the nodes of the cells that the surface passes through, found by following it from cell to cell: a twelfth of all
/// nodes. A hollow inside a body, which nobody sees, is left out.
class Grid {
 public:
  using Node = std::array<int, 3>;

  explicit Grid(const SkinField& field) : field_(field) {
    Vec3 upper;
    field.bounds(origin_, upper);
    cell_ = (upper.z() - origin_.z()) / kCells;
    for (int i = 0; i < 3; ++i) n_[i] = static_cast<int>(std::ceil((upper[i] - origin_[i]) / cell_)) + 2;
    values_.assign(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1]) * static_cast<std::size_t>(n_[2]), kUnknown);
    for (const Pose& X_MS : field.poses()) follow_surface(from_inside(X_MS.p));
  }
  std::size_t index(const Node& a) const {
    return (static_cast<std::size_t>(a[2]) * static_cast<std::size_t>(n_[1]) + static_cast<std::size_t>(a[1])) *
               static_cast<std::size_t>(n_[0]) +
           static_cast<std::size_t>(a[0]);
  }
  Vec3 place(const Node& a) const { return origin_ + cell_ * Vec3(a[0], a[1], a[2]); }
  bool known(const Node& a) const { return !std::isnan(value(a)); }
  bool inside(const Node& a) const { return value(a) < 0; }
  double value(const Node& a) const { return values_[index(a)]; }
  bool cut(const Node& a, const Node& b) const { return known(a) && known(b) && inside(a) != inside(b); }
  int size(int axis) const { return n_[static_cast<std::size_t>(axis)]; }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double find(const Node& a) {
    double& out = values_[index(a)];
    if (std::isnan(out)) out = field_.at(place(a), distances_);
    return out;
  }

  /// The first cell along x from a point that the surface passes through; none where the point's node is outside.
  std::optional<Node> from_inside(const Vec3& x) {
    Node a;
    for (int i = 0; i < 3; ++i) a[static_cast<std::size_t>(i)] = static_cast<int>((x[i] - origin_[i]) / cell_);
    if (find(a) >= 0) return {};
    for (; a[0] + 1 < n_[0]; ++a[0])
      if (find({a[0] + 1, a[1], a[2]}) >= 0) return a;
    return {};
  }

  void follow_surface(std::optional<Node> first) {
    std::vector<Node> cells;
    const auto reach = [&](const Node& cell) {
      if (reached_.insert(index(cell)).second) cells.push_back(cell);
    };
    if (first) reach(*first);
    while (!cells.empty()) {
      const Node cell = cells.back();
      cells.pop_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
          int within = 0;
          for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
            Node corner = cell;
            corner[axis] += side;
            corner[(axis + 1) % 3] += u;
            corner[(axis + 2) % 3] += v;
            within += find(corner) < 0;
          }
          Node next = cell;
          next[axis] += 2 * side - 1;
          if (within > 0 && within < 4 && next[axis] >= 0 && next[axis] + 1 < n_[axis]) reach(next);
        }
    }
  }

  const SkinField& field_;
  Vec3 origin_;
  double cell_ = 0;  // [m]
  std::array<int, 3> n_{};
  std::vector<double> values_;
  std::unordered_set<std::size_t> reached_;  // cells, by their lowest node
  std::vector<double> distances_;            // scratch
};

/// The sheets of the surface that pass through one cell: two where a hand nearly touches itself. A vertex stands for each, or the
/// sheets would hang together by it.
struct Sheets {
  int count = 0;
  std::array<int, 12> of_edge{};  // edge of the cell: 4 axis + side; -1 where the surface does not cut it
  std::array<Vec3, 4> place{};    // [m] mean of the cuts
  std::array<std::uint32_t, 4> vertex{};
};

std::size_t edge_of_cell(int axis, int first, int second) {  // `first` along the axis after it, `second` along the one after that
  return static_cast<std::size_t>(4 * axis + first + 2 * second);
}

/// Cut edges of a face hang together; where all four are cut, those round each corner that lies inside: what two cells share they
/// see alike.
void join_across_face(const Grid& grid, const Grid::Node& a, int normal, int at, std::array<int, 12>& leader) {
  const int u = (normal + 1) % 3, v = (normal + 2) % 3;
  auto root = [&](std::size_t e) {
    while (leader[e] != static_cast<int>(e)) e = static_cast<std::size_t>(leader[e]);
    return e;
  };
  auto along_u = [&](int w) { return edge_of_cell(u, w, at); };  // the axes after u: v, normal
  auto along_v = [&](int w) { return edge_of_cell(v, at, w); };  // the axes after v: normal, u
  auto inside = [&](int on_u, int on_v) {
    Grid::Node p = a;
    p[static_cast<std::size_t>(normal)] += at;
    p[static_cast<std::size_t>(u)] += on_u;
    p[static_cast<std::size_t>(v)] += on_v;
    return grid.inside(p);
  };
  const std::array<std::size_t, 4> edges{along_u(0), along_u(1), along_v(0), along_v(1)};
  const auto cut = std::count_if(edges.begin(), edges.end(), [&](std::size_t e) { return leader[e] >= 0; });
  if (cut == 2) {
    std::optional<std::size_t> first;
    for (const std::size_t e : edges) {
      if (leader[e] < 0) continue;
      if (first) leader[root(e)] = static_cast<int>(root(*first));
      first = e;
    }
  } else if (cut == 4) {
    for (const int on_u : {0, 1})
      for (const int on_v : {0, 1})
        if (inside(on_u, on_v)) leader[root(along_u(on_v))] = static_cast<int>(root(along_v(on_u)));
  }
}

Sheets sheets_of(const Grid& grid, const Grid::Node& a) {
  std::array<int, 12> leader{};
  std::array<Vec3, 12> place{};
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 4; ++side) {
      Grid::Node p = a, q;
      p[static_cast<std::size_t>((axis + 1) % 3)] += side & 1;
      p[static_cast<std::size_t>((axis + 2) % 3)] += side >> 1;
      q = p;
      ++q[static_cast<std::size_t>(axis)];
      const double u = grid.value(p), v = grid.value(q);
      const std::size_t e = edge_of_cell(axis, side & 1, side >> 1);
      const bool cut = grid.cut(p, q);
      leader[e] = cut ? static_cast<int>(e) : -1;
      if (cut) place[e] = grid.place(p) + u / (u - v) * (grid.place(q) - grid.place(p));
    }
  for (int normal = 0; normal < 3; ++normal)
    for (const int at : {0, 1}) join_across_face(grid, a, normal, at, leader);
  Sheets out;
  std::array<int, 4> cuts{};
  for (std::size_t e = 0; e < 12; ++e) {
    out.of_edge[e] = -1;
    if (leader[e] == static_cast<int>(e)) out.of_edge[e] = out.count++;
  }
  for (std::size_t e = 0; e < 12; ++e) {
    if (leader[e] < 0) continue;
    std::size_t top = e;
    while (leader[top] != static_cast<int>(top)) top = static_cast<std::size_t>(leader[top]);
    out.of_edge[e] = out.of_edge[top];
    const std::size_t sheet = static_cast<std::size_t>(out.of_edge[e]);
    out.place[sheet] = cuts[sheet]++ == 0 ? place[e] : Vec3(out.place[sheet] + place[e]);
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(out.count); ++k) out.place[k] /= cuts[k];
  return out;
}

/// Calls each(i) for each i below `count`, some hundreds at a time.
template <class Each>
void in_slices(std::size_t count, Each each) {
  constexpr std::size_t kSlice = 256;
  in_parallel((count + kSlice - 1) / kSlice, [&](std::size_t s) {
    for (std::size_t i = s * kSlice; i < std::min(count, (s + 1) * kSlice); ++i) each(i);
  });
}

Net surface_net(const SkinField& field) {
  const Grid grid(field);
  Net net;
  std::unordered_map<std::size_t, Sheets> known;
  auto vertex = [&](const Grid::Node& cell, std::size_t edge) {
    const auto [at, fresh] = known.try_emplace(grid.index(cell));
    Sheets& sheets = at->second;
    if (fresh) {
      sheets = sheets_of(grid, cell);
      for (std::size_t i = 0; i < static_cast<std::size_t>(sheets.count); ++i) {
        sheets.vertex[i] = static_cast<std::uint32_t>(net.vertices.size());
        net.vertices.push_back(sheets.place[i]);
      }
    }
    return sheets.vertex[static_cast<std::size_t>(sheets.of_edge[edge])];
  };
  for (int k = 1; k + 1 < grid.size(2); ++k)
    for (int j = 1; j + 1 < grid.size(1); ++j)
      for (int i = 1; i + 1 < grid.size(0); ++i) {
        const Grid::Node p{i, j, k};
        if (!grid.known(p)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          Grid::Node q = p;
          ++q[static_cast<std::size_t>(axis)];
          if (!grid.cut(p, q)) continue;
          std::array<std::uint32_t, 4> corner{};
          constexpr std::array<std::array<int, 2>, 4> kCellsAround{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
          for (std::size_t c = 0; c < 4; ++c) {
            Grid::Node cell = p;
            cell[static_cast<std::size_t>((axis + 1) % 3)] += kCellsAround[c][0];
            cell[static_cast<std::size_t>((axis + 2) % 3)] += kCellsAround[c][1];
            corner[c] = vertex(cell, edge_of_cell(axis, -kCellsAround[c][0], -kCellsAround[c][1]));
          }
          if (!grid.inside(p)) std::swap(corner[1], corner[3]);
          net.triangles.push_back({corner[0], corner[1], corner[2]});
          net.triangles.push_back({corner[0], corner[2], corner[3]});
        }
      }
  in_slices(net.vertices.size(), [&](std::size_t v) { net.vertices[v] = field.onto_surface(net.vertices[v]); });
  return net;
}

/// Halves each edge between two of these vertices.
void halve_edges(const std::vector<bool>& of, const SkinField& field, Net& net) {
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto next = static_cast<std::uint32_t>(net.vertices.size());
    const auto [at, fresh] = middles.emplace(std::array{std::min(a, b), std::max(a, b)}, next);
    if (fresh) net.vertices.push_back(0.5 * (net.vertices[a] + net.vertices[b]));
    return at->second;
  };
  const std::size_t before = net.vertices.size();
  std::vector<Triangle> out;
  for (Triangle t : net.triangles) {
    const auto halved = [&](std::size_t k) { return of[t[k]] && of[t[(k + 1) % 3]]; };
    if (halved(0) && halved(1)) {  // then the third too
      const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      for (const Triangle& part : {Triangle{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}}) out.push_back(part);
      continue;
    }
    for (int turn = 0; turn < 2 && !halved(0); ++turn) std::rotate(t.begin(), t.begin() + 1, t.end());
    if (halved(0)) {
      const std::uint32_t ab = middle(t[0], t[1]);
      out.push_back({t[0], ab, t[2]});
      t[0] = ab;
    }
    out.push_back(t);
  }
  net.triangles = std::move(out);
  in_slices(net.vertices.size() - before, [&](std::size_t i) {
    Vec3& vertex = net.vertices[before + i];
    vertex = field.onto_surface(vertex);
  });
}

/// A cell of the grid is as wide as a lip: finer over the head's front half, and once more over its foremost part.
void refine_face(const PersonActor& person, const SkinField& field, Net& net) {
  std::vector<double> distances;
  for (std::size_t head = 0; head < person.segments.size(); ++head) {
    if (!person.segments[head].name.ends_with("head")) continue;
    const Pose X_SM = field.poses()[head].inverse();
    for (const double from : {-0.3, 0.5}) {  // of its half length, forward
      std::vector<bool> on_face(net.vertices.size());
      for (std::size_t v = 0; v < on_face.size(); ++v) {
        if ((X_SM * net.vertices[v]).x() < from * person.segments[head].shape.semi_axes.x()) continue;
        field.at(net.vertices[v], distances);
        on_face[v] = *std::min_element(distances.begin(), distances.end()) == distances[head];
      }
      halve_edges(on_face, field, net);
    }
  }
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
    if (head_) out.back() = each[*head_] - beyond_hairline(field_.poses()[*head_].inverse() * x, head_axes_);
    return out;
  }
  const std::vector<Material>& materials() const { return materials_; }

 private:
  const SkinField& field_;
  std::vector<Material> materials_;
  std::vector<int> of_segment_;
  std::optional<std::size_t> head_;
  Vec3 head_axes_ = Vec3::Ones();
};

/// Triangles by material; those between two are cut where both are equally near.
std::vector<std::vector<Triangle>> dressed(Net& net, const Wardrobe& wardrobe, const SkinField& field) {
  std::vector<std::vector<double>> distances(net.vertices.size());
  std::vector<std::size_t> wears(net.vertices.size());
  const auto look_up = [&](std::size_t v) {
    distances[v] = wardrobe.distances(net.vertices[v]);
    wears[v] = static_cast<std::size_t>(std::min_element(distances[v].begin(), distances[v].end()) - distances[v].begin());
  };
  in_slices(net.vertices.size(), look_up);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> cuts;
  auto cut = [&](std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [at, fresh] = cuts.emplace(std::array{a, b}, static_cast<std::uint32_t>(net.vertices.size()));
    if (fresh) {
      const double u = distances[a][wears[b]] - distances[a][wears[a]], v = distances[b][wears[a]] - distances[b][wears[b]];
      const double s = u + v > 0 ? std::clamp(u / (u + v), 0.1, 0.9) : 0.5;
      net.vertices.push_back(field.onto_surface(net.vertices[a] + s * (net.vertices[b] - net.vertices[a])));
      distances.emplace_back();
      wears.emplace_back();
      look_up(net.vertices.size() - 1);
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

/// Is `ancestor` the segment itself, what it hangs on, or what that hangs on? So far a short neck between torso and head shares.
bool hangs_on(const SkinField& field, std::size_t segment, std::size_t ancestor) {
  int at = static_cast<int>(segment);
  for (int up = 0; up < 3 && at >= 0; ++up, at = field.parent(static_cast<std::size_t>(at)))
    if (at == static_cast<int>(ancestor)) return true;
  return false;
}

/// The nearest segment and those it hangs on or that hang on it, by how near they are.
std::array<Skin::Weight, Skin::kWeights> weights_at(const SkinField& field, const Vec3& x) {
  std::vector<double> distances;
  field.at(x, distances);
  const std::size_t nearest = static_cast<std::size_t>(std::min_element(distances.begin(), distances.end()) - distances.begin());
  std::vector<Skin::Weight> all;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool neighbour = hangs_on(field, i, nearest) || hangs_on(field, nearest, i);
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

void put(const Vec3& v, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(v[i]);
}

}  // namespace

const std::shared_ptr<const Skin>& PersonActor::skin() const {
  if (!*built_skin) *built_skin = build_skin(*this);
  return *built_skin;
}

std::shared_ptr<const Skin> build_skin(const PersonActor& person) {
  const SkinField field(person);
  const Wardrobe wardrobe(person, field);
  Net net = surface_net(field);
  refine_face(person, field, net);
  auto mesh = std::make_shared<Mesh>();
  mesh->materials = wardrobe.materials();
  const auto by_material = dressed(net, wardrobe, field);
  for (std::size_t m = 0; m < by_material.size(); ++m) {
    const std::uint32_t first = static_cast<std::uint32_t>(mesh->indices.size());
    for (const Triangle& t : by_material[m]) mesh->indices.insert(mesh->indices.end(), t.begin(), t.end());
    mesh->parts.push_back({first, static_cast<std::uint32_t>(mesh->indices.size()) - first, static_cast<int>(m)});
  }
  auto skin = std::make_shared<Skin>();
  mesh->positions.resize(3 * net.vertices.size());
  mesh->normals.resize(3 * net.vertices.size());
  skin->weights.resize(net.vertices.size());
  in_slices(net.vertices.size(), [&](std::size_t v) {
    const Vec3& x = net.vertices[v];
    put(x, &mesh->positions[3 * v]);
    put(field.normal(x), &mesh->normals[3 * v]);
    skin->weights[v] = weights_at(field, x);
  });
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
