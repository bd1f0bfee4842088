/// The frames of a clip, one after the other: from a video file or from a folder of images.
///
/// A frame's time is the middle of its exposure, counted from the first frame's: k / frame_rate_hz, or the container's
/// time stamps if the experiment says so.
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
#include "core/result/analysis_note.h"

namespace glidelab::core {

/// Draws the pixels of a rectangle within the image, if they are not there yet: for an image whose pixels are made as
/// they are looked at (a renderer's: a tracker looks at a hundredth of it).
using DrawPixels = std::function<void(const cv::Rect&)>;

struct Frame {
  cv::Mat grey;   ///< one channel, 8 or 16 bits; a grey clip is preserved bit by bit
  cv::Mat color;  ///< BGR, 8 bits, if requested; otherwise empty
  std::size_t index = 0;
  double t_s = 0.0;
  DrawPixels draw = {};  ///< of next_in_parts(): grey contains only what was drawn with it; otherwise empty
};

/// People round rates by up to 0.1 % (239.76 as 240); a relative difference above this is another rate.
inline constexpr double kRateRounding = 1.5e-3;

/// What a video file says about its codec and its times, and how many frames came twice. Nothing is known about a
/// folder of frames.
struct FileFacts {
  std::string codec;                        ///< four letters; empty for a folder of frames
  std::optional<bool> lossy;                ///< nothing for an unknown codec
  std::optional<bool> predicts;             ///< lossy, and images are predicted from earlier ones; likewise
  std::optional<double> container_rate_hz;  ///< frames a second, as the container says
  std::size_t stamps_missing = 0;           ///< frames for which the time stamps leave a gap
  std::size_t irregular_steps = 0;          ///< between time stamps, that differ from the median step
  std::size_t repeated = 0;                 ///< frames equal to the one before, bit by bit
  double drift_frames = 0.0;                ///< largest departure of the time stamps from even spacing, in frames
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, or nothing at the end. InputError (file and frame) for a frame that cannot be decoded or has
  /// another size, for time stamps that are used but do not increase, and at the end of a clip that is empty or shorter
  /// than its container says by more than max(2, 1 %).
  virtual std::optional<Frame> next() = 0;

  /// The next frame for a reader that looks at parts of it: a source that makes its pixels may leave that to
  /// Frame::draw, which gives the same pixels as next() and outlives the following frames but not the source.
  virtual std::optional<Frame> next_in_parts() { return next(); }

  /// The number of frames that the container states; 0 if it states none.
  virtual std::size_t stated_frames() const = 0;

  /// What a reader should know, once the end is reached: a container with another rate, irregular stamps,
  /// repeated frames.
  virtual std::vector<Note> notes() const = 0;

  /// Complete once the end is reached.
  virtual FileFacts facts() const { return {}; }
};

/// Throws the InputError of one file.
[[noreturn]] void fail_frames(const std::filesystem::path& file, std::string key, std::string found,
                              std::string expected);

/// Checks that all frames have the same size, and the requested one; InputError if one does not.
class SizeCheck {
 public:
  explicit SizeCheck(std::optional<cv::Size> size) : size_(size), given_(size) {}
  void operator()(const cv::Mat& frame, std::size_t index, const std::filesystem::path& file);

 private:
  std::optional<cv::Size> size_;
  bool given_;
};

/// Counts frames that equal the frame before bit by bit: noise does not repeat itself.
class RepeatCounter {
 public:
  void operator()(const cv::Mat& grey);
  std::size_t repeated() const { return repeated_; }
  void tell(std::vector<Note>& notes) const;

 private:
  bool same_bits(const cv::Mat& grey) const;

  cv::Mat before_;
  std::size_t repeated_ = 0;
  std::size_t count_ = 0;
};

/// A decoded image, grey as stored, and its colours if requested.
Frame make_frame(const cv::Mat& image, bool with_color, std::size_t index);

/// Frames that are images in a folder, in the order of their numbers ("2.png" before "10.png"). `size`, if given, is
/// the required size of every frame. InputError for a folder without images, and if time stamps are requested, which a
/// folder does not have.
std::unique_ptr<FrameSource> open_frame_folder(const std::filesystem::path& folder, const CameraSettings& camera,
                                               bool with_color, std::optional<cv::Size> size);

/// Frames of a video file, with its container's information about their times. `size`, if given, is the required size
/// of every frame. InputError for a file that is not a video.
std::unique_ptr<FrameSource> open_video(const std::filesystem::path& file, const CameraSettings& camera,
                                        bool with_color, std::optional<cv::Size> size);

/// Opens a video or a folder of frames. `size`, if given, is the required size of the frames (that of the calibration's
/// images). InputError if it is neither a video nor a folder with images.
std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& file, const CameraSettings& camera,
                                         bool with_color, std::optional<cv::Size> size);

/// How an analysis obtains a clip's frames: open_frames, or another source of the same frames.
using FrameOpener = std::function<std::unique_ptr<FrameSource>(
    const std::filesystem::path& file, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)>;

}  // namespace glidelab::core
