#include "render/video/encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>

#include "render/error.h"
#include "render/publish.h"
#include "render/shade/kernels.h"
#include "render/video/libav.h"

namespace render {
namespace {

constexpr int kEncoderThreads = 2;  // pinned: the file's bytes depend on it

void check(int code, const std::string& what) {
  if (code >= 0) return;
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof text);
  throw RenderError(what + ": " + text);
}

/// What libav* allocated, which is null where memory has run out.
template <class T>
T* allocated(T* it) {
  if (!it) throw std::bad_alloc();
  return it;
}

/// One more entry of a dictionary of libav*.
void set(AVDictionary*& entries, const char* key, const std::string& value) {
  if (av_dict_set(&entries, key, value.c_str(), 0) < 0) throw std::bad_alloc();
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

constexpr AVRational kMilliseconds{1, 1000};

/// Tells the container its chapters; before its header is written.
void add_chapters(AVFormatContext* out, const Story& story) {
  if (story.chapters.size() < 2) return;
  out->chapters = static_cast<AVChapter**>(allocated(av_calloc(story.chapters.size(), sizeof(AVChapter*))));
  for (const Passage& p : story.chapters) {
    auto* chapter = static_cast<AVChapter*>(allocated(av_mallocz(sizeof(AVChapter))));
    out->chapters[out->nb_chapters++] = chapter;
    chapter->id = out->nb_chapters;
    chapter->time_base = kMilliseconds;
    chapter->start = std::lround(1000 * p.from);
    chapter->end = std::lround(1000 * p.to);
    set(chapter->metadata, "title", p.text);
  }
}

/// A stream for subtitles; none where there are no subtitles.
AVStream* add_subtitle_stream(AVFormatContext* out, const Story& story, bool mp4) {
  if (story.subtitles.empty()) return nullptr;
  AVStream* stream = allocated(avformat_new_stream(out, nullptr));
  stream->codecpar->codec_type = AVMEDIA_TYPE_SUBTITLE;
  stream->codecpar->codec_id = mp4 ? AV_CODEC_ID_MOV_TEXT : AV_CODEC_ID_SUBRIP;
  stream->time_base = kMilliseconds;
  set(stream->metadata, "language", "eng");
  if (mp4) {
    // 3GPP TS 26.245, TextSampleEntry: centred below, no box, font 1 at 18 in white; one font
    constexpr std::uint8_t kEntry[] = {0, 0,  0,   0,   1,   0xff, 0, 0, 0, 0,  0,    0,    0,    0,    0,   0,
                                       0, 0,  0,   0,   0,   0,    0, 1, 0, 18, 0xff, 0xff, 0xff, 0xff, 0,   0,
                                       0, 18, 'f', 't', 'a', 'b',  0, 1, 0, 1,  5,    'S',  'e',  'r',  'i', 'f'};
    stream->codecpar->extradata = static_cast<std::uint8_t*>(allocated(av_mallocz(sizeof kEntry + AV_INPUT_BUFFER_PADDING_SIZE)));
    std::memcpy(stream->codecpar->extradata, kEntry, sizeof kEntry);
    stream->codecpar->extradata_size = sizeof kEntry;
  }
  return stream;
}

void write_subtitles(AVFormatContext* out, AVStream* stream, const Story& story, bool mp4, const std::string& to) {
  if (!stream) return;
  AVPacket* packet = allocated(av_packet_alloc());
  for (const Passage& p : story.subtitles) {
    const std::size_t head = mp4 ? 2 : 0;  // an MP4's text comes after its length
    const std::string text = p.text.substr(0, 0xffff);
    check(av_new_packet(packet, static_cast<int>(head + text.size())), "cannot write " + to);
    if (mp4) {
      packet->data[0] = static_cast<std::uint8_t>(text.size() >> 8);
      packet->data[1] = static_cast<std::uint8_t>(text.size() & 0xff);
    }
    std::memcpy(packet->data + head, text.data(), text.size());
    packet->pts = packet->dts = std::lround(1000 * p.from);
    packet->duration = std::lround(1000 * (p.to - p.from));
    av_packet_rescale_ts(packet, kMilliseconds, stream->time_base);
    packet->stream_index = stream->index;
    packet->flags |= AV_PKT_FLAG_KEY;
    check(av_interleaved_write_frame(out, packet), "cannot write " + to);
  }
  av_packet_free(&packet);
}

/// A film of the container we write and no other: left to guess, the library takes a text for a list of files and opens those.
AVFormatContext* open_film(const std::string& file, const char* container) {
  AVFormatContext* in = nullptr;
  AVDictionary* options = nullptr;
  set(options, "protocol_whitelist", "file");
  const int opened = avformat_open_input(&in, url(file).c_str(), av_find_input_format(container), &options);
  av_dict_free(&options);
  check(opened, "cannot read " + file);
  return in;
}

/// Copies the fragmented file into one with its index in front.
void remux(const std::string& from, const std::string& to, std::int64_t frames, const std::map<std::string, std::string>& metadata,
           const Story& story) {
  AVFormatContext* in = open_film(from, "mov");
  AVFormatContext* out = nullptr;
  check(avformat_find_stream_info(in, nullptr), "cannot read back " + from);
  check(avformat_alloc_output_context2(&out, nullptr, "mp4", url(to).c_str()), "cannot write " + to);
  AVStream* stream = allocated(avformat_new_stream(out, nullptr));
  check(avcodec_parameters_copy(stream->codecpar, in->streams[0]->codecpar), "cannot write " + to);
  stream->codecpar->codec_tag = 0;
  stream->time_base = in->streams[0]->time_base;
  stream->avg_frame_rate = in->streams[0]->avg_frame_rate;
  for (const auto& [key, value] : metadata) set(out->metadata, key.c_str(), value);
  add_chapters(out, story);
  AVStream* const subtitles = add_subtitle_stream(out, story, true);
  check(avio_open(&out->pb, url(to).c_str(), AVIO_FLAG_WRITE), "cannot write " + to);
  AVDictionary* options = nullptr;
  set(options, "movflags", "faststart+use_metadata_tags");
  check(avformat_write_header(out, &options), "cannot write " + to);
  av_dict_free(&options);
  write_subtitles(out, subtitles, story, true, to);
  AVPacket* packet = allocated(av_packet_alloc());
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
  shade::kernels().i420(image.rgba.data(), image.width, image.height, out);
}

struct VideoEncoder::Impl {
  std::filesystem::path output;
  std::optional<PartFile> part;
  std::map<std::string, std::string> metadata;
  Story story;
  bool lossless = false;
  AVFormatContext* format = nullptr;
  AVCodecContext* codec = nullptr;
  AVStream* stream = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t next = 0;

  Impl() { load_libav(); }  // what release() calls
  // here and not in the encoder's own destructor: a constructor that throws leaves nothing behind either
  ~Impl() { release(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void open(int width, int height, double fps) {
    const std::string what = "cannot write " + output.string();
    const char* name = lossless ? "ffv1" : "libx264";
    const AVCodec* coder = avcodec_find_encoder_by_name(name);
    if (!coder) throw RenderError(what + ": this libavcodec has no " + name);
    check(avformat_alloc_output_context2(&format, nullptr, lossless ? "matroska" : "mp4", url(part->path().string()).c_str()),
          what);
    stream = allocated(avformat_new_stream(format, nullptr));
    codec = allocated(avcodec_alloc_context3(coder));
    codec->width = width;
    codec->height = height;
    codec->pix_fmt = lossless ? AV_PIX_FMT_BGR0 : AV_PIX_FMT_YUV420P;
    const AVRational rate = av_d2q(fps, 100000);
    codec->time_base = av_inv_q(rate);
    codec->framerate = rate;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->colorspace = lossless ? AVCOL_SPC_RGB : AVCOL_SPC_BT709;
    codec->color_range = lossless ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec->gop_size = lossless ? 1 : static_cast<int>(std::lround(2 * fps));
    codec->thread_count = kEncoderThreads;
    if (format->oformat->flags & AVFMT_GLOBALHEADER) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (lossless) {
      codec->level = 3;  // slices with checksums: a damaged frame is known as such
      codec->slices = 4;
      check(av_opt_set_int(codec->priv_data, "slicecrc", 1, 0), what);
    } else {
      check(av_opt_set(codec->priv_data, "preset", "veryfast", 0), what);
      check(av_opt_set(codec->priv_data, "crf", "20", 0), what);
      // half the work at the same structural similarity, for files an eighth larger; and every frame follows the one before
      codec->me_subpel_quality = 1;
      codec->max_b_frames = 0;
      check(av_opt_set(codec->priv_data, "motion-est", "dia", 0), what);
      check(av_opt_set(codec->priv_data, "weightp", "none", 0), what);
    }
    check(avcodec_open2(codec, coder, nullptr), what);
    check(avcodec_parameters_from_context(stream->codecpar, codec), what);
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = rate;
    write_header(what);
    frame = allocated(av_frame_alloc());
    frame->format = codec->pix_fmt;
    frame->width = width;
    frame->height = height;
    check(av_frame_get_buffer(frame, 0), what);
    packet = allocated(av_packet_alloc());
  }

  void write_header(const std::string& what) {
    AVStream* subtitles = nullptr;
    AVDictionary* options = nullptr;
    if (lossless) {                          // written in one go; an MP4 gets these when it is rewritten with its index in front
      format->flags |= AVFMT_FLAG_BITEXACT;  // no random identifiers: equal films, equal files
      for (const auto& [key, value] : metadata) set(format->metadata, key.c_str(), value);
      add_chapters(format, story);
      subtitles = add_subtitle_stream(format, story, false);
    } else {
      set(options, "movflags", "frag_keyframe+empty_moov");
    }
    check(avio_open(&format->pb, url(part->path().string()).c_str(), AVIO_FLAG_WRITE), what);
    check(avformat_write_header(format, &options), what);
    av_dict_free(&options);
    write_subtitles(format, subtitles, story, false, output.string());
  }

  void load(const std::uint8_t* picture) {
    if (lossless) {
      for (int y = 0; y < codec->height; ++y) {
        std::uint8_t* row = frame->data[0] + y * frame->linesize[0];
        for (int x = 0; x < codec->width; ++x, picture += 4, row += 4) {
          row[0] = picture[2];
          row[1] = picture[1];
          row[2] = picture[0];
          row[3] = 0;
        }
      }
      return;
    }
    for (int plane = 0; plane < 3; ++plane) {
      const int w = plane ? codec->width / 2 : codec->width, h = plane ? codec->height / 2 : codec->height;
      for (int y = 0; y < h; ++y, picture += w)
        std::memcpy(frame->data[plane] + y * frame->linesize[plane], picture, static_cast<std::size_t>(w));
    }
  }

  void drain() {
    for (;;) {
      const int got = avcodec_receive_packet(codec, packet);
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      check(got, "cannot encode " + output.string());
      av_packet_rescale_ts(packet, codec->time_base, stream->time_base);
      packet->stream_index = 0;
      check(av_interleaved_write_frame(format, packet), "cannot write " + output.string());
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
                           const std::map<std::string, std::string>& metadata, const Story& story)
    : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  m.lossless = output.extension() == ".mkv";
  if (!m.lossless && (width % 2 || height % 2))
    throw RenderError(fmt::format("an MP4 needs an even size, not {}x{}: try --size {}x{}", width, height, width + width % 2,
                                  height + height % 2));
  av_log_set_level(AV_LOG_ERROR);
  m.output = output;
  m.part.emplace(output);
  m.metadata = metadata;
  m.story = story;
  m.open(width, height, fps);
}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::append(const std::uint8_t* picture) {
  Impl& m = *impl_;
  check(av_frame_make_writable(m.frame), "cannot encode " + m.output.string());
  m.load(picture);
  m.frame->pts = m.next++;
  check(avcodec_send_frame(m.codec, m.frame), "cannot encode " + m.output.string());
  m.drain();
}

void VideoEncoder::finish() {
  Impl& m = *impl_;
  check(avcodec_send_frame(m.codec, nullptr), "cannot encode " + m.output.string());
  m.drain();
  check(av_write_trailer(m.format), "cannot write " + m.output.string());
  close_file(m.format->pb, m.output.string());
  m.release();
  if (m.lossless) return m.part->publish();
  PartFile whole(m.output, ".whole");
  remux(m.part->path().string(), whole.path().string(), m.next, m.metadata, m.story);
  whole.publish();
}

std::map<std::string, std::string> read_film_metadata(const std::filesystem::path& film) {
  load_libav();
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* in = open_film(film.string(), film.extension() == ".mkv" ? "matroska" : "mov");
  std::map<std::string, std::string> out;
  for (const AVDictionaryEntry* e = nullptr; (e = av_dict_get(in->metadata, "", e, AV_DICT_IGNORE_SUFFIX));) {
    std::string key = e->key;  // Matroska spells names in capitals
    std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    out[key] = e->value;
  }
  avformat_close_input(&in);
  return out;
}

}  // namespace render
