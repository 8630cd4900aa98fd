// The film file as another program would read it: frames, colour tags, index in front, the same bytes twice.
#include "render/video/encoder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "render/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace {

namespace fs = std::filesystem;
using render::Image;
using render::RenderError;
using render::VideoEncoder;

constexpr int kSize = 64, kFrames = 5;

class Encoder : public testing::Test {
 protected:
  Encoder() : folder(fs::temp_directory_path() / ("encoder_test_" + std::to_string(getpid()))) { fs::create_directories(folder); }
  ~Encoder() override { fs::remove_all(folder); }
  fs::path folder;
};

Image plain(std::uint8_t r, std::uint8_t g, std::uint8_t b, int side = 2) {
  Image image{side, side, {}};
  for (int i = 0; i < side * side; ++i) image.rgba.insert(image.rgba.end(), {r, g, b, 255});
  return image;
}

void write_film(const fs::path& path) {
  VideoEncoder encoder(path, kSize, kSize, 25, {{"title", "a test"}, {"scene_sha256", "abc"}});
  std::vector<std::uint8_t> i420(kSize * kSize * 3 / 2);
  for (int i = 0; i < kFrames; ++i) {
    render::rgba_to_i420(plain(static_cast<std::uint8_t>(50 * i), 128, 0, kSize), i420.data());
    encoder.append(i420.data());
  }
  encoder.finish();
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(Encoder, ColoursAreBt709LimitedRange) {
  // Y', Cb, Cr of ITU-R BT.709 in 8 bits, rounded; one step is the rounding of the fixed-point coefficients
  const struct {
    std::uint8_t rgb[3];
    int yuv[3];
  } known[] = {{{0, 0, 0}, {16, 128, 128}},
               {{255, 255, 255}, {235, 128, 128}},
               {{255, 0, 0}, {63, 102, 240}},
               {{0, 255, 0}, {173, 42, 26}},
               {{0, 0, 255}, {32, 240, 118}}};
  for (const auto& k : known) {
    std::uint8_t out[6];
    render::rgba_to_i420(plain(k.rgb[0], k.rgb[1], k.rgb[2]), out);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(out[i], k.yuv[0], 1);
    EXPECT_NEAR(out[4], k.yuv[1], 1);
    EXPECT_NEAR(out[5], k.yuv[2], 1);
  }
}

TEST_F(Encoder, EveryFrameComesBackWithItsColourTagsAndProvenance) {
  const fs::path path = folder / "film.mp4";
  write_film(path);
  AVFormatContext* in = nullptr;
  ASSERT_EQ(avformat_open_input(&in, path.c_str(), nullptr, nullptr), 0);
  ASSERT_GE(avformat_find_stream_info(in, nullptr), 0);
  ASSERT_EQ(in->nb_streams, 1u);
  const AVCodecParameters* p = in->streams[0]->codecpar;
  EXPECT_EQ(p->codec_id, AV_CODEC_ID_H264);
  EXPECT_EQ(p->color_primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(p->color_trc, AVCOL_TRC_BT709);
  EXPECT_EQ(p->color_space, AVCOL_SPC_BT709);
  EXPECT_EQ(p->color_range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(in->streams[0]->avg_frame_rate.num, 25 * in->streams[0]->avg_frame_rate.den);
  for (const auto& [key, value] : {std::pair{"title", "a test"}, std::pair{"scene_sha256", "abc"}}) {
    const AVDictionaryEntry* entry = av_dict_get(in->metadata, key, nullptr, 0);
    ASSERT_NE(entry, nullptr) << key;
    EXPECT_STREQ(entry->value, value);
  }
  EXPECT_EQ(av_dict_get(in->metadata, "creation_time", nullptr, 0), nullptr) << "a clock in the file would change its bytes";

  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(p->codec_id));
  ASSERT_GE(avcodec_parameters_to_context(codec, p), 0);
  ASSERT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  int frames = 0;
  const auto take = [&] {
    for (; avcodec_receive_frame(codec, frame) == 0; ++frames) {
      std::uint8_t want[6];
      render::rgba_to_i420(plain(static_cast<std::uint8_t>(50 * frames), 128, 0), want);
      // crf 20 quantises a plain area by a few steps; successive frames differ by 9
      EXPECT_NEAR(frame->data[0][20 * frame->linesize[0] + 20], want[0], 3) << "frame " << frames;
    }
  };
  while (av_read_frame(in, packet) >= 0) {
    ASSERT_EQ(avcodec_send_packet(codec, packet), 0);
    av_packet_unref(packet);
    take();
  }
  avcodec_send_packet(codec, nullptr);
  take();
  EXPECT_EQ(frames, kFrames);
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&in);
}

TEST_F(Encoder, IndexStandsBeforeThePicturesAndNothingIsLeftBehind) {
  write_film(folder / "film.mp4");
  const std::string bytes = bytes_of(folder / "film.mp4");
  const std::size_t moov = bytes.find("moov"), mdat = bytes.find("mdat");
  ASSERT_NE(moov, std::string::npos);
  ASSERT_NE(mdat, std::string::npos);
  EXPECT_LT(moov, mdat);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(Encoder, SameFramesGiveTheSameBytes) {
  write_film(folder / "a.mp4");
  write_film(folder / "b.mp4");
  EXPECT_EQ(bytes_of(folder / "a.mp4"), bytes_of(folder / "b.mp4"));
}

TEST_F(Encoder, OddSizesAndMissingFoldersAreRefusedAndAnAbandonedFilmLeavesNoFile) {
  EXPECT_THROW(VideoEncoder(folder / "film.mp4", 63, 64, 25, {}), RenderError);
  EXPECT_THROW(VideoEncoder(folder / "none" / "film.mp4", 64, 64, 25, {}), RenderError);
  { VideoEncoder abandoned(folder / "film.mp4", 64, 64, 25, {}); }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(Encoder, ALosslessFilmComesBackToTheLastBit) {
  const fs::path path = folder / "film.mkv";
  Image noise = plain(0, 0, 0, 63);  // an odd side is no matter here
  std::uint32_t state = 12345;
  for (std::size_t i = 0; i < noise.rgba.size(); ++i)
    if (i % 4 != 3) noise.rgba[i] = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  {
    VideoEncoder encoder(path, 63, 63, 25, {{"title", "a test"}});
    for (int i = 0; i < 2; ++i) encoder.append(noise.rgba.data());
    encoder.finish();
  }
  AVFormatContext* in = nullptr;
  ASSERT_EQ(avformat_open_input(&in, path.c_str(), nullptr, nullptr), 0);
  ASSERT_GE(avformat_find_stream_info(in, nullptr), 0);
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(in->streams[0]->codecpar->codec_id));
  ASSERT_GE(avcodec_parameters_to_context(codec, in->streams[0]->codecpar), 0);
  ASSERT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  int frames = 0, wrong = 0;
  while (av_read_frame(in, packet) >= 0) {
    ASSERT_EQ(avcodec_send_packet(codec, packet), 0);
    av_packet_unref(packet);
    for (; avcodec_receive_frame(codec, frame) == 0; ++frames) {
      ASSERT_EQ(frame->format, AV_PIX_FMT_BGR0);
      for (int y = 0; y < 63; ++y)
        for (int x = 0; x < 63; ++x)
          for (int c = 0; c < 3; ++c)
            wrong += frame->data[0][y * frame->linesize[0] + 4 * x + 2 - c] !=
                     noise.rgba[static_cast<std::size_t>(4 * (63 * y + x) + c)];
    }
  }
  EXPECT_EQ(frames, 2);
  EXPECT_EQ(wrong, 0);
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&in);
}

TEST_F(Encoder, ChaptersAndSubtitlesAreInEitherContainer) {
  render::Story story;
  story.chapters = {{0, 0.08, "first"}, {0.08, 0.2, "second"}};
  story.subtitles = {{0.04, 0.12, "something happens"}};
  for (const std::string name : {"film.mp4", "film.mkv"}) {
    {
      VideoEncoder encoder(folder / name, kSize, kSize, 25, {}, story);
      const std::vector<std::uint8_t> picture(kSize * kSize * 4, 128);
      for (int i = 0; i < kFrames; ++i) encoder.append(picture.data());
      encoder.finish();
    }
    AVFormatContext* in = nullptr;
    ASSERT_EQ(avformat_open_input(&in, (folder / name).c_str(), nullptr, nullptr), 0);
    ASSERT_GE(avformat_find_stream_info(in, nullptr), 0);
    ASSERT_EQ(in->nb_chapters, 2u) << name;
    EXPECT_STREQ(av_dict_get(in->chapters[1]->metadata, "title", nullptr, 0)->value, "second");
    EXPECT_EQ(av_rescale_q(in->chapters[1]->start, in->chapters[1]->time_base, {1, 1000}), 80) << name;
    int subtitles = 0;
    AVPacket* packet = av_packet_alloc();
    while (av_read_frame(in, packet) >= 0) {
      const AVStream* stream = in->streams[packet->stream_index];
      const std::string text(reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size));
      if (stream->codecpar->codec_type == AVMEDIA_TYPE_SUBTITLE && text.find("something happens") != std::string::npos) {
        ++subtitles;
        EXPECT_EQ(av_rescale_q(packet->pts, stream->time_base, {1, 1000}), 40) << name;
      }
      av_packet_unref(packet);
    }
    EXPECT_EQ(subtitles, 1) << name;
    av_packet_free(&packet);
    avformat_close_input(&in);
  }
}

}  // namespace
