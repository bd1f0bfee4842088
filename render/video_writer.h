/// Grey clips on disk, lossless: FFV1 in Matroska or uncompressed AVI through libavformat (here and nowhere else), or a
/// folder of 16-bit PNG for more than 8 bits.
///
/// Frame k has the time stamp k / frame_rate. Matroska rounds stamps to its tick of 1 ms and carries the exact rate
/// beside them; AVI has a constant rate and no rounding. Every write is checked: a full disk is an EnvironmentError
/// that names the file, at the frame, at finish() or never.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>

namespace glidelab::render {

enum class Codec { ffv1, raw, png };

struct VideoFormat {
  Codec codec = Codec::ffv1;
  int width = 0;
  int height = 0;
  double frame_rate_hz = 0.0;
  int threads = 1;  ///< of the encoder
};

/// The name of a clip with this codec: "m1-up.mkv", "m1-up.avi", "m1-up" (a folder).
std::string file_name_of(Codec codec, const std::string& clip);

class VideoWriter {
 public:
  virtual ~VideoWriter() = default;
  /// Appends a frame of width x height codes, row by row. Codecs of 8 bits refuse 16-bit frames (std::logic_error).
  virtual void write(std::span<const std::uint8_t> frame) = 0;
  virtual void write(std::span<const std::uint16_t> frame) = 0;
  /// Ends the clip. Without it what was written is no clip; the destructor only frees.
  virtual void finish() = 0;
};

/// Writes one 8- or 16-bit picture.
void write_png(const std::filesystem::path& path, const cv::Mat& picture);

/// Opens `path` for writing. EnvironmentError where it cannot be written or the codec is missing.
std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format);

}  // namespace glidelab::render
