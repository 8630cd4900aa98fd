// The table of all overlays. Each is defined in the file of its name.
#include <algorithm>
#include <array>

#include "render/overlays/overlay.h"

namespace render {
namespace {

template <class... Overlays>
constexpr std::array<const Overlay*, sizeof...(Overlays)> table() {
  return {&Drawn<Overlays>::overlay...};
}

}  // namespace

// labels placed first keep their place: caption and scale before the labels that may move aside
constexpr auto kTable = table<struct SkidMarks,       //
                              struct WheelTraces,     //
                              struct VehiclePaths,    //
                              struct Ghosts,          //
                              struct Traces,          //
                              struct ContactHistory,  //
                              struct Contacts,        //
                              struct Caption,         //
                              struct Disclaimer,      //
                              struct Charts,          //
                              struct Legend,          //
                              struct ScaleBar,        //
                              struct Dimensions,      //
                              struct Velocities,      //
                              struct Forces,          //
                              struct Impulses>();

std::span<const Overlay* const> overlay_table() {
  return kTable;
}

std::vector<OverlayKey> overlay_keys() {
  std::vector<OverlayKey> out;
  for (const Overlay* overlay : kTable) out.insert(out.end(), overlay->keys.begin(), overlay->keys.end());
  return out;
}

Overlays::Overlays() {
  for (const OverlayKey& key : overlay_keys()) values_.emplace(key.name, key.fallback);
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

Float4 colour_of_share(double share) {
  // seven colours of equal steps in lightness, straight lines between them
  constexpr std::array<std::array<float, 3>, 7> kRamp{{{0.38f, 0.33f, 0.82f},
                                                       {0.29f, 0.45f, 0.86f},
                                                       {0.16f, 0.56f, 0.78f},
                                                       {0.14f, 0.66f, 0.60f},
                                                       {0.38f, 0.76f, 0.35f},
                                                       {0.75f, 0.85f, 0.20f},
                                                       {1.00f, 0.95f, 0.35f}}};
  const double x = std::clamp(share, 0.0, 1.0) * (kRamp.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), kRamp.size() - 2);
  const float s = static_cast<float>(x - static_cast<double>(i));
  Float4 out{0, 0, 0, 1};
  for (std::size_t c = 0; c < 3; ++c) out[c] = (1 - s) * kRamp[i][c] + s * kRamp[i + 1][c];
  return out;
}

std::string readable(const std::string& name) {
  std::string out = name.substr(name.find('/') == std::string::npos ? 0 : name.find('/') + 1);
  for (char& c : out)
    if (c == '_') c = ' ';
  return out;
}

}  // namespace render
