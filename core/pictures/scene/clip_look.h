/// The images of a clip, examined on their way to the tracker: their exposure, the contrast of the marker, what the
/// file says.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/scene/camera_traces.h"
#include "core/result/results.h"

namespace glidelab::core {

/// How a clip is exposed: every fourth pixel, either way, of every fifth frame counts.
struct Exposure {
  double saturated = 0.0;     ///< share of pixels at the largest code
  double dark = 0.0;          ///< share at 0
  double bright_level = 0.0;  ///< below which 99.9 % of the pixels are, as a share of the largest code
  int full_code = 255;        ///< the largest code
};

class ExposureWatch {
 public:
  explicit ExposureWatch(int bit_depth) : bit_depth_(bit_depth) {}
  void add(const Frame& frame);
  Exposure result() const;

 private:
  int bit_depth_;
  std::vector<std::size_t> count_;  ///< of each code
  std::size_t pixels_ = 0;
};

struct ClipLook {
  cv::Size size;
  Exposure exposure;
  FileFacts file;
  /// Of the marker, by the fits that found it, medians as shares of the largest code; no contrast for a marker that is
  /// known by its hue, and a level for a bright one only.
  std::optional<double> contrast;
  std::optional<double> marker_level;
  double pixel_noise = 0.0;  ///< of pixels away from the marker, from one frame to the next; 0 if none is seen
  double block_steps = 0.0;  ///< sure_block_steps() of a codec
};

/// Takes the frames of one clip and then reports. It keeps every fourth pixel, either way, of at most 24 pairs of
/// neighbouring frames spread over the clip.
class ClipWatch {
 public:
  explicit ClipWatch(int bit_depth) : exposure_(bit_depth) {}
  void add(const Frame& frame);
  void end(FileFacts facts) { facts_ = std::move(facts); }

  /// `sightings` and `fits` as tracks_of() gives them for this clip.
  ClipLook look(const MarkerSetup& marker, const std::vector<MarkerSighting>& sightings,
                const std::vector<MarkerFit>& fits) const;

 private:
  struct Pair {
    std::size_t frame = 0;  ///< of `now`
    cv::Mat before, now;
  };
  double pixel_noise(const std::vector<MarkerSighting>& sightings) const;

  ExposureWatch exposure_;
  BlockStepSums steps_;
  FileFacts facts_;
  cv::Size size_;
  std::size_t every_ = 1;  ///< frames from one pair to the next
  cv::Mat before_;         ///< the last frame, if it is the first of a pair
  std::vector<Pair> pairs_;
};

/// Watches the clips of an experiment while others read them, some of them concurrently.
class ClipWatches {
 public:
  explicit ClipWatches(FrameOpener open) : open_(std::move(open)) {}
  /// Opens clips for the reader; valid as long as this is.
  FrameOpener opener();
  /// What was seen of a clip that was opened and read to its end; the last time, if that was done more than once.
  const ClipWatch& of(const std::filesystem::path& file) const { return *watches_.at(file); }

 private:
  FrameOpener open_;
  std::mutex mutex_;
  std::map<std::filesystem::path, std::shared_ptr<ClipWatch>> watches_;
};

}  // namespace glidelab::core
