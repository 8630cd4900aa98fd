// Light of what the object pass has seen, onto the picture: once a surface, not once a sample, and only where there is one.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/studio.h"
#include "render/shade/kernels.h"

namespace render::gl {

struct Lighting {
  const shade::FrameData& data;
  const shade::Maps& maps;
  const float* materials;
  bool terrain;
};

class LightPass {
 public:
  /// In the band r of the picture; with depth if a line may pass behind things.
  void draw(Studio&, const Lighting&, const Rectangle& r, bool depth);

 private:
  void read(const Targets&, const Rectangle&);
  void find_surfaces(const Rectangle&, int samples);
  void add_pixel(const Rectangle&, int x, int y, int samples);
  void light(const Lighting&);
  void lay(const Targets&, const Rectangle&);

  std::vector<std::uint16_t> seen_;    // RGBA of each sample
  std::vector<float> depth_;           // of each sample
  std::vector<std::uint8_t> picture_;  // RGBA
  // a surface in a pixel
  std::vector<int> pixel_;
  std::vector<float> share_, x_, y_, z_, u_, v_, grain_, red_, green_, blue_;
  std::vector<std::int32_t> row_;
};

}  // namespace render::gl
