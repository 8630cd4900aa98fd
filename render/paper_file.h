// A file that cairo writes into. Its PDF surface (1.16) forgets a write that failed and ends well with half a page; this remembers.
#pragma once

#include <cairo/cairo.h>

#include <cstdio>

#include "render/publish.h"

namespace render {

class PaperFile {
 public:
  explicit PaperFile(const PartFile& part) : stream_(part.stream()) {}
  ~PaperFile() {
    if (stream_ != nullptr) std::fclose(stream_);
  }
  PaperFile(const PaperFile&) = delete;
  PaperFile& operator=(const PaperFile&) = delete;

  /// For cairo_..._surface_create_for_stream, with this as its closure.
  static cairo_status_t write(void* self, const unsigned char* bytes, unsigned count) {
    auto& file = *static_cast<PaperFile*>(self);
    if (std::fwrite(bytes, 1, count, file.stream_) != count) file.status_ = CAIRO_STATUS_WRITE_ERROR;
    return file.status_;
  }
  /// After the surface was finished: whether all of it was written.
  cairo_status_t close() {
    if (std::fclose(stream_) != 0) status_ = CAIRO_STATUS_WRITE_ERROR;
    stream_ = nullptr;
    return status_;
  }

 private:
  std::FILE* stream_;
  cairo_status_t status_ = CAIRO_STATUS_SUCCESS;
};

}  // namespace render
