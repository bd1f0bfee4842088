#include "core/pictures/frames/video_decoder.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string_view>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/display.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include "base/errors.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

// What cameras and converters write, by libav's names.
constexpr const char* kFormats =
    "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpegts,mpeg,mpegvideo,m4v,h264,hevc,mjpeg,asf,ogg,flv,dv,mxf,gif,cine,"
    "ser,yuv4mpegpipe,ivf,nut";
constexpr const char* kCodecs =
    "h264,hevc,av1,libdav1d,libaom-av1,vp8,vp9,mpeg1video,mpeg2video,mpeg4,msmpeg4v1,msmpeg4,msmpeg4v2,h261,h263,h263p,"
    "mjpeg,mjpegb,jpeg2000,jpegls,ffv1,huffyuv,ffvhuff,utvideo,magicyuv,lagarith,rawvideo,v210,v308,v408,v410,r210,"
    "yuv4,"
    "prores,dnxhd,cfhd,dvvideo,wmv1,wmv2,wmv3,vc1,theora,svq1,svq3,cinepak,indeo3,indeo4,indeo5,msvideo1,msrle,qtrle,"
    "rpza,flv,png,tiff,bmp,gif";
const std::set<std::string_view> kPlaylists{"hls", "dash", "concat", "imf", "sdp", "webm_dash_manifest"};
const std::set<std::string_view> kTexts{"tty", "bin", "xbin", "adf", "idf"};

constexpr int kReadBuffer = 1 << 16;  // bytes
constexpr int kMostRetries = 4096;    // for a format that has no data yet

/// Our own errors are clearer; if a user sets OpenCV's level of FFmpeg's log, that setting counts.
void silence_libav() {
  const char* const level = std::getenv("OPENCV_FFMPEG_LOGLEVEL");
  av_log_set_level(level != nullptr ? std::atoi(level) : AV_LOG_QUIET);
}

int read_bytes(void* opaque, std::uint8_t* to, int size) {
  auto* file = static_cast<std::FILE*>(opaque);
  const std::size_t got = std::fread(to, 1, static_cast<std::size_t>(size), file);
  if (got > 0) return static_cast<int>(got);
  return std::ferror(file) != 0 ? AVERROR(EIO) : AVERROR_EOF;
}

std::int64_t seek_bytes(void* opaque, std::int64_t offset, int whence) {
  auto* file = static_cast<std::FILE*>(opaque);
  if (whence == AVSEEK_SIZE) {
    struct stat status = {};
    return ::fstat(::fileno(file), &status) == 0 ? status.st_size : AVERROR(errno);
  }
  if (::fseeko(file, offset, whence & ~AVSEEK_FORCE) != 0) return AVERROR(errno);
  return ::ftello(file);
}

/// Called for any further file that a format wants opened.
int refuse_to_open(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) {
  return AVERROR(EACCES);
}

double seconds(std::int64_t ticks, AVRational base) {
  return base.den == 0 ? 0.0 : static_cast<double>(ticks) * base.num / base.den;
}

}  // namespace

class VideoDecoder::Libav {
 public:
  Libav(const fs::path& file, std::size_t most_pixels) : file_(file), most_pixels_(most_pixels) {
    silence_libav();
    try {
      open_container();
      open_decoder();
    } catch (...) {
      free_all();
      throw;
    }
  }
  ~Libav() { free_all(); }
  Libav(const Libav&) = delete;
  Libav& operator=(const Libav&) = delete;

  std::optional<DecodedFrame> next(bool grey_will_do) {
    if (!decode()) return std::nullopt;
    DecodedFrame decoded;
    const cv::Mat grey = grey_will_do ? to_grey_alone() : cv::Mat();
    decoded.image = upright(grey.empty() ? to_bgr() : grey);
    const std::int64_t stamp = frame_->pts != AV_NOPTS_VALUE ? frame_->pts : frame_->pkt_dts;
    if (stamp != AV_NOPTS_VALUE) {
      const std::int64_t start = stream_->start_time != AV_NOPTS_VALUE ? stream_->start_time : 0;
      decoded.stamp_s = seconds(stamp - start, stream_->time_base);
    }
    ++count_;
    return decoded;
  }

  double rate_hz() const {
    const AVRational rate = av_guess_frame_rate(container_, stream_, nullptr);
    const double hz = rate.den == 0 ? 0.0 : av_q2d(rate);
    // Of frames at uneven times libav may name one tick of the clock (90000 a second): a unit of time, not a rate.
    constexpr double kMostUneven = 2.5;  // fields are twice the frames
    return mean_rate_hz() > 0.0 && hz > kMostUneven * mean_rate_hz() ? 0.0 : hz;
  }

  double mean_rate_hz() const { return stream_->avg_frame_rate.den == 0 ? 0.0 : av_q2d(stream_->avg_frame_rate); }

  std::size_t stated_frames() const {
    auto count = static_cast<double>(stream_->nb_frames);
    if (stream_->nb_frames == 0) {
      double length_s = static_cast<double>(container_->duration) / AV_TIME_BASE;
      if (!(length_s > 0.0)) length_s = seconds(stream_->duration, stream_->time_base);
      const double hz = rate_hz();
      count = std::floor(length_s * (hz > 0.0 ? hz : mean_rate_hz()) + 0.5);
    }
    return count > 0.0 && count < 1e9 ? static_cast<std::size_t>(count) : 0;
  }

  std::string codec() const {
    unsigned tag = stream_->codecpar->codec_tag;
    if (tag == 0) {
      const std::string name = avcodec_get_name(stream_->codecpar->codec_id);
      if (name.size() == 4) return name;
      const std::array<const AVCodecTag*, 3> tables{avformat_get_riff_video_tags(), avformat_get_mov_video_tags(),
                                                    nullptr};
      tag = av_codec_get_tag(tables.data(), stream_->codecpar->codec_id);
    }
    std::string letters;
    for (unsigned shift = 0; shift < 32; shift += 8) letters.push_back(static_cast<char>(tag >> shift & 255U));
    return letters;
  }

 private:
  [[noreturn]] void fail(std::string found, std::string expected) const { fail("", std::move(found), expected); }
  [[noreturn]] void fail(std::string key, std::string found, std::string expected) const {
    throw base::InputError(base::Issue{file_.string(), 0, std::move(key), std::move(found), std::move(expected)});
  }

  void open_container() {
    bytes_ = std::fopen(file_.c_str(), "rbe");
    if (bytes_ == nullptr) fail("a file that cannot be read", "a video");
    auto* buffer = static_cast<unsigned char*>(av_malloc(kReadBuffer));
    io_ = avio_alloc_context(buffer, kReadBuffer, 0, bytes_, read_bytes, nullptr, seek_bytes);
    container_ = avformat_alloc_context();
    if (buffer == nullptr || io_ == nullptr || container_ == nullptr) throw std::bad_alloc();
    // libav sees only the last part of the name, whose ending helps to identify the format.
    const std::string name = file_.filename().string();
    const AVInputFormat* format = nullptr;
    if (av_probe_input_buffer2(io_, &format, name.c_str(), nullptr, 0, 0) < 0) {
      fail("no video that can be opened", "a video");
    }
    check_format(*format);
    container_->pb = io_;
    container_->io_open = refuse_to_open;
    container_->format_whitelist = av_strdup(kFormats);
    container_->codec_whitelist = av_strdup(kCodecs);
    container_->protocol_whitelist = av_strdup("none");
    if (avformat_open_input(&container_, name.c_str(), format, nullptr) < 0) {
      fail("no video that can be opened", "a video");
    }
    for (unsigned i = 0; i < container_->nb_streams; ++i) {  // before the first frames are decoded for what they tell
      const AVCodecParameters& stated = *container_->streams[i]->codecpar;
      if (stated.codec_type == AVMEDIA_TYPE_VIDEO) check_size(stated.width, stated.height);
    }
    look_at_streams();
    for (unsigned i = 0; i < container_->nb_streams && stream_ == nullptr; ++i) {
      if (container_->streams[i]->codecpar->codec_type == AVMEDIA_TYPE_VIDEO) stream_ = container_->streams[i];
    }
    if (stream_ == nullptr) fail("a file without a video stream", "a video");
    check_size(stream_->codecpar->width, stream_->codecpar->height);
  }

  void check_format(const AVInputFormat& format) const {
    const std::string_view name = format.name;
    const std::string called = format.long_name != nullptr ? format.long_name : format.name;
    if (kPlaylists.contains(name)) {
      fail("a playlist that names other files (" + called + ")", "the video itself");
    }
    if (kTexts.contains(name)) fail("a text (" + called + ")", "a video");
    if (av_match_list(format.name, kFormats, ',') == 0) {
      fail("no video that can be opened (" + called + ")", "a video");
    }
  }

  void look_at_streams() {
    std::vector<AVDictionary*> options(container_->nb_streams, nullptr);
    for (AVDictionary*& one : options) av_dict_set_int(&one, "max_pixels", limit(), 0);
    const int result = avformat_find_stream_info(container_, options.empty() ? nullptr : options.data());
    for (AVDictionary*& one : options) av_dict_free(&one);
    if (result < 0) fail("no video that can be opened", "a video");
  }

  void open_decoder() {
    const AVCodec* decoder = avcodec_find_decoder(stream_->codecpar->codec_id);
    if (decoder == nullptr || av_match_list(decoder->name, kCodecs, ',') == 0) {
      fail(
          fmt::format("a video in the codec {}, which is not supported", avcodec_get_name(stream_->codecpar->codec_id)),
          "a video as cameras write it (H.264, MJPEG, FFV1, …)");
    }
    codec_ = avcodec_alloc_context3(decoder);
    frame_ = av_frame_alloc();
    bgr_ = av_frame_alloc();
    packet_ = av_packet_alloc();
    if (codec_ == nullptr || frame_ == nullptr || bgr_ == nullptr || packet_ == nullptr) throw std::bad_alloc();
    codec_->thread_count = cv::getNumberOfCPUs();
    codec_->max_pixels = limit();
    codec_->codec_whitelist = av_strdup(kCodecs);
    if (avcodec_parameters_to_context(codec_, stream_->codecpar) < 0 || avcodec_open2(codec_, decoder, nullptr) < 0) {
      fail("no video that can be opened", "a video");
    }
    const std::uint8_t* matrix = av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
    if (matrix != nullptr) {
      const double turned_deg = av_display_rotation_get(reinterpret_cast<const std::int32_t*>(matrix));
      if (std::isfinite(turned_deg)) clockwise_deg_ = (static_cast<int>(-std::lround(turned_deg)) % 360 + 360) % 360;
    }
  }

  std::int64_t limit() const { return static_cast<std::int64_t>(most_pixels_); }

  void check_size(int width, int height) const {
    check_pixels(file_, count_ == 0 ? "" : fmt::format("frame {}", count_), width, height, most_pixels_);
  }

  /// The next frame into frame_.
  bool decode() {
    for (;;) {
      const int got = avcodec_receive_frame(codec_, frame_);
      if (got >= 0) return frame_->data[0] != nullptr;
      if (got == AVERROR_EOF || at_end_) return false;
      if (!read_packet()) {
        at_end_ = true;
        if (avcodec_send_packet(codec_, nullptr) < 0) return false;  // returns the frames that the decoder holds back
        continue;
      }
      const int sent = avcodec_send_packet(codec_, packet_);
      av_packet_unref(packet_);
      if (sent >= 0) continue;
      check_size(codec_->width, codec_->height);  // a frame that was refused for its size
      return false;
    }
  }

  /// The stream's next packet.
  bool read_packet() {
    for (int retries = 0; retries < kMostRetries;) {
      const int result = av_read_frame(container_, packet_);
      if (result == AVERROR(EAGAIN)) {
        ++retries;
        continue;
      }
      if (result < 0) return false;
      if (packet_->stream_index == stream_->index) return true;
      av_packet_unref(packet_);
    }
    return false;
  }

  cv::Mat to_bgr() {
    check_size(frame_->width, frame_->height);
    const auto format = static_cast<AVPixelFormat>(frame_->format);
    scaler_ = sws_getCachedContext(scaler_, frame_->width, frame_->height, format, frame_->width, frame_->height,
                                   AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr);
    if (scaler_ == nullptr) {
      fail(fmt::format("frame {}", count_), "pixels in a format that cannot be converted", "a video");
    }
    if (bgr_->width != frame_->width || bgr_->height != frame_->height) {  // in libav's own memory: aligned rows
      av_frame_unref(bgr_);
      bgr_->format = AV_PIX_FMT_BGR24;
      bgr_->width = frame_->width;
      bgr_->height = frame_->height;
      if (av_frame_get_buffer(bgr_, 0) < 0) throw std::bad_alloc();
    }
    sws_scale(scaler_, frame_->data, frame_->linesize, 0, frame_->height, bgr_->data, bgr_->linesize);
    return cv::Mat(bgr_->height, bgr_->width, CV_8UC3, bgr_->data[0], static_cast<std::size_t>(bgr_->linesize[0]));
  }

  /// Without a way through colours, where the frame has none; empty where it may have some. What libav would make of
  /// each brightness is asked of libav.
  cv::Mat to_grey_alone() {
    check_size(frame_->width, frame_->height);
    const cv::Mat luma(frame_->height, frame_->width, CV_8U, frame_->data[0],
                       static_cast<std::size_t>(frame_->linesize[0]));
    if (frame_->format == AV_PIX_FMT_GRAY8) return luma;
    if (frame_->format != AV_PIX_FMT_YUV420P || !has_neutral_chroma()) return {};
    if (greys_.empty()) {
      greys_ = greys_of_luma();
      cv::Mat grey, by_colours;
      cv::LUT(luma, greys_, grey);
      cv::cvtColor(to_bgr(), by_colours, cv::COLOR_BGR2GRAY);
      by_luma_ = std::equal(grey.begin<std::uint8_t>(), grey.end<std::uint8_t>(), by_colours.begin<std::uint8_t>());
    }
    if (!by_luma_) return {};
    cv::Mat grey;
    cv::LUT(luma, greys_, grey);
    return grey;
  }

  bool has_neutral_chroma() const {
    constexpr std::uint8_t kNeutral = 128;
    const int width = (frame_->width + 1) / 2, height = (frame_->height + 1) / 2;
    for (int plane = 1; plane < 3; ++plane) {
      for (int v = 0; v < height; ++v) {
        const std::uint8_t* row = frame_->data[plane] + static_cast<std::ptrdiff_t>(v) * frame_->linesize[plane];
        if (!std::all_of(row, row + width, [](std::uint8_t code) { return code == kNeutral; })) return false;
      }
    }
    return true;
  }

  /// Of each code of the luma.
  static cv::Mat greys_of_luma() {
    constexpr int kCodes = 256;
    AVFrame* ramp = av_frame_alloc();
    AVFrame* colours = av_frame_alloc();
    for (AVFrame* const frame : {ramp, colours}) {
      if (frame == nullptr) throw std::bad_alloc();
      frame->width = kCodes;
      frame->height = 2;
      frame->format = frame == ramp ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_BGR24;
      if (av_frame_get_buffer(frame, 0) < 0) throw std::bad_alloc();
    }
    for (int v = 0; v < 2; ++v) {
      for (int code = 0; code < kCodes; ++code) {
        ramp->data[0][v * ramp->linesize[0] + code] = static_cast<std::uint8_t>(code);
        if (code < kCodes / 2) ramp->data[1 + v][code] = 128;
      }
    }
    SwsContext* scaler = sws_getContext(kCodes, 2, AV_PIX_FMT_YUV420P, kCodes, 2, AV_PIX_FMT_BGR24, SWS_BICUBIC,
                                        nullptr, nullptr, nullptr);
    if (scaler == nullptr) throw std::bad_alloc();
    sws_scale(scaler, ramp->data, ramp->linesize, 0, 2, colours->data, colours->linesize);
    cv::Mat greys;
    cv::cvtColor(cv::Mat(1, kCodes, CV_8UC3, colours->data[0]), greys, cv::COLOR_BGR2GRAY);
    sws_freeContext(scaler);
    av_frame_free(&colours);
    av_frame_free(&ramp);
    return greys;
  }

  /// A copy, turned as the container says.
  cv::Mat upright(const cv::Mat& stored) const {
    cv::Mat image;
    switch (clockwise_deg_) {
      case 90:
        cv::rotate(stored, image, cv::ROTATE_90_CLOCKWISE);
        return image;
      case 180:
        cv::rotate(stored, image, cv::ROTATE_180);
        return image;
      case 270:
        cv::rotate(stored, image, cv::ROTATE_90_COUNTERCLOCKWISE);
        return image;
      default:
        return stored.clone();
    }
  }

  void free_all() {
    sws_freeContext(scaler_);
    av_packet_free(&packet_);
    av_frame_free(&bgr_);
    av_frame_free(&frame_);
    avcodec_free_context(&codec_);
    avformat_close_input(&container_);
    if (io_ != nullptr) av_freep(&io_->buffer);
    avio_context_free(&io_);
    if (bytes_ != nullptr) std::fclose(bytes_);
  }

  fs::path file_;
  std::size_t most_pixels_;
  std::FILE* bytes_ = nullptr;
  AVIOContext* io_ = nullptr;
  AVFormatContext* container_ = nullptr;
  AVStream* stream_ = nullptr;
  AVCodecContext* codec_ = nullptr;
  AVFrame* frame_ = nullptr;
  AVFrame* bgr_ = nullptr;
  AVPacket* packet_ = nullptr;
  SwsContext* scaler_ = nullptr;
  cv::Mat greys_;         ///< of each code of the luma; empty until a frame without colours came
  bool by_luma_ = false;  ///< they are what the first such frame became by way of its colours
  int clockwise_deg_ = 0;
  bool at_end_ = false;
  std::size_t count_ = 0;
};

VideoDecoder::VideoDecoder(const fs::path& file, std::size_t most_pixels)
    : av_(std::make_unique<Libav>(file, most_pixels)) {}

VideoDecoder::~VideoDecoder() = default;

std::optional<DecodedFrame> VideoDecoder::next(bool grey_will_do) {
  return av_->next(grey_will_do);
}

std::size_t VideoDecoder::stated_frames() const {
  return av_->stated_frames();
}

double VideoDecoder::rate_hz() const {
  return av_->rate_hz();
}

std::string VideoDecoder::codec() const {
  return av_->codec();
}

}  // namespace glidelab::core
