/// The paths of objects through a clip, and which of them is the marker's.
#pragma once

#include <opencv2/core.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/experiment/experiment.h"
#include "core/pictures/marker/marker.h"
#include "core/pictures/marker/marker_body.h"
#include "core/pictures/marker/marker_search.h"
#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Expected radius of the marker's image at a pixel, in pixels.
using RadiusAt = std::function<double(cv::Point2d)>;

/// How the object of a path is measured in a frame (marker_method.h).
enum class MarkerMethod { undecided, uniform, shaded, centroid };

struct MarkerSeen {
  std::size_t frame = 0;
  MarkerFit fit;
  double expected_px = 0.0;  ///< radius that the marker should have there

  double size() const { return fit.radius_px / std::max(expected_px, 1e-3); }
};

/// A window around a sighting, kept until the method is chosen.
struct MarkerSample {
  std::size_t frame = 0;
  Signal window;
  cv::Point corner;
  MarkerGuess guess;
};

/// The path of one object through a clip: where it was seen, where it should be next, and what resembles it.
struct MarkerPath {
  std::vector<MarkerSeen> seen;
  std::vector<MarkerSample> samples;
  MarkerMethod method = MarkerMethod::undecided;
  bool ended = false;
  bool asleep = false;  ///< at rest, and considered only when the whole image is searched
  double radius_px = 0.0;
  double amplitude = 0.0;
  double travel_px = 0.0;  ///< largest distance from the first place

  cv::Point2d velocity() const;  ///< pixels a frame, over the last few sightings
  cv::Point2d predict(std::size_t frame) const;
  void push(const MarkerSeen& sighting);
  double size_ratio() const;                               ///< of the radii seen and expected, median
  bool is_like(double radius_px, double amplitude) const;  ///< the same object, judging by size and brightness
  bool is_like(const MarkerFit& fit) const;                ///< and no longer than a streak of motion
};

constexpr double kLargestElongation = 4.0;  ///< a streak of motion may be long

/// The distance from its first position at which a path counts as moving, in pixels.
double least_travel(double radius_px);

double frames_between(std::size_t from, std::size_t to);

/// The paths, joining those of which one ends and another begins later where the first was heading.
std::vector<MarkerPath> joined_pieces(std::vector<MarkerPath> paths);

/// Positions of an object, by frame.
using Places = std::map<std::size_t, cv::Point2d>;

struct PlaceInFrame {
  std::size_t frame = 0;
  cv::Point2d at;
};

/// Where an object is in a frame by the frames next to it: on a quadratic through up to ten of its places there, five
/// on either side. The frames rise. Where it has a place in that frame, this one, unless it is to be `without_itself`.
/// Nothing more than thirty frames beyond the first or the last, and by fewer than three.
std::optional<cv::Point2d> place_by_neighbours(const std::vector<PlaceInFrame>& places, std::size_t frame,
                                               bool without_itself);

/// How far each place lies off where its neighbours say it should be, in units of the median of that: beyond kOffCourse
/// something disturbs it, or the object is pushed. 0 where the neighbours say nothing.
std::vector<double> off_course(const std::vector<PlaceInFrame>& places);
inline constexpr double kOffCourse = 6.0;

/// Standard deviation of a coordinate of the second differences of consecutive frames' places, in pixels; nothing with
/// fewer than four of them.
std::optional<double> jitter_of(const Places& places);

/// The same of the fourth differences, over the root of their weights' squares (1, 4, 6, 4, 1): of a coordinate itself,
/// for a motion leaves next to nothing in them.
std::optional<double> roughness_of(const Places& places);

/// Nothing in the clip is like the marker.
class NoMarker : public base::InputError {
  using base::InputError::InputError;
};

struct TrackedMarker {
  std::vector<MarkerSighting> sightings;  ///< frames rise
  std::vector<MarkerFit> fits;            ///< of each sighting
  std::vector<Note> notes;
  MarkerMethod method = MarkerMethod::undecided;  ///< by which it was measured
  std::optional<MarkerBody> body;                 ///< as which it was fitted, where that is of either kind
};

/// What was followed through a clip.
struct FollowedPaths {
  std::vector<MarkerPath> paths;  ///< joined, each with a method
  std::size_t frames = 0;         ///< of the clip
  double radius_px = 0.0;         ///< that the marker should have in the middle of the image
  std::size_t start_frame = 0;    ///< the one that start_px belongs to
};

/// Which of the paths through a clip is the marker, and in which of its frames it is seen undisturbed.
///
/// The marker is the path nearest to start_px in the frame that it belongs to where that is given; else, of those that
/// move, the one that is most like a marker in size, travel, brightness and number of sightings; else the only one of
/// the right size that rests all the time.
///
/// NoMarker and InputError as MarkerTracker::finish(); `clip` is the file that they name.
TrackedMarker choose_marker(const FollowedPaths& followed, const MarkerSetup& marker,
                            const std::filesystem::path& clip);

}  // namespace glidelab::core
