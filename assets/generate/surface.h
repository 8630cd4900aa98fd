// Triangles with smooth normals and one material each, and the knife that cuts windows, lamps and seams out of them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace assets {

struct V3 {
  double x = 0, y = 0, z = 0;
};
inline V3 operator+(V3 a, V3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline V3 operator-(V3 a, V3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline V3 operator*(double s, V3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
V3 cross(V3 a, V3 b);
double dot(V3 a, V3 b);
V3 unit(V3 a);

struct Vertex {
  V3 p, n;
};

struct Face {
  std::array<Vertex, 3> v;
  std::string material;
};

struct Surface {
  std::vector<Face> faces;
  void add(const Vertex& a, const Vertex& b, const Vertex& c, const std::string& material);
  void quad(V3 a, V3 b, V3 c, V3 d, const std::string& material);              // flat, counter-clockwise from outside
  void box(V3 centre, V3 half, const std::string& material, double lean = 0);  // lean [rad] about y
  void append(const Surface&);
  void mirror_y();  // adds the reflection
};

using Filter = std::function<bool(const V3& centroid, const V3& normal)>;
enum class Seen { from_side, from_front, from_above };  // which two coordinates the polygon lives in

/// Cuts along the border of a convex polygon (counter-clockwise in (x,z), (y,z) or (x,y)); what lies inside and passes the filter
/// gets `material`, or is removed when that is empty.
void cut(Surface&, Seen, const std::vector<std::array<double, 2>>& polygon, const Filter&, const std::string& material);

/// Cuts along the line where `side` changes its sign, linear over each triangle; what lies where it is more than nought gets
/// `material`.
void paint_where(Surface&, const std::function<double(const Vertex&)>& side, const std::string& material);

/// Writes NAME.obj and NAME.mtl with shared vertices.
struct Paint {
  std::string name;
  std::array<double, 3> colour;
  double opacity = 1;
};
void write_obj(const Surface&, const std::vector<Paint>&, const std::string& path_without_extension);

}  // namespace assets
