#include <algorithm>

#include "render/renderer.h"

namespace render {
namespace {

constexpr int kWidestFine = 4096;  // [pixels] beyond, four times as many are more than a picture is worth

}  // namespace

Effort effort_of(Quality q, int width, int height) {
  if (q == Quality::draft) return {1, 1, 512, 1, 0.05, 128, 0.5, 2};
  if (q == Quality::standard) return {1, 2, 1024, 1, 0.05, 128, 0.2};
  return {std::max(width, height) > kWidestFine ? 1 : 2, 2, 2048, 2, 0.10, 256, 0.2};
}

}  // namespace render
