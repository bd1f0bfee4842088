/// The paths of objects through a clip, and the choice of the marker's path among them.
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
#include "core/pictures/marker/marker_body.h"
#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/marker/marker_search.h"
#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::core {

/// The expected radius of the marker's image at a pixel, in pixels.
using RadiusAt = std::function<double(cv::Point2d)>;

/// How the object of a path is measured in a frame (marker_method.h).
enum class MarkerMethod { undecided, uniform, shaded, centroid };

struct MarkerSeen {
  std::size_t frame = 0;
  MarkerFit fit;
  double expected_px = 0.0;  ///< expected radius at that position

  double size() const { return fit.radius_px / std::max(expected_px, 1e-3); }
};

/// A window around a sighting, kept until a method is chosen.
struct MarkerSample {
  std::size_t frame = 0;
  Signal window;
  cv::Point corner;
  MarkerGuess guess;
};

/// The path of one object through a clip: where it was seen, where it should be next, and which objects resemble it.
struct MarkerPath {
  std::vector<MarkerSeen> seen;
  std::vector<MarkerSample> samples;
  MarkerMethod method = MarkerMethod::undecided;
  bool lit = false;  ///< found as a shaded disc, since no uniform one fits; until a method is chosen
  bool ended = false;
  bool asleep = false;    ///< at rest, and no longer followed
  cv::Point2d from_blob;  ///< from the blob of a lit part, by which it was found, to the centre (px)
  double radius_px = 0.0;
  double amplitude = 0.0;
  double travel_px = 0.0;  ///< largest distance from the first position

  cv::Point2d velocity() const;  ///< pixels per frame, over the last four sightings
  cv::Point2d predict(std::size_t frame) const;
  void push(const MarkerSeen& sighting);
  double size_ratio() const;                               ///< median ratio of the measured radius to the expected one
  bool is_like(double radius_px, double amplitude) const;  ///< whether size and brightness are those of this object
  bool is_like(const MarkerFit& fit) const;                ///< and whether it is no longer than a streak of motion
};

constexpr double kLargestElongation = 4.0;  ///< long axis over short axis: a streak of motion may be long

/// The distance from its first position, in pixels, at which a path counts as moving.
double least_travel(double radius_px);

/// The largest distance from a first position, in pixels, without the jumps. A jump is a step by more than
/// least_travel() beyond what the speed before it or after it explains: the object is not where it was followed any
/// more, but another one like it is. Blobs of the background that come and go are at rest by this, however far apart
/// they are.
double steady_travel(const MarkerPath& path);

double frames_between(std::size_t from, std::size_t to);

/// The paths, with a path that ends joined to a similar one that begins later where the first was heading.
std::vector<MarkerPath> joined_pieces(std::vector<MarkerPath> paths);

/// The positions of an object, by frame.
using Places = std::map<std::size_t, cv::Point2d>;

struct PlaceInFrame {
  std::size_t frame = 0;
  cv::Point2d at;
};

/// The position of an object in a frame by its neighbours: a quadratic through up to ten positions, five on either side
/// or more on one side if the other has fewer. `places` must be in order of frames. If there is a position in the frame
/// itself, the result is that position, unless `without_itself`. Empty for fewer than three neighbours, or more than
/// thirty frames before the first of them or after the last.
std::optional<cv::Point2d> place_by_neighbours(const std::vector<PlaceInFrame>& places, std::size_t frame,
                                               bool without_itself);

/// How far each place lies from where its neighbours expect it, in units of the median of these distances. Beyond
/// kOffCourse something disturbs it, or the object is pushed. 0 for the first and last five, where the course is hardly
/// more than extrapolated, and where the neighbours say nothing.
std::vector<double> off_course(const std::vector<PlaceInFrame>& places);
inline constexpr double kOffCourse = 6.0;

/// The standard deviation, per coordinate, of the second differences of positions in consecutive frames, in pixels.
/// Empty for fewer than four differences.
std::optional<double> jitter_of(const Places& places);

/// The standard deviation of a coordinate itself: the same of the fourth differences, divided by the root sum of
/// squares of their weights (1, 4, 6, 4, 1). A smooth motion leaves next to nothing in them.
std::optional<double> roughness_of(const Places& places);

/// The images of a clip are sound, but the marker is not found in them.
class MarkerNotFound : public base::InputError {
  using base::InputError::InputError;
};

/// Nothing in the clip looks like the marker.
class NoMarker : public MarkerNotFound {
  using MarkerNotFound::MarkerNotFound;
};

/// Two things in the clip look and move alike.
class TwoMarkers : public MarkerNotFound {
  using MarkerNotFound::MarkerNotFound;
};

struct TrackedMarker {
  std::vector<MarkerSighting> sightings;  ///< in order of frames
  std::vector<MarkerFit> fits;            ///< of each sighting
  std::vector<Note> notes;
  MarkerMethod method = MarkerMethod::undecided;  ///< by which the marker was measured
  std::optional<MarkerBody> body;                 ///< as which it was fitted, where that is of either kind
  std::size_t left_out = 0;  ///< sightings whose fit with the response of the pixels fails (kept_windows.h)
};

/// Where it was seen.
Places places_of(const TrackedMarker& marker);

/// The objects that were followed through a clip.
struct FollowedPaths {
  std::vector<MarkerPath> paths;  ///< joined paths, each with a method
  std::size_t frames = 0;         ///< number of frames of the clip
  double radius_px = 0.0;         ///< expected radius in the middle of the image
  std::size_t start_frame = 0;    ///< the frame to which start_px refers
};

/// The distance from start_px within which the marker is, in pixels.
inline double farthest_from_start(double radius_px) {
  return 3.0 * radius_px + 10.0;
}

/// Chooses the path of the marker, and the frames in which the marker is seen undisturbed.
///
/// If start_px is given, the marker is the path nearest to it in the frame to which it refers. Otherwise it is the
/// moving path that is most like a marker in size, travel, brightness and number of sightings. If nothing moves, it is
/// the only object of the right size that is at rest all the time.
///
/// Throws NoMarker and TwoMarkers like MarkerTracker::finish(); `clip` is the file that they name.
TrackedMarker choose_marker(const FollowedPaths& followed, const MarkerSetup& marker,
                            const std::filesystem::path& clip);

}  // namespace glidelab::core
