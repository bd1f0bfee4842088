#include "render/video/video_writer.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include "base/errors.h"
#include "base/files/file_io.h"

namespace glidelab::render {

const char* name_of(Codec codec) {
  switch (codec) {
    case Codec::magicyuv:
      return "magicyuv";
    case Codec::ffv1:
      return "ffv1";
    case Codec::raw:
      return "raw";
    case Codec::png:
      return "png";
    case Codec::mjpeg:
      return "mjpeg";
    case Codec::h264:
      return "h264";
  }
  throw std::logic_error("unknown codec");
}

Container usual_container(Codec codec) {
  switch (codec) {
    case Codec::magicyuv:
    case Codec::ffv1:
      return Container::mkv;
    case Codec::raw:
    case Codec::mjpeg:
      return Container::avi;
    case Codec::h264:
      return Container::mp4;
    case Codec::png:
      return Container::folder;
  }
  throw std::logic_error("unknown codec");
}

bool fits(Codec codec, Container container) {
  return container == usual_container(codec) ||
         (container == Container::mkv && codec != Codec::png && codec != Codec::raw) ||
         (container == Container::mp4 && codec == Codec::mjpeg);
}

std::string file_name_of(Codec codec, const Compression& compression, const std::string& clip) {
  const Container container = compression.container.value_or(usual_container(codec));
  if (!fits(codec, container)) throw std::logic_error("a container that does not fit the codec");
  switch (container) {
    case Container::mkv:
      return clip + ".mkv";
    case Container::avi:
      return clip + ".avi";
    case Container::mp4:
      return clip + ".mp4";
    case Container::folder:
      return clip;
  }
  throw std::logic_error("unknown container");
}

std::string file_name_of(Codec codec, const std::string& clip) {
  return file_name_of(codec, Compression{}, clip);
}

namespace {

// Ticks per second of the stamps of a clip with a variable rate: MPEG's clock. Matroska rounds them to 1 ms.
constexpr int kStampClock = 90'000;
constexpr double kMatroskaTick_s = 1e-3;

}  // namespace

double stored_stamp_s(double t_s, Codec codec, const Compression& compression) {
  const double stamp_s = std::round(t_s * kStampClock) / kStampClock;
  const bool in_matroska = compression.container.value_or(usual_container(codec)) == Container::mkv;
  return in_matroska ? kMatroskaTick_s * std::round(stamp_s / kMatroskaTick_s) : stamp_s;
}

namespace {

/// Throws for a negative result of libav, with the path and the attempted action.
void check(int result, const std::filesystem::path& path, const char* what) {
  if (result >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
  av_strerror(result, words.data(), words.size());
  throw base::EnvironmentError(fmt::format("{}: {}: {}", path.string(), what, words.data()));
}

const char* format_name(Container container) {
  switch (container) {
    case Container::mkv:
      return "matroska";
    case Container::avi:
      return "avi";
    case Container::mp4:
      return "mp4";
    case Container::folder:
      break;
  }
  throw std::logic_error("a folder, not a file");
}

AVCodecID codec_id(Codec codec) {
  switch (codec) {
    case Codec::magicyuv:
      return AV_CODEC_ID_MAGICYUV;
    case Codec::ffv1:
      return AV_CODEC_ID_FFV1;
    case Codec::raw:
      return AV_CODEC_ID_RAWVIDEO;
    case Codec::h264:
      return AV_CODEC_ID_H264;
    case Codec::mjpeg:
      return AV_CODEC_ID_MJPEG;
    case Codec::png:
      break;
  }
  throw std::logic_error("not a codec of a video file");
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
    if (format_.variable) throw std::logic_error("a clip of variable rate needs a time for every frame");
    put(frame, next_++);
  }
  void write(std::span<const std::uint8_t> frame, double t_s) override {
    if (!format_.variable) throw std::logic_error("a clip of constant rate takes no times");
    const auto stamp = static_cast<std::int64_t>(std::llround(t_s * kStampClock));
    if (stamp < next_) throw std::logic_error(fmt::format("a time of {} s that does not rise", t_s));
    put(frame, stamp);
    next_ = stamp + 1;
  }
  void write(std::span<const std::uint16_t>) override { throw std::logic_error("this codec takes frames of 8 bits"); }

  void finish() override {
    if (encoder_ != nullptr) {
      check(avcodec_send_frame(encoder_, nullptr), path_, "the last frames cannot be encoded");
      write_packets();
    }
    check(av_write_trailer(container_), path_, "cannot be written");
    avio_flush(container_->pb);
    check(container_->pb->error, path_, "cannot be written");
    check(avio_closep(&container_->pb), path_, "cannot be written");
  }

 private:
  void open() {
    const Container container = format_.compression.container.value_or(usual_container(format_.codec));
    check(avformat_alloc_output_context2(&container_, nullptr, format_name(container), path_.c_str()), path_,
          "container");
    AVStream* stream = avformat_new_stream(container_, nullptr);
    packet_ = av_packet_alloc();
    if (stream == nullptr || packet_ == nullptr) check(AVERROR(ENOMEM), path_, "encoder");
    const AVRational rate = av_d2q(format_.frame_rate_hz, 1'000'000);
    time_base_ = format_.variable ? AVRational{1, kStampClock} : av_inv_q(rate);
    frame_ticks_ = format_.variable ? std::max(1L, std::lround(kStampClock / format_.frame_rate_hz)) : 1;
    if (format_.codec == Codec::mjpeg) {
      describe_jpeg(*stream->codecpar);
    } else {
      open_encoder(rate);
      check(avcodec_parameters_from_context(stream->codecpar, encoder_), path_, "encoder");
      make_frame();
    }
    stream->time_base = time_base_;
    stream->avg_frame_rate = rate;
    container_->flags |= AVFMT_FLAG_BITEXACT;  // no version strings, no random numbers: the same clip is the same file
    check(avio_open(&container_->pb, path_.c_str(), AVIO_FLAG_WRITE), path_, "cannot be written");
    check(avformat_write_header(container_, nullptr), path_, "cannot be written");
  }

  void describe_jpeg(AVCodecParameters& parameters) const {
    parameters.codec_type = AVMEDIA_TYPE_VIDEO;
    parameters.codec_id = AV_CODEC_ID_MJPEG;
    parameters.width = format_.width;
    parameters.height = format_.height;
    parameters.format = AV_PIX_FMT_GRAY8;
    parameters.color_range = AVCOL_RANGE_JPEG;
  }

  void open_encoder(AVRational rate) {
    const AVCodec* codec = format_.codec == Codec::h264 ? avcodec_find_encoder_by_name("libx264")
                                                        : avcodec_find_encoder(codec_id(format_.codec));
    if (codec == nullptr) {
      throw base::EnvironmentError(fmt::format("{}: encoder missing in libavcodec", path_.string()));
    }
    encoder_ = avcodec_alloc_context3(codec);
    if (encoder_ == nullptr) check(AVERROR(ENOMEM), path_, "encoder");
    encoder_->width = format_.width;
    encoder_->height = format_.height;
    encoder_->pix_fmt = AV_PIX_FMT_GRAY8;
    encoder_->color_range = AVCOL_RANGE_JPEG;  // codes from 0 to 255
    encoder_->time_base = time_base_;
    encoder_->framerate = rate;
    if (format_.codec == Codec::ffv1) {
      // Level 3: every slice has a checksum and may be coded on its own; all frames are key frames.
      encoder_->level = 3;
      encoder_->gop_size = 1;
      encoder_->slices = 4;
      encoder_->thread_count = format_.threads;
      encoder_->thread_type = FF_THREAD_SLICE;
      check(av_opt_set_int(encoder_->priv_data, "slicecrc", 1, 0), path_, "encoder");
    }
    if (format_.codec == Codec::magicyuv) {
      encoder_->slices = 1;  // otherwise one a thread, and the file depends on their number
      encoder_->thread_count = 1;
    }
    if (format_.codec == Codec::h264) set_h264();
    if ((container_->oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    check(avcodec_open2(encoder_, codec, nullptr), path_, "encoder cannot be opened");
  }

  /// Like the encoders in phones: 4:2:0 in video range, no images that refer to later ones, and, with a bit rate, a
  /// buffer of one second.
  void set_h264() {
    const Compression& wanted = format_.compression;
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder_->color_range = AVCOL_RANGE_MPEG;
    encoder_->log_level_offset = AV_LOG_INFO - AV_LOG_ERROR;  // x264 reports its settings as information
    encoder_->max_b_frames = 0;
    encoder_->gop_size = wanted.gop;
    encoder_->thread_count = 1;  // more threads would change the result
    check(av_opt_set(encoder_->priv_data, "preset", "veryfast", 0), path_, "encoder");
    if (wanted.bitrate_kbit_s > 0.0) {
      encoder_->bit_rate = std::llround(wanted.bitrate_kbit_s * 1e3);
      encoder_->rc_max_rate = encoder_->bit_rate;
      encoder_->rc_buffer_size = static_cast<int>(encoder_->bit_rate);
    } else {
      check(av_opt_set_double(encoder_->priv_data, "crf", wanted.crf, 0), path_, "encoder");
    }
  }

  void make_frame() {
    frame_ = av_frame_alloc();
    if (frame_ == nullptr) check(AVERROR(ENOMEM), path_, "encoder");
    frame_->format = encoder_->pix_fmt;
    frame_->width = format_.width;
    frame_->height = format_.height;
    frame_->color_range = encoder_->color_range;
    check(av_frame_get_buffer(frame_, 0), path_, "encoder");
  }

  void put(std::span<const std::uint8_t> frame, std::int64_t stamp) {
    if (frame.size() != static_cast<std::size_t>(format_.width) * format_.height) {
      throw std::logic_error(
          fmt::format("a frame of {} bytes for {} x {}", frame.size(), format_.width, format_.height));
    }
    if (encoder_ == nullptr) {
      put_jpeg(frame, stamp);
      return;
    }
    check(av_frame_make_writable(frame_), path_, "cannot be written");
    const bool video_range = encoder_->color_range == AVCOL_RANGE_MPEG;
    for (int y = 0; y < format_.height; ++y) {
      const std::uint8_t* from = frame.data() + static_cast<std::size_t>(y) * format_.width;
      std::uint8_t* to = frame_->data[0] + static_cast<std::ptrdiff_t>(y) * frame_->linesize[0];
      if (video_range) {
        // Black at 16, white at 235 (ITU-R BT.601 and BT.709), rounded.
        for (int x = 0; x < format_.width; ++x) {
          // t / 255 as (t + 1 + t / 256) / 256, which is the same for t below 65536 and needs no division.
          const unsigned t = from[x] * 219U + 127U;
          to[x] = static_cast<std::uint8_t>(16U + ((t + 1U + (t >> 8U)) >> 8U));
        }
      } else {
        std::copy_n(from, format_.width, to);
      }
    }
    for (int plane = 1; video_range && plane < 3; ++plane) {
      std::memset(frame_->data[plane], 128, static_cast<std::size_t>(frame_->linesize[plane]) * (format_.height / 2));
    }
    frame_->pts = stamp;
    frame_->pict_type = AV_PICTURE_TYPE_NONE;
    check(avcodec_send_frame(encoder_, frame_), path_, "a frame cannot be encoded");
    write_packets();
  }

  void put_jpeg(std::span<const std::uint8_t> frame, std::int64_t stamp) {
    const cv::Mat image(format_.height, format_.width, CV_8U, const_cast<std::uint8_t*>(frame.data()));
    std::vector<unsigned char> bytes;
    if (!cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, format_.compression.quality})) {
      throw base::EnvironmentError(fmt::format("{}: JPEG encoder failed", path_.string()));
    }
    check(av_new_packet(packet_, static_cast<int>(bytes.size())), path_, "a frame cannot be encoded");
    std::copy(bytes.begin(), bytes.end(), packet_->data);
    packet_->pts = packet_->dts = stamp;
    packet_->flags |= AV_PKT_FLAG_KEY;
    write_packet();
  }

  void write_packets() {
    for (;;) {
      const int result = avcodec_receive_packet(encoder_, packet_);
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) break;
      check(result, path_, "a frame cannot be encoded");
      write_packet();
    }
    check(container_->pb->error, path_, "cannot be written");
  }

  void write_packet() {
    const AVStream* stream = container_->streams[0];
    packet_->stream_index = stream->index;
    packet_->duration = frame_ticks_;
    av_packet_rescale_ts(packet_, time_base_, stream->time_base);
    check(av_write_frame(container_, packet_), path_, "cannot be written");
    av_packet_unref(packet_);
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
  AVCodecContext* encoder_ = nullptr;  // none for MJPEG
  AVFrame* frame_ = nullptr;
  AVPacket* packet_ = nullptr;
  AVRational time_base_{1, 1};
  std::int64_t frame_ticks_ = 1;
  std::int64_t next_ = 0;  // the smallest allowed stamp of the next frame
};

}  // namespace

std::unique_ptr<VideoWriter> open_libav(const std::filesystem::path& path, const VideoFormat& format) {
  return std::make_unique<LibavWriter>(path, format);
}

namespace {

class PngFolderWriter final : public VideoWriter {
 public:
  PngFolderWriter(std::filesystem::path folder, const VideoFormat& format)
      : folder_(std::move(folder)), format_(format) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) base::throw_system_error(folder_.string(), "cannot be made", error.value());
  }

  void write(std::span<const std::uint8_t> frame) override { write_as(frame, CV_8U); }
  void write(std::span<const std::uint8_t>, double) override {
    throw std::logic_error("a folder of images has no times");
  }
  void write(std::span<const std::uint16_t> frame) override { write_as(frame, CV_16U); }
  void finish() override {}

 private:
  template <typename Code>
  void write_as(std::span<const Code> frame, int type) {
    if (frame.size() != static_cast<std::size_t>(format_.width) * format_.height) {
      throw std::logic_error(
          fmt::format("a frame of {} codes for {} x {}", frame.size(), format_.width, format_.height));
    }
    // The cv::Mat wraps const data, which imwrite does not change.
    const cv::Mat image(format_.height, format_.width, type, const_cast<Code*>(frame.data()));
    write_png(folder_ / fmt::format("{:06d}.png", next_++), image);
  }

  std::filesystem::path folder_;
  VideoFormat format_;
  int next_ = 0;
};

}  // namespace

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  // Encoded in memory and written by write_file, which sees a full disk at the write and at the close.
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    throw base::EnvironmentError(fmt::format("{}: PNG encoder failed", path.string()));
  }
  base::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format) {
  if (format.codec == Codec::png) return std::make_unique<PngFolderWriter>(path, format);
  return open_libav(path, format);
}

}  // namespace glidelab::render
