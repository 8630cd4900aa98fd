#include "tests/hard_cases/meshes.h"

#include <fstream>
#include <limits>

namespace hard_cases {

std::shared_ptr<const engine::TriangleMesh> box_mesh(const engine::Vec3& half) {
  std::vector<engine::Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(), (i & 4 ? 1 : -1) * half.z());
  return std::make_shared<engine::TriangleMesh>(corners, std::vector<engine::Triangle>{{0, 2, 3},
                                                                                       {0, 3, 1},
                                                                                       {4, 5, 7},
                                                                                       {4, 7, 6},
                                                                                       {0, 1, 5},
                                                                                       {0, 5, 4},
                                                                                       {2, 6, 7},
                                                                                       {2, 7, 3},
                                                                                       {0, 4, 6},
                                                                                       {0, 6, 2},
                                                                                       {1, 3, 7},
                                                                                       {1, 7, 5}});
}

Sheet flat_sheet(double x0, double x1, double y0, double y1, int columns, int rows) {
  Sheet sheet;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) sheet.vertices.emplace_back(x0 + (x1 - x0) * i / columns, y0 + (y1 - y0) * j / rows, 0);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      sheet.triangles.push_back({a, b, d});
      sheet.triangles.push_back({a, d, c});
    }
  return sheet;
}

Sheet spoilt(Sheet sheet) {
  const std::size_t count = sheet.triangles.size();
  std::vector<engine::Triangle> out;
  for (std::size_t t = 0; t < count; ++t) {
    engine::Triangle triangle = sheet.triangles[t];
    if (t % 29 == 3) std::swap(triangle[1], triangle[2]);  // turned over
    if (t % 23 == 5) {
      // split by a point a nanometre-thin needle away from one side
      const engine::Vec3 &a = sheet.vertices[static_cast<std::size_t>(triangle[0])],
                         &b = sheet.vertices[static_cast<std::size_t>(triangle[1])];
      sheet.vertices.push_back(0.5 * (a + b));
      const int m = static_cast<int>(sheet.vertices.size()) - 1;
      out.push_back({triangle[0], m, triangle[2]});
      out.push_back({m, triangle[1], triangle[2]});
      out.push_back({triangle[0], triangle[1], m});  // without area
      continue;
    }
    out.push_back(triangle);
    if (t % 31 == 7) out.push_back(triangle);                                  // twice
    if (t % 37 == 11) out.push_back({triangle[1], triangle[0], triangle[2]});  // twice, once turned over
    if (t % 41 == 13) out.push_back({triangle[0], triangle[0], triangle[2]});  // an edge
  }
  sheet.triangles = std::move(out);
  return sheet;
}

void write_obj(const std::filesystem::path& path, const Sheet& sheet) {
  std::ofstream out(path);
  out.precision(std::numeric_limits<double>::max_digits10);
  for (const engine::Vec3& v : sheet.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const engine::Triangle& t : sheet.triangles) out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

}  // namespace hard_cases
