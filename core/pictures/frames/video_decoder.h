/// A video file, decoded frame by frame: the one place of core/ that calls libav.
///
/// A file from a stranger must not make the program read anything else. libav gets the bytes through a reader that
/// knows no other file and no network; formats and codecs are those that cameras and converters write (a playlist,
/// which names other files, and a text that draws characters are not among them), and any further file that a format
/// asks for is refused. A frame of more pixels than permitted is refused before memory for it is allocated.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace glidelab::core {

struct DecodedFrame {
  cv::Mat image;                  ///< BGR, 8 bits; equal channels for a grey video, turned as the container says
  std::optional<double> stamp_s;  ///< on the container's clock; nothing for a frame without a stamp
};

class VideoDecoder {
 public:
  /// InputError for a file that is not a video, a playlist, a codec that is not decoded, frames above `most_pixels`.
  VideoDecoder(const std::filesystem::path& file, std::size_t most_pixels);
  ~VideoDecoder();
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;

  /// The next frame; nothing at the end or if the rest cannot be decoded. InputError for a frame above the limit. With
  /// `grey_will_do`, a frame that is stored without colours has one channel: the common value of its three equal
  /// channels.
  std::optional<DecodedFrame> next(bool grey_will_do = false);

  std::size_t stated_frames() const;  ///< as the container counts them, or its length times its rate; 0: not stated
  double rate_hz() const;             ///< as the container states it; 0 if it does not
  std::string codec() const;          ///< four letters, as the container calls it

 private:
  class Libav;
  std::unique_ptr<Libav> av_;
};

}  // namespace glidelab::core
