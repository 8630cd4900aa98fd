#include "assets/generate/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

namespace assets {

V3 cross(V3 a, V3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(V3 a, V3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
V3 unit(V3 a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? (1 / length) * a : V3{0, 0, 1};
}

void Surface::add(const Vertex& a, const Vertex& b, const Vertex& c, const std::string& material) {
  const V3 area = cross(b.p - a.p, c.p - a.p);
  if (dot(area, area) < 1e-18) return;
  faces.push_back({{a, b, c}, material});
}

void Surface::quad(V3 a, V3 b, V3 c, V3 d, const std::string& material) {
  const V3 n = unit(cross(b - a, d - a));
  add({a, n}, {b, n}, {c, n}, material);
  add({a, n}, {c, n}, {d, n}, material);
}

void Surface::box(V3 m, V3 h, const std::string& material, double lean) {
  auto at = [&](double i, double j, double k) {
    const V3 q{i * h.x, j * h.y, k * h.z};
    return m + V3{q.x * std::cos(lean) + q.z * std::sin(lean), q.y, -q.x * std::sin(lean) + q.z * std::cos(lean)};
  };
  quad(at(1, -1, -1), at(1, 1, -1), at(1, 1, 1), at(1, -1, 1), material);
  quad(at(-1, 1, -1), at(-1, -1, -1), at(-1, -1, 1), at(-1, 1, 1), material);
  quad(at(1, 1, -1), at(-1, 1, -1), at(-1, 1, 1), at(1, 1, 1), material);
  quad(at(-1, -1, -1), at(1, -1, -1), at(1, -1, 1), at(-1, -1, 1), material);
  quad(at(-1, -1, 1), at(1, -1, 1), at(1, 1, 1), at(-1, 1, 1), material);
  quad(at(-1, 1, -1), at(1, 1, -1), at(1, -1, -1), at(-1, -1, -1), material);
}

void Surface::append(const Surface& other) {
  faces.insert(faces.end(), other.faces.begin(), other.faces.end());
}

void Surface::mirror_y() {
  const std::size_t count = faces.size();
  for (std::size_t i = 0; i < count; ++i) {
    Face f = faces[i];
    for (Vertex& v : f.v) v.p.y = -v.p.y, v.n.y = -v.n.y;
    std::swap(f.v[1], f.v[2]);
    faces.push_back(f);
  }
}

namespace {

using Polygon = std::vector<Vertex>;

double side_of(Seen seen, const V3& p, const std::array<double, 2>& a, const std::array<double, 2>& b) {
  const double u = seen == Seen::from_front ? p.y : p.x;
  const double v = seen == Seen::from_above ? p.y : p.z;
  return (b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0]);
}

/// Splits a polygon along the line where `side` is nought, linear between its corners: `in` keeps where it is more, `out` the rest.
template <class Side>
void split(const Polygon& whole, Side side, Polygon& in, Polygon& out) {
  in.clear();
  out.clear();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Vertex& p = whole[i];
    const Vertex& q = whole[(i + 1) % whole.size()];
    const double sp = side(p), sq = side(q);
    if (sp >= 0) in.push_back(p);
    if (sp <= 0) out.push_back(p);
    if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) {
      const double t = sp / (sp - sq);
      const Vertex m{p.p + t * (q.p - p.p), unit(p.n + t * (q.n - p.n))};
      in.push_back(m);
      out.push_back(m);
    }
  }
}

void emit(Surface& to, const Polygon& polygon, const std::string& material) {
  for (std::size_t i = 2; i < polygon.size(); ++i) to.add(polygon[0], polygon[i - 1], polygon[i], material);
}

}  // namespace

void cut(Surface& surface, Seen seen, const std::vector<std::array<double, 2>>& border, const Filter& filter,
         const std::string& material) {
  Surface result;
  for (const Face& face : surface.faces) {
    const V3 centroid = (1.0 / 3) * (face.v[0].p + face.v[1].p + face.v[2].p);
    if (!filter(centroid, unit(face.v[0].n + face.v[1].n + face.v[2].n))) {
      result.faces.push_back(face);
      continue;
    }
    Polygon inside(face.v.begin(), face.v.end()), in, out;
    std::vector<Polygon> outside;
    for (std::size_t i = 0; i < border.size() && inside.size() >= 3; ++i) {
      const auto& a = border[i];
      const auto& b = border[(i + 1) % border.size()];
      split(
          inside, [&](const Vertex& v) { return side_of(seen, v.p, a, b); }, in, out);
      if (out.size() >= 3) outside.push_back(out);
      inside = in;
    }
    if (inside.size() < 3) {
      result.faces.push_back(face);  // untouched: the pieces would only be slivers of it
      continue;
    }
    for (const Polygon& piece : outside) emit(result, piece, face.material);
    if (!material.empty()) emit(result, inside, material);
  }
  surface = std::move(result);
}

void paint_where(Surface& surface, const std::function<double(const Vertex&)>& side, const std::string& material) {
  Surface result;
  Polygon in, out;
  for (const Face& face : surface.faces) {
    split(Polygon(face.v.begin(), face.v.end()), side, in, out);
    if (out.size() >= 3) emit(result, out, face.material);
    if (in.size() >= 3) emit(result, in, material);
  }
  surface = std::move(result);
}

namespace {

constexpr double kGrid = 1e-4;  // [m] of coordinates in the file

/// True for a triangle that rounding to the file's grid leaves without area, or that was written before.
bool sliver_on_grid(const Face& face, std::set<std::array<long, 9>>& written) {
  std::array<std::array<long, 3>, 3> corner;
  std::array<V3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const V3& v = face.v[i].p;
    corner[i] = {std::lround(v.x / kGrid), std::lround(v.y / kGrid), std::lround(v.z / kGrid)};
    p[i] = {static_cast<double>(corner[i][0]), static_cast<double>(corner[i][1]), static_cast<double>(corner[i][2])};
  }
  const V3 a = p[1] - p[0], b = p[2] - p[0], c = p[2] - p[1];
  const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
  const V3 area = cross(a, b);
  if (longest == 0 || std::sqrt(dot(area, area)) < 1e-3 * longest) return true;
  std::sort(corner.begin(), corner.end());
  std::array<long, 9> key;
  for (std::size_t i = 0; i < 9; ++i) key[i] = corner[i / 3][i % 3];
  return !written.insert(key).second;
}

}  // namespace

void write_obj(const Surface& surface, const std::vector<Paint>& paints, const std::string& path) {
  std::ofstream obj(path + ".obj");
  const std::string name = std::filesystem::path(path).filename().string();
  if (!paints.empty()) obj << "mtllib " << name << ".mtl\n";
  std::map<std::array<long, 3>, int> points, normals;
  auto key = [](const V3& v, double grid) {
    return std::array<long, 3>{std::lround(v.x / grid), std::lround(v.y / grid), std::lround(v.z / grid)};
  };
  std::map<std::string, std::string> groups;
  char line[128];
  std::set<std::array<long, 9>> written;  // corners on the file's grid, sorted: no triangle twice
  for (const Face& face : surface.faces) {
    if (sliver_on_grid(face, written)) continue;
    std::string text = "f";
    for (const Vertex& v : face.v) {
      const auto [p, new_p] = points.emplace(key(v.p, 1e-4), static_cast<int>(points.size()) + 1);
      if (new_p) {
        std::snprintf(line, sizeof line, "v %.4f %.4f %.4f\n", static_cast<double>(p->first[0]) * 1e-4,
                      static_cast<double>(p->first[1]) * 1e-4, static_cast<double>(p->first[2]) * 1e-4);
        obj << line;
      }
      const auto [n, new_n] = normals.emplace(key(v.n, 1e-2), static_cast<int>(normals.size()) + 1);
      if (new_n) {
        std::snprintf(line, sizeof line, "vn %.2f %.2f %.2f\n", static_cast<double>(n->first[0]) * 1e-2,
                      static_cast<double>(n->first[1]) * 1e-2, static_cast<double>(n->first[2]) * 1e-2);
        obj << line;
      }
      text += " " + std::to_string(p->second) + "//" + std::to_string(n->second);
    }
    groups[face.material] += text + "\n";
  }
  for (const auto& [material, text] : groups) {
    if (!paints.empty()) obj << "usemtl " << material << "\n";
    obj << text;
  }
  if (!obj.flush()) throw std::runtime_error("cannot write " + path + ".obj");
  if (paints.empty()) return;
  std::ofstream mtl(path + ".mtl");
  for (const Paint& paint : paints) {
    std::snprintf(line, sizeof line, "newmtl %s\nKd %.3f %.3f %.3f\nd %.2f\n", paint.name.c_str(), paint.colour[0], paint.colour[1],
                  paint.colour[2], paint.opacity);
    mtl << line;
  }
  if (!mtl.flush()) throw std::runtime_error("cannot write " + path + ".mtl");
}

}  // namespace assets
