// Halved again and again, so that every distance finds texels of about a pixel.
#include <algorithm>
#include <utility>

#include "render/error.h"
#include "render/image/png.h"
#include "render/stage.h"

namespace render {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;  // 8192 x 8192: 600 MB while it is read

std::int32_t mean_of(const GroundPicture::Level& l, int x, int y) {
  std::uint32_t out = 0;
  for (int shift = 0; shift < 32; shift += 8) {
    std::uint32_t sum = 2;
    for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
      const int i = std::min(x + dx, l.width - 1), j = std::min(y + dy, l.height - 1);
      sum += static_cast<std::uint32_t>(
                 l.texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(l.width) + static_cast<std::size_t>(i)]) >>
                 shift &
             255u;
    }
    out |= (sum / 4) << shift;
  }
  return static_cast<std::int32_t>(out);
}

}  // namespace

std::shared_ptr<const GroundPicture> read_ground_picture(const std::filesystem::path& file, std::string& problem) try {
  Image image = read_png(file, nullptr, kMostPixels);
  auto out = std::make_shared<GroundPicture>();
  GroundPicture::Level level{image.width, image.height, {}};
  level.texels.reserve(image.rgba.size() / 4);
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p =
          &image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x))];
      level.texels.push_back(static_cast<std::int32_t>(p[0] | p[1] << 8 | p[2] << 16 | static_cast<std::uint32_t>(p[3]) << 24));
    }
  image = {};
  out->levels.push_back(std::move(level));
  while (out->levels.back().width > 1 || out->levels.back().height > 1) {
    const GroundPicture::Level& last = out->levels.back();
    GroundPicture::Level next{(last.width + 1) / 2, (last.height + 1) / 2, {}};
    next.texels.reserve(static_cast<std::size_t>(next.width) * static_cast<std::size_t>(next.height));
    for (int y = 0; y < next.height; ++y)
      for (int x = 0; x < next.width; ++x) next.texels.push_back(mean_of(last, 2 * x, 2 * y));
    out->levels.push_back(std::move(next));
  }
  return out;
} catch (const RenderError& e) {
  problem = e.what();
  return nullptr;
}

}  // namespace render
