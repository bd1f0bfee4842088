#include "render/video_writer.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "base/staged_output.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

namespace glidelab::render {
namespace {

/// Throws for a negative result of libav, with the path and what was tried.
void check(int result, const std::filesystem::path& path, const char* what) {
  if (result >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
  av_strerror(result, words.data(), words.size());
  throw base::EnvironmentError(fmt::format("{}: {}: {}", path.string(), what, words.data()));
}

class LibavWriter final : public VideoWriter {
 public:
  LibavWriter(std::filesystem::path path, const VideoFormat& format) : path_(std::move(path)), format_(format) {
    try {
      open();
    } catch (...) {
      free_all();
      throw;
    }
  }
  ~LibavWriter() override { free_all(); }
  LibavWriter(const LibavWriter&) = delete;
  LibavWriter& operator=(const LibavWriter&) = delete;

  void write(std::span<const std::uint8_t> frame) override {
    if (frame.size() != static_cast<std::size_t>(format_.width) * format_.height) {
      throw std::logic_error(
          fmt::format("a frame of {} bytes for {} x {}", frame.size(), format_.width, format_.height));
    }
    check(av_frame_make_writable(frame_), path_, "cannot be written");
    for (int y = 0; y < format_.height; ++y) {
      std::copy_n(frame.data() + static_cast<std::size_t>(y) * format_.width, format_.width,
                  frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0]);
    }
    frame_->pts = next_++;
    check(avcodec_send_frame(encoder_, frame_), path_, "a frame cannot be encoded");
    write_packets();
  }

  void write(std::span<const std::uint16_t>) override { throw std::logic_error("this codec takes frames of 8 bits"); }

  void finish() override {
    check(avcodec_send_frame(encoder_, nullptr), path_, "the last frames cannot be encoded");
    write_packets();
    check(av_write_trailer(container_), path_, "cannot be written");
    avio_flush(container_->pb);
    check(container_->pb->error, path_, "cannot be written");
    check(avio_closep(&container_->pb), path_, "cannot be written");
  }

 private:
  void open() {
    const bool ffv1 = format_.codec == Codec::ffv1;
    const AVCodec* codec = avcodec_find_encoder(ffv1 ? AV_CODEC_ID_FFV1 : AV_CODEC_ID_RAWVIDEO);
    if (codec == nullptr)
      throw base::EnvironmentError(fmt::format("{}: encoder missing in libavcodec", path_.string()));
    check(avformat_alloc_output_context2(&container_, nullptr, ffv1 ? "matroska" : "avi", path_.c_str()), path_,
          "container");
    AVStream* stream = avformat_new_stream(container_, nullptr);
    encoder_ = avcodec_alloc_context3(codec);
    if (stream == nullptr || encoder_ == nullptr) check(AVERROR(ENOMEM), path_, "encoder");
    const AVRational rate = av_d2q(format_.frame_rate_hz, 1'000'000);
    encoder_->width = format_.width;
    encoder_->height = format_.height;
    encoder_->pix_fmt = AV_PIX_FMT_GRAY8;
    encoder_->color_range = AVCOL_RANGE_JPEG;  // codes from 0 to 255
    encoder_->time_base = av_inv_q(rate);
    encoder_->framerate = rate;
    if (ffv1) {
      // Level 3: every slice has its checksum and may be coded on its own; all frames are key frames.
      encoder_->level = 3;
      encoder_->gop_size = 1;
      encoder_->slices = 4;
      encoder_->thread_count = format_.threads;
      encoder_->thread_type = FF_THREAD_SLICE;
      check(av_opt_set_int(encoder_->priv_data, "slicecrc", 1, 0), path_, "encoder");
    }
    if ((container_->oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    check(avcodec_open2(encoder_, codec, nullptr), path_, "encoder cannot be opened");
    stream->time_base = encoder_->time_base;
    stream->avg_frame_rate = rate;
    check(avcodec_parameters_from_context(stream->codecpar, encoder_), path_, "encoder");
    container_->flags |= AVFMT_FLAG_BITEXACT;  // no version strings, no random numbers: the same clip is the same file
    check(avio_open(&container_->pb, path_.c_str(), AVIO_FLAG_WRITE), path_, "cannot be written");
    check(avformat_write_header(container_, nullptr), path_, "cannot be written");
    frame_ = av_frame_alloc();
    packet_ = av_packet_alloc();
    if (frame_ == nullptr || packet_ == nullptr) check(AVERROR(ENOMEM), path_, "encoder");
    frame_->format = encoder_->pix_fmt;
    frame_->width = format_.width;
    frame_->height = format_.height;
    frame_->color_range = encoder_->color_range;
    check(av_frame_get_buffer(frame_, 0), path_, "encoder");
  }

  void write_packets() {
    for (;;) {
      const int result = avcodec_receive_packet(encoder_, packet_);
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) break;
      check(result, path_, "a frame cannot be encoded");
      const AVStream* stream = container_->streams[0];
      packet_->stream_index = stream->index;
      packet_->duration = 1;
      av_packet_rescale_ts(packet_, encoder_->time_base, stream->time_base);
      check(av_write_frame(container_, packet_), path_, "cannot be written");
      av_packet_unref(packet_);
    }
    check(container_->pb->error, path_, "cannot be written");
  }

  void free_all() {
    av_packet_free(&packet_);
    av_frame_free(&frame_);
    avcodec_free_context(&encoder_);
    if (container_ != nullptr && container_->pb != nullptr) avio_closep(&container_->pb);
    avformat_free_context(container_);
    container_ = nullptr;
  }

  std::filesystem::path path_;
  VideoFormat format_;
  AVFormatContext* container_ = nullptr;
  AVCodecContext* encoder_ = nullptr;
  AVFrame* frame_ = nullptr;
  AVPacket* packet_ = nullptr;
  std::int64_t next_ = 0;
};

class PngFolderWriter final : public VideoWriter {
 public:
  PngFolderWriter(std::filesystem::path folder, const VideoFormat& format)
      : folder_(std::move(folder)), format_(format) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) base::throw_system_error(folder_.string(), "cannot be made", error.value());
  }

  void write(std::span<const std::uint8_t> frame) override { write_as(frame, CV_8U); }
  void write(std::span<const std::uint16_t> frame) override { write_as(frame, CV_16U); }
  void finish() override {}

 private:
  template <typename Code>
  void write_as(std::span<const Code> frame, int type) {
    if (frame.size() != static_cast<std::size_t>(format_.width) * format_.height) {
      throw std::logic_error(
          fmt::format("a frame of {} codes for {} x {}", frame.size(), format_.width, format_.height));
    }
    // imwrite takes const data by a cv::Mat that it does not change.
    const cv::Mat picture(format_.height, format_.width, type, const_cast<Code*>(frame.data()));
    write_png(folder_ / fmt::format("{:06d}.png", next_++), picture);
  }

  std::filesystem::path folder_;
  VideoFormat format_;
  int next_ = 0;
};

}  // namespace

void write_png(const std::filesystem::path& path, const cv::Mat& picture) {
  // Encoded in memory and written by write_file, which sees a full disk at the write and at the close.
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    throw base::EnvironmentError(fmt::format("{}: PNG encoder failed", path.string()));
  }
  base::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string file_name_of(Codec codec, const std::string& clip) {
  switch (codec) {
    case Codec::ffv1:
      return clip + ".mkv";
    case Codec::raw:
      return clip + ".avi";
    case Codec::png:
      return clip;
  }
  throw std::logic_error("unknown codec");
}

std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format) {
  if (format.codec == Codec::png) return std::make_unique<PngFolderWriter>(path, format);
  return std::make_unique<LibavWriter>(path, format);
}

}  // namespace glidelab::render
