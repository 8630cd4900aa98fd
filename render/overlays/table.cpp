#include <array>

#include "render/overlays/overlay.h"

namespace render {

std::span<const Overlay* const> overlay_table() {
  // labels placed first keep their place: caption and scale before the labels that may move aside
  static constexpr std::array kTable{&kSkidMarks, &kTraces, &kContacts, &kCaption, &kScaleBar, &kDisclaimer, &kForces, &kImpulse};
  return kTable;
}

Float4 colour_of_part(const std::string& name) {
  auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (has("head") || has("neck")) return {1.00f, 0.86f, 0.20f, 1};
  if (has("torso") || has("hips") || has("waist")) return {1.00f, 0.58f, 0.10f, 1};
  if (has("arm")) return {0.55f, 0.90f, 0.35f, 1};
  if (has("thigh") || has("femur")) return {0.98f, 0.36f, 0.28f, 1};
  if (has("calf") || has("foot") || has("knee") || has("leg")) return {0.95f, 0.45f, 0.85f, 1};
  return {0.35f, 0.78f, 1.00f, 1};
}

std::string readable(const std::string& name) {
  std::string out = name.substr(name.find('/') == std::string::npos ? 0 : name.find('/') + 1);
  for (char& c : out)
    if (c == '_') c = ' ';
  return out;
}

}  // namespace render
