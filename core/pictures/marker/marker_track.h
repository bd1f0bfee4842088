/// Finds the marker in a clip and follows it through every frame.
///
/// Frames stream through once. Every blob of about the marker's size begins a path; a path is followed by fitting the
/// marker's model around where it should be (constant velocity), or by searching a window where that fails. The whole
/// image is searched in the first frame and every tenth one after it, and a path that begins there is followed back
/// through the frames between; while something like the marker is seen moving and nothing else is lost, less often (up
/// to eighty frames within 0.4 s). At the end the marker is the path that moves and has the right size and brightness,
/// not the brightest one; what rests all the time is part of the scene. Frames in which it is not seen stay without.
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
#include "core/pictures/marker/marker.h"
#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_search.h"

namespace glidelab::core {

class MarkerTracker {
 public:
  /// `start_s`: the time of the frame that the marker's start_px belongs to; nothing: the first frame.
  MarkerTracker(std::filesystem::path clip, MarkerSetup marker, RadiusAt radius_at, std::optional<double> start_s = {});

  /// Of something bright, in grey values, that need not look like a disc: the lit part of a sphere.
  static MarkerTracker of_any_shape(std::filesystem::path clip, const MarkerSetup& marker, RadiusAt radius_at,
                                    std::optional<double> start_s = {});

  /// Windows around sightings take so much memory at most (128 MB); sightings beyond keep what a mosaic or a tone curve
  /// does to them, and a note says how many.
  void limit_windows(std::size_t bytes) { most_window_bytes_ = bytes; }

  /// Takes the next frame. InputError where a hue is to be looked for in a grey clip.
  void add(const Frame& frame);

  /// The marker's track. NoMarker where nothing of its size moves (and not exactly one such thing rests), or where
  /// there is nothing at start_px; InputError where two equal ones move alike and start_px does not say which.
  TrackedMarker finish();

 private:
  using Path = MarkerPath;
  struct Found {
    MarkerGuess guess;
    MarkerFit fit;
  };
  struct Past {
    std::size_t frame;
    Signal signal;
  };

  /// A window around a sighting of some path.
  struct Kept {
    std::size_t frame;
    cv::Point2d centre;
    MarkerWindow window;
  };

  void keep(const Signal& signal, std::size_t frame, const Found& found);
  const MarkerWindow* window_of(const MarkerSighting& sighting) const;
  void fit_without_response(TrackedMarker& tracked) const;
  std::optional<Found> find_again(const Signal& signal, std::size_t frame, const Path& path,
                                  const std::vector<cv::Point2d>& taken) const;
  void accept(Path& path, const Signal& signal, std::size_t frame, const Found& found);
  void follow(const Signal& signal, std::size_t frame);
  void search_whole(const Signal& signal, std::size_t frame);
  void follow_back(Path& path);
  const Path* mover(std::size_t frame) const;
  void put_to_sleep(std::size_t frame);
  void tidy(std::size_t frame);
  void search_rest();
  bool is_time_to_search(const Signal& signal, const Frame& frame) const;
  std::vector<cv::Point2d> places_at(std::size_t frame) const;

  std::filesystem::path clip_;
  MarkerSetup marker_;
  SignalKind kind_;
  RadiusAt radius_at_;
  double radius_px_ = 0.0;  ///< in the middle of the image
  std::vector<Path> paths_;
  std::deque<Past> past_;  ///< since the last search of the whole image
  std::vector<Kept> kept_;
  std::size_t kept_bytes_ = 0, most_window_bytes_ = std::size_t{1} << 27;
  std::size_t searched_ = 0;
  double searched_s_ = 0.0;
  std::size_t frames_ = 0;
  std::optional<double> start_s_;
  std::size_t start_frame_ = 0;  ///< whose time is nearest to start_s_, of those so far
  double from_start_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace glidelab::core
