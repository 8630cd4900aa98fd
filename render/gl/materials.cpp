#include "render/gl/materials.h"

#include <algorithm>

namespace render::gl {

MaterialRow row_of(const Material& m, bool terrain) {
  MaterialRow row{};
  auto& [base, coat, lobes, soft] = row;
  const float smooth = 1 - m.roughness;
  base = {m.colour[0], m.colour[1], m.colour[2], 1};
  switch (m.kind) {
    case MaterialKind::paint:  // flakes under clear coat
      coat = {0.045f, 0.85f, 0, 0};
      lobes = {0.22f, 18, 0.05f, 700};
      break;
    case MaterialKind::glass:
      base[3] = 0.2f;
      coat = {0.06f, 0.90f, 0, 0};
      lobes = {0, 1, 0.06f, 900};
      break;
    case MaterialKind::lamp:  // a mirror behind clear plastic
      base[3] = 0.30f;
      coat = {0.05f, 0.90f, 0.70f, 0.10f};
      lobes = {0, 1, 0.05f, 500};
      break;
    case MaterialKind::rubber:
      coat = {0.008f, 0.04f, 0, 0};
      lobes = {0, 1, 0.02f, 14};
      break;
    case MaterialKind::metal:
      base[3] = 0.35f + 0.65f * m.roughness;
      coat = {0, 0, 0.65f * smooth, 0};
      lobes = {0.12f, 200 - 180 * m.roughness, 0, 1};
      break;
    case MaterialKind::skin:
      coat = {0.004f, 0.05f, 0, 0};
      lobes = {0, 1, 0.015f, 22};
      soft = {0.18f, 0, 0, 0};
      break;
    case MaterialKind::cloth:
      lobes = {0, 1, 0, 1};
      soft = {0, 0.25f, 0.12f, 0};
      break;
    default:
      coat = {0.005f * smooth, 0.035f * smooth, 0, 0};
      lobes = {0, 1, 0.02f * smooth, 120 - 110 * m.roughness};
  }
  soft[3] = terrain ? 1.0f : m.kind == MaterialKind::lamp ? -1.0f : 0.0f;
  return row;
}

int MaterialTable::add(const Material& material, bool terrain) {
  const MaterialRow row = row_of(material, terrain);
  const auto at = std::find(rows_.begin(), rows_.end(), row);
  if (at != rows_.end()) return static_cast<int>(at - rows_.begin());
  rows_.push_back(row);
  return static_cast<int>(rows_.size()) - 1;
}

}  // namespace render::gl
