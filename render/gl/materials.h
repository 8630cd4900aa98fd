// What a material is to the light: a row of numbers, so that one kernel without branches lights them all.
#pragma once

#include <array>
#include <vector>

#include "render/draw_list.h"

namespace render::gl {

/// Base colour and diffuse share; reflection straight on, at grazing, tinted mirror, glow; strength and exponent of a broad tinted
/// and a sharp white highlight; wrap, sheen, grain, what kind of surface: 1 terrain, -1 a lamp with ribs.
using MaterialRow = std::array<Float4, 4>;

MaterialRow row_of(const Material&, bool terrain);

/// The rows of one frame.
class MaterialTable {
 public:
  void clear() { rows_.clear(); }
  /// Number of the row, the same for equal rows.
  int add(const Material&, bool terrain);
  /// Sixteen numbers a row.
  const float* rows() const { return rows_.empty() ? nullptr : rows_[0][0].data(); }

 private:
  std::vector<MaterialRow> rows_;
};

}  // namespace render::gl
