#include "render/video/libav.h"

namespace render {

void load_libav() {
// the versions whose headers were read: another one has other structures
#define RENDER_FIND(library, name) (name) = reinterpret_cast<decltype(name)>(late_function(library, #name));
#define RENDER_FIND_FORMAT(name) RENDER_FIND("libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR), name)
#define RENDER_FIND_CODEC(name) RENDER_FIND("libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR), name)
#define RENDER_FIND_UTIL(name) RENDER_FIND("libavutil.so." AV_STRINGIFY(LIBAVUTIL_VERSION_MAJOR), name)
  RENDER_AVFORMAT_FUNCTIONS(RENDER_FIND_FORMAT)
  RENDER_AVCODEC_FUNCTIONS(RENDER_FIND_CODEC)
  RENDER_AVUTIL_FUNCTIONS(RENDER_FIND_UTIL)
}

}  // namespace render
