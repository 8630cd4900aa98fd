// Light of what the object pass has seen, onto the picture: once a surface, not once a sample, and only where there is one.
#pragma once

#include <array>
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
  /// What surfaces the pixels of the band r show. Into `covered`, a byte a pixel of the canvas: 255 where all samples of a pixel
  /// see a thing, 0 elsewhere in the band's rows.
  void find(ObjectPass&, const Rectangle& r, int samples, const shade::Canvas&, std::uint8_t* covered);
  /// Their light.
  void draw(const Lighting&, ObjectPass&, const shade::Canvas&);

 private:
  using Seen = std::array<std::int32_t, 4>;  // triangles, by two samples of the lower row and two of the upper
  bool same(std::int32_t one, std::int32_t other) const;
  void add(float share, float x, float y, int pixel, std::int32_t triangle);
  void add_edge(const Seen&, int pixel, float x, float y);
  void lay(const shade::Canvas&) const;

  const shade::Triangle* triangles_ = nullptr;
  // a surface in a pixel
  std::size_t count_ = 0;
  std::vector<int> pixel_;  // from the canvas's lowest left one
  std::vector<float> share_, x_, y_, red_, green_, blue_;
  std::vector<std::int32_t> triangle_;
};

}  // namespace render::gl
