/// The writer of grey clips and stills: their format on disk, and libavformat and libavcodec, which are used there and
/// nowhere else.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace glidelab::render {

enum class Codec { magicyuv, ffv1, raw, png, mjpeg, h264 };
inline bool lossy(Codec codec) {
  return codec == Codec::mjpeg || codec == Codec::h264;
}
enum class Container { mkv, avi, mp4, folder };

/// The settings of a lossy codec.
struct Compression {
  std::optional<Container> container = {};  ///< usual_container(), if not given
  int quality = 85;                         ///< for mjpeg: 1 to 100, on libjpeg's scale
  double crf = 23.0;                        ///< for h264: constant rate factor, 0 (best) to 51
  double bitrate_kbit_s = 0.0;              ///< for h264, instead of crf, if above 0
  int gop = 30;                             ///< for h264: frames from one key frame to the next
};

/// How a clip is stored on disk: lossless (MagicYUV, which is fast; FFV1, whose files are a seventh smaller;
/// uncompressed; a folder of 16-bit PNG for more than 8 bits), or as written by cameras (MJPEG, H.264), in Matroska,
/// AVI or MP4.
struct VideoFormat {
  Codec codec = Codec::magicyuv;
  int width = 0;  ///< even for h264, and height too
  int height = 0;
  double frame_rate_hz = 0.0;
  int threads = 1;  ///< of the encoder
  Compression compression = {};
  bool variable = false;  ///< every frame has its time; not in avi or a folder
};

const char* name_of(Codec codec);

/// Matroska for magicyuv and ffv1, AVI for raw and mjpeg, MP4 for h264, a folder for png.
Container usual_container(Codec codec);

/// Whether it can hold clips of this codec.
bool fits(Codec codec, Container container);

/// A frame's time stamp as it stands in the file of a clip of variable rate: in whole ticks, of 1 ms in Matroska and of
/// 1/90000 s in MP4.
double stored_stamp_s(double t_s, Codec codec, const Compression& compression);

/// The name of a clip with this codec: "m1-up.mkv", "m1-up.avi", "m1-up" (a folder).
std::string file_name_of(Codec codec, const Compression& compression, const std::string& clip);
std::string file_name_of(Codec codec, const std::string& clip);

/// Writes the frames of one grey clip.
///
/// A clip has a constant rate, with frame k at k / frame_rate, or a time stamp for every frame. Matroska rounds stamps
/// to its tick of 1 ms and also stores the exact rate; MP4 counts in 1/90000 s; AVI has a constant rate and no
/// rounding. Every write is checked: a full disk is an EnvironmentError that names the file, at the frame, at finish()
/// or never.
class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  /// Appends a frame of width x height codes, row by row. Codecs of 8 bits refuse 16-bit frames (std::logic_error).
  virtual void write(std::span<const std::uint8_t> frame) = 0;
  virtual void write(std::span<const std::uint16_t> frame) = 0;
  /// The same for a clip of variable rate; times rise by 1/90000 s or more.
  virtual void write(std::span<const std::uint8_t> frame, double t_s) = 0;
  /// Ends the clip. Without this call the output is not a valid clip; the destructor only frees.
  virtual void finish() = 0;
};

/// A clip through libavformat and libavcodec, for every codec but png. EnvironmentError if the file cannot be written
/// or the encoder is missing.
std::unique_ptr<VideoWriter> open_libav(const std::filesystem::path& path, const VideoFormat& format);

}  // namespace glidelab::render

namespace cv {
class Mat;
}

namespace glidelab::render {

/// Writes one 8- or 16-bit image.
void write_png(const std::filesystem::path& path, const cv::Mat& image);

/// Opens `path` for writing. EnvironmentError if it cannot be written or the codec is missing.
std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format);

}  // namespace glidelab::render
