/// Finds the marker in a clip and tracks it through every frame.
///
/// Frames are read once. Every blob of about the marker's size starts a path. A path is followed by a fit of the
/// marker's model around the expected position (constant velocity) or, if that fails, by a search in a window. The
/// whole image is searched in the first frame and in every tenth frame after it. A path that starts there is followed
/// back through the frames since the last search and, once the way to measure it is known, through all frames that are
/// kept (120, or 128 MiB), until it is lost. While something like the marker moves and nothing is lost, searches are
/// rarer: up to eighty frames and at most 0.4 s apart. At the end, the marker is the path that moves and has the right
/// size and brightness, not the brightest one; an object that is always at rest is part of the scene. Frames in which
/// the marker is not seen have no sighting.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <deque>
#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/kept_windows.h"
#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/marker/marker_method.h"
#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_search.h"

namespace glidelab::core {

class MarkerTracker {
 public:
  /// `radius_at` gives the expected radius. `start_s` is the time of the frame to which the marker's start_px refers;
  /// empty: the first frame.
  MarkerTracker(std::filesystem::path clip, MarkerSetup marker, RadiusAt radius_at, std::optional<double> start_s = {});

  /// A tracker of something bright, in grey values, that need not look like a disc, such as the lit part of a sphere.
  /// What is `blurred` has no outline, and is measured by its centroid alone.
  static MarkerTracker of_any_shape(std::filesystem::path clip, const MarkerSetup& marker, RadiusAt radius_at,
                                    std::optional<double> start_s = {}, bool blurred = false);

  /// Measures every object by one method, in place of the one that fits it best.
  void measure_by(MarkerMethod method) { first_method_ = method; }

  /// Limits the memory of windows around sightings; the default is 128 MiB. If any sighting has none, all keep the
  /// shift by a colour mosaic or a tone curve, and a note says how many have none.
  void limit_windows(std::size_t bytes) { windows_.limit(bytes); }

  /// Takes the next frame. InputError if a hue is sought in a grey clip.
  void add(const Frame& frame);

  /// The track of the marker. NoMarker if nothing of its size moves and not exactly one such object is at rest, or if
  /// nothing is near start_px. TwoMarkers if two alike move alike and start_px does not say which is the marker.
  TrackedMarker finish();

 private:
  using Path = MarkerPath;
  struct Past {
    std::size_t frame;
    Signal signal;
  };

  void keep(const Signal& signal, std::size_t frame, const MeasuredMarker& found);
  std::optional<MeasuredMarker> find_again(const Signal& signal, std::size_t frame, const Path& path,
                                           const std::vector<cv::Point2d>& taken) const;
  void accept(Path& path, const Signal& signal, std::size_t frame, const MeasuredMarker& found);
  void follow(const Signal& signal, std::size_t frame);
  void search_whole(const Signal& signal, std::size_t frame);
  void follow_back(Path& path, std::size_t from_frame);
  void decide(Path& path);
  const Path* mover(std::size_t frame) const;
  void put_to_sleep(std::size_t frame);
  void tidy(std::size_t frame);
  void search_rest();
  bool is_time_to_search(const Signal& signal, const Frame& frame) const;
  std::vector<cv::Point2d> places_at(std::size_t frame) const;

  std::filesystem::path clip_;
  MarkerSetup marker_;
  SignalKind kind_;
  MarkerMethod first_method_ = MarkerMethod::undecided;  ///< of a new path
  RadiusAt radius_at_;
  double radius_px_ = 0.0;  ///< expected radius in the middle of the image
  std::vector<Path> paths_;
  std::deque<Past> past_;  ///< frames before this one, in which paths are followed back
  KeptWindows windows_;
  std::size_t searched_ = 0;
  double searched_s_ = 0.0;
  std::size_t frames_ = 0;
  std::optional<double> start_s_;
  std::size_t start_frame_ = 0;  ///< the frame nearest to start_s_ so far
  double from_start_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace glidelab::core
