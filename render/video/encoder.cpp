#include "render/video/encoder.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "render/error.h"
#include "render/publish.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

namespace render {
namespace {

constexpr int kEncoderThreads = 2;  // pinned: the file's bytes depend on it

void check(int code, const std::string& what) {
  if (code >= 0) return;
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof text);
  throw RenderError(what + ": " + text);
}

/// A name with a colon in it is a file's name, not a protocol's.
std::string url(const std::string& file) {
  return "file:" + file;
}

/// Closes a file written; a full disk shows at the latest here.
void close_file(AVIOContext*& file, const std::string& name) {
  avio_flush(file);
  const int met = file->error;
  const int closed = avio_closep(&file);
  check(met, "cannot write " + name);
  check(closed, "cannot write " + name);
}

/// Copies the fragmented file into one with its index in front.
void remux(const std::string& from, const std::string& to, std::int64_t frames,
           const std::map<std::string, std::string>& metadata) {
  AVFormatContext* in = nullptr;
  AVFormatContext* out = nullptr;
  check(avformat_open_input(&in, url(from).c_str(), nullptr, nullptr), "cannot read back " + from);
  check(avformat_find_stream_info(in, nullptr), "cannot read back " + from);
  check(avformat_alloc_output_context2(&out, nullptr, "mp4", url(to).c_str()), "cannot write " + to);
  AVStream* stream = avformat_new_stream(out, nullptr);
  check(avcodec_parameters_copy(stream->codecpar, in->streams[0]->codecpar), "cannot write " + to);
  stream->codecpar->codec_tag = 0;
  stream->time_base = in->streams[0]->time_base;
  stream->avg_frame_rate = in->streams[0]->avg_frame_rate;
  for (const auto& [key, value] : metadata) av_dict_set(&out->metadata, key.c_str(), value.c_str(), 0);
  check(avio_open(&out->pb, url(to).c_str(), AVIO_FLAG_WRITE), "cannot write " + to);
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "faststart+use_metadata_tags", 0);
  check(avformat_write_header(out, &options), "cannot write " + to);
  av_dict_free(&options);
  AVPacket* packet = av_packet_alloc();
  std::int64_t copied = 0;
  int got = 0;
  for (; (got = av_read_frame(in, packet)) >= 0; ++copied) {
    av_packet_rescale_ts(packet, in->streams[0]->time_base, stream->time_base);
    packet->stream_index = 0;
    packet->pos = -1;
    check(av_interleaved_write_frame(out, packet), "cannot write " + to);
  }
  av_packet_free(&packet);
  if (got != AVERROR_EOF) check(got, "cannot read back " + from);
  // a film short of frames must not pass for a whole one
  if (copied != frames) throw RenderError(fmt::format("cannot read back {}: {} of {} frames", from, copied, frames));
  check(av_write_trailer(out), "cannot write " + to);
  close_file(out->pb, to);
  avformat_free_context(out);
  avformat_close_input(&in);
}

}  // namespace

void rgba_to_i420(const Image& image, std::uint8_t* out) {
  const int w = image.width, h = image.height;
  std::uint8_t* Y = out;
  std::uint8_t* U = out + w * h;
  std::uint8_t* V = U + (w / 2) * (h / 2);
  // BT.709 limited range in 16-bit fixed point: 219/255 * (0.2126, 0.7152, 0.0722)
  for (int y = 0; y < h; ++y) {
    const std::uint8_t* p = image.rgba.data() + static_cast<std::size_t>(4 * w) * static_cast<std::size_t>(y);
    for (int x = 0; x < w; ++x, p += 4)
      *Y++ = static_cast<std::uint8_t>((11966 * p[0] + 40254 * p[1] + 4064 * p[2] + 32768) / 65536 + 16);
  }
  for (int y = 0; y + 1 < h; y += 2) {
    const std::uint8_t* a = image.rgba.data() + static_cast<std::size_t>(4 * w) * static_cast<std::size_t>(y);
    const std::uint8_t* b = a + 4 * w;
    for (int x = 0; x + 1 < w; x += 2, a += 8, b += 8) {
      const int r = a[0] + a[4] + b[0] + b[4], g = a[1] + a[5] + b[1] + b[5], u = a[2] + a[6] + b[2] + b[6];
      *U++ = static_cast<std::uint8_t>((-6596 * r - 22189 * g + 28785 * u + 4 * 65536 * 128 + 2 * 65536) / (4 * 65536));
      *V++ = static_cast<std::uint8_t>((28785 * r - 26145 * g - 2640 * u + 4 * 65536 * 128 + 2 * 65536) / (4 * 65536));
    }
  }
}

struct VideoEncoder::Impl {
  std::filesystem::path output;
  std::string part, whole;
  std::map<std::string, std::string> metadata;
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  AVStream* stream = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t next = 0;
  bool finished = false;

  // here and not in the encoder's own destructor: a constructor that throws leaves nothing behind either
  ~Impl() {
    release();
    if (finished || part.empty()) return;
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    std::filesystem::remove(whole, ignored);
  }
  void drain() {
    for (;;) {
      const int got = avcodec_receive_packet(codec, packet);
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check(got, "cannot encode " + output.string());
      av_packet_rescale_ts(packet, codec->time_base, stream->time_base);
      packet->stream_index = 0;
      check(av_interleaved_write_frame(format, packet), "cannot write " + part);
    }
  }
  void release() {
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&codec);
    if (format) {
      if (format->pb) avio_closep(&format->pb);
      avformat_free_context(format);
      format = nullptr;
    }
  }
};

VideoEncoder::VideoEncoder(const std::filesystem::path& output, int width, int height, double fps,
                           const std::map<std::string, std::string>& metadata)
    : impl_(std::make_unique<Impl>()) {
  if (width % 2 || height % 2)
    throw RenderError(fmt::format("an MP4 needs an even size, not {}x{}: try --size {}x{}", width, height, width + width % 2,
                                  height + height % 2));
  av_log_set_level(AV_LOG_ERROR);
  Impl& m = *impl_;
  m.output = output;
  m.part = output.string() + ".part";
  m.whole = output.string() + ".whole.part";
  m.metadata = metadata;
  const std::string what = "cannot write " + output.string();
  const AVCodec* h264 = avcodec_find_encoder_by_name("libx264");
  if (!h264) throw RenderError(what + ": this libavcodec has no libx264");
  check(avformat_alloc_output_context2(&m.format, nullptr, "mp4", url(m.part).c_str()), what);
  m.stream = avformat_new_stream(m.format, nullptr);
  m.codec = avcodec_alloc_context3(h264);
  m.codec->width = width;
  m.codec->height = height;
  m.codec->pix_fmt = AV_PIX_FMT_YUV420P;
  const AVRational rate = av_d2q(fps, 100000);
  m.codec->time_base = av_inv_q(rate);
  m.codec->framerate = rate;
  m.codec->color_primaries = AVCOL_PRI_BT709;
  m.codec->color_trc = AVCOL_TRC_BT709;
  m.codec->colorspace = AVCOL_SPC_BT709;
  m.codec->color_range = AVCOL_RANGE_MPEG;
  m.codec->gop_size = static_cast<int>(std::lround(2 * fps));
  m.codec->thread_count = kEncoderThreads;
  if (m.format->oformat->flags & AVFMT_GLOBALHEADER) m.codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  av_opt_set(m.codec->priv_data, "preset", "veryfast", 0);
  av_opt_set(m.codec->priv_data, "crf", "20", 0);
  check(avcodec_open2(m.codec, h264, nullptr), what);
  check(avcodec_parameters_from_context(m.stream->codecpar, m.codec), what);
  m.stream->time_base = m.codec->time_base;
  m.stream->avg_frame_rate = rate;
  check(avio_open(&m.format->pb, url(m.part).c_str(), AVIO_FLAG_WRITE), what);
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "frag_keyframe+empty_moov", 0);
  check(avformat_write_header(m.format, &options), what);
  av_dict_free(&options);
  m.frame = av_frame_alloc();
  m.frame->format = AV_PIX_FMT_YUV420P;
  m.frame->width = width;
  m.frame->height = height;
  check(av_frame_get_buffer(m.frame, 0), what);
  m.packet = av_packet_alloc();
}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::append(const std::uint8_t* i420) {
  Impl& m = *impl_;
  check(av_frame_make_writable(m.frame), "cannot encode " + m.output.string());
  for (int plane = 0; plane < 3; ++plane) {
    const int w = plane ? m.codec->width / 2 : m.codec->width, h = plane ? m.codec->height / 2 : m.codec->height;
    for (int y = 0; y < h; ++y, i420 += w)
      std::memcpy(m.frame->data[plane] + y * m.frame->linesize[plane], i420, static_cast<std::size_t>(w));
  }
  m.frame->pts = m.next++;
  check(avcodec_send_frame(m.codec, m.frame), "cannot encode " + m.output.string());
  m.drain();
}

void VideoEncoder::finish() {
  Impl& m = *impl_;
  check(avcodec_send_frame(m.codec, nullptr), "cannot encode " + m.output.string());
  m.drain();
  check(av_write_trailer(m.format), "cannot write " + m.part);
  close_file(m.format->pb, m.part);
  m.release();
  remux(m.part, m.whole, m.next, m.metadata);
  publish(m.whole, m.output);
  std::filesystem::remove(m.part);
  m.finished = true;
}

std::map<std::string, std::string> read_film_metadata(const std::filesystem::path& film) {
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* in = nullptr;
  check(avformat_open_input(&in, url(film.string()).c_str(), nullptr, nullptr), "cannot read " + film.string());
  std::map<std::string, std::string> out;
  for (const AVDictionaryEntry* e = nullptr; (e = av_dict_get(in->metadata, "", e, AV_DICT_IGNORE_SUFFIX));) out[e->key] = e->value;
  avformat_close_input(&in);
  return out;
}

}  // namespace render
