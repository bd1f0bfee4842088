/// The frames of a clip, one after the other: from a video file or from a folder of pictures.
///
/// A frame's time is the middle of its exposure, counted from the first frame's: k / frame_rate_hz, or the container's
/// time stamps where the experiment says so.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/frames/draw_pixels.h"

namespace glidelab::core {

struct Frame {
  cv::Mat grey;   ///< one channel, 8 or 16 bits; a grey clip comes out bit by bit as it is stored
  cv::Mat color;  ///< BGR, 8 bits, where it was asked for; else empty
  std::size_t index = 0;
  double t_s = 0.0;
  DrawPixels draw = {};  ///< of next_in_parts(): grey holds nothing but what was drawn with it; else empty
};

/// Rates are stated rounded (239.76 as 240), 0.1 %; one that is further off, relative, is another one.
inline constexpr double kRateRounding = 1.5e-3;

/// What a video file says of how it was written and of its times, and frames that came twice. Of a folder of frames,
/// and of frames from elsewhere, nothing is known.
struct FileFacts {
  std::string codec;                        ///< four letters; empty for a folder of frames
  std::optional<bool> lossy;                ///< nothing for a codec that is not known here
  std::optional<double> container_rate_hz;  ///< frames a second, as the container says
  std::size_t stamps_missing = 0;           ///< frames for which the time stamps leave a gap
  std::size_t irregular_steps = 0;          ///< between time stamps, that differ from the median step
  std::size_t repeated = 0;                 ///< frames equal to the one before, bit by bit
  double drift_frames = 0.0;                ///< how far the stamps leave a uniform row, in frames
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, or nothing at the end. InputError (file and frame) for a frame that cannot be decoded or is of
  /// another size, for stamps that do not rise where they count, and at the end of a clip that is shorter than its
  /// container says by more than max(2, 1 %), or empty.
  virtual std::optional<Frame> next() = 0;

  /// The next frame for one who looks at parts of it: where a source makes its pixels, the same ones as next() gives,
  /// it may leave them to Frame::draw, which outlives the source's next frames but not the source.
  virtual std::optional<Frame> next_in_parts() { return next(); }

  /// How many frames the container says there are; 0 where it does not.
  virtual std::size_t stated_frames() const = 0;

  /// What a reader should know, once the end is reached: a container with another rate, irregular stamps,
  /// repeated frames.
  virtual std::vector<std::string> notes() const = 0;

  /// Complete once the end is reached.
  virtual FileFacts facts() const { return {}; }
};

/// Opens a video or a folder of frames. `size`, where given, is what the frames must measure (the calibration's
/// pictures). InputError where it is neither a video nor a folder with pictures.
std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& file, const CameraSettings& camera,
                                         bool with_color, std::optional<cv::Size> size);

/// How an analysis comes by a clip's frames: open_frames, or what gives the same from elsewhere.
using FrameOpener = std::function<std::unique_ptr<FrameSource>(
    const std::filesystem::path& file, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)>;

}  // namespace glidelab::core
