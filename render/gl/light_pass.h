// Light of what the object pass has seen, onto the picture: once a surface, not once a sample, and only where there is one.
#pragma once

#include <cstdint>
#include <vector>

#include "render/gl/object_pass.h"
#include "render/shade/kernels.h"

namespace render::gl {

struct Lighting {
  const shade::FrameData& data;
  const shade::Maps& maps;
  const float* materials;
  bool terrain;
  int samples;  // a side to a pixel
};

class LightPass {
 public:
  /// In the band r of the picture.
  void draw(const Lighting&, ObjectPass&, const Rectangle& r, const shade::Canvas&);

 private:
  void find_surfaces(const Lighting&, const ObjectPass&, const std::vector<shade::Triangle>&, const Rectangle&,
                     std::ptrdiff_t pitch);
  void add_pixel(const ObjectPass&, const std::vector<shade::Triangle>&, int samples, std::ptrdiff_t corner, std::ptrdiff_t row,
                 int pixel, float x, float y);
  void make_room(std::size_t more);
  void lay(const shade::Canvas&) const;

  // a surface in a pixel
  std::size_t count_ = 0;
  std::vector<int> pixel_;  // from the canvas's lowest left one
  std::vector<float> share_, x_, y_, z_, red_, green_, blue_;
  std::vector<std::int32_t> triangle_;
};

/// Depth of the nearest sample of each pixel of the band, into a picture `width` pixels wide.
void nearest_depths(const ObjectPass&, const Rectangle& r, int samples, int width, std::vector<float>& out);

}  // namespace render::gl
