// The one place that includes libav*. Its functions are found when the first film is written or read.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "render/late_library.h"

// clang-format off
#define RENDER_AVFORMAT_FUNCTIONS(X) \
  X(av_find_input_format) X(av_interleaved_write_frame) X(av_read_frame) X(av_write_trailer) X(avformat_alloc_output_context2) \
  X(avformat_close_input) X(avformat_find_stream_info) X(avformat_free_context) X(avformat_new_stream) X(avformat_open_input) \
  X(avformat_write_header) X(avio_closep) X(avio_flush) X(avio_open)
#define RENDER_AVCODEC_FUNCTIONS(X) \
  X(av_new_packet) X(av_packet_alloc) X(av_packet_free) X(av_packet_rescale_ts) X(avcodec_alloc_context3) \
  X(avcodec_find_encoder_by_name) X(avcodec_free_context) X(avcodec_open2) X(avcodec_parameters_copy) \
  X(avcodec_parameters_from_context) X(avcodec_receive_packet) X(avcodec_send_frame)
#define RENDER_AVUTIL_FUNCTIONS(X) \
  X(av_calloc) X(av_d2q) X(av_dict_free) X(av_dict_get) X(av_dict_set) X(av_frame_alloc) X(av_frame_free) \
  X(av_frame_get_buffer) X(av_frame_make_writable) X(av_log_set_level) X(av_mallocz) X(av_opt_set) X(av_opt_set_int) \
  X(av_strerror)
// clang-format on

namespace render {

// In this namespace a call finds these and not the functions of libraries that would be loaded at every start.
#define RENDER_DECLARE(name) inline PointerTo<::name> name = nullptr;
RENDER_AVFORMAT_FUNCTIONS(RENDER_DECLARE)
RENDER_AVCODEC_FUNCTIONS(RENDER_DECLARE)
RENDER_AVUTIL_FUNCTIONS(RENDER_DECLARE)
#undef RENDER_DECLARE

/// Finds them. Throws RenderError.
void load_libav();

}  // namespace render
