// Meshes of the hard cases.
#pragma once

#include <filesystem>
#include <memory>

#include "engine/geometry/triangle_mesh.h"

namespace hard_cases {

/// A block of the half widths given [m], about the origin, 12 triangles.
std::shared_ptr<const engine::TriangleMesh> box_mesh(const engine::Vec3& half);

/// Vertices and triangles of the flat sheet x0..x1, y0..y1 at z = 0 in `columns` x `rows` cells of two triangles, seen from above.
struct Sheet {
  std::vector<engine::Vec3> vertices;
  std::vector<engine::Triangle> triangles;
};
Sheet flat_sheet(double x0, double x1, double y0, double y1, int columns, int rows);

/// The same with what scanned and hand-made meshes bring: needles, triangles without area, duplicates and triangles turned over.
Sheet spoilt(Sheet);

/// Wavefront OBJ.
void write_obj(const std::filesystem::path&, const Sheet&);

}  // namespace hard_cases
