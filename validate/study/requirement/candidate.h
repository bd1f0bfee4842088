/// One point of a sweep (a camera, a setting) as judged by a requirement: how it is tested, and the result.
/// report/requirement puts it into words.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validate/study/requirement/target.h"

namespace glidelab::validate {

enum class Confirm { none, tracks, clips };

/// Rendered runs of a point that the bound allows and than which none cheaper reaches the target; twice as many, and so
/// on, if these do not decide.
inline constexpr std::uint64_t kLeastRendered = 2;
/// Rendered runs with each limitation removed, of a point that does not reach the target.
inline constexpr std::uint64_t kLimitRuns = 4;

/// Numbers of rendered runs after which a point is judged: kLeastRendered, twice that, …, `most`.
inline std::vector<std::uint64_t> looks(std::uint64_t most) {
  std::vector<std::uint64_t> sizes = {std::min(kLeastRendered, most)};
  while (sizes.back() < most) sizes.push_back(std::min(2 * sizes.back(), most));
  return sizes;
}

/// Confidence of each limit at one look, such that all looks together err with a probability of at most 1 -
/// kConfidence.
inline double confidence_of_look(std::uint64_t most) {
  return 1.0 - (1.0 - kConfidence) / static_cast<double>(looks(most).size());
}

/// What is about to be rendered. Times are on the requested threads, estimated from one recording.
struct ConfirmationSize {
  std::uint64_t close = 0, points = 0;  ///< points that the bound allows, and all points
  std::uint64_t recordings = 0;         ///< of the cheapest of them, if it is the one to buy
  double seconds = 0.0;                 ///< for these
  double seconds_each = 0.0;            ///< for kLeastRendered of each; points close to the target take longer
};

struct RequirementOptions {
  std::vector<Target> targets;
  Confirm confirm = Confirm::clips;
  std::uint64_t track_runs = 200;  ///< for a point as tracks: one run in a hundred may be far off
  std::uint64_t runs = 20;         ///< for a rendered point, at most
  int jobs = 1;
  std::function<void(const ConfirmationSize&)> before_rendering = {};
  std::function<void()> before_run = {};  ///< called before each; may throw to stop
  /// Called often while a recording is made, from any thread; may throw to stop.
  std::function<void()> watch = [] {};
};

/// Runs in which an estimator found no value of a target's quantity.
struct Unanswered {
  std::string estimator;
  std::size_t runs = 0;
};

/// One target at one point; in the target's unit and measure.
struct TargetResult {
  std::optional<double> bound;   ///< empty if the motion does not determine the quantity
  std::optional<double> found;   ///< by runs
  double found_sd = 0.0;         ///< its standard deviation
  std::size_t runs = 0;          ///< number of runs with these errors
  std::size_t beyond = 0;        ///< of these, with an error larger than the target's value
  std::string estimator;         ///< whose errors these are: the better one's
  double low = 0.0, high = 0.0;  ///< limits of `found` (target.h)
  /// The same from tracks, if rendered runs judge: from many more runs, but with errors of the clock alone.
  std::optional<double> by_tracks = {};
  std::vector<Unanswered> unanswered = {};  ///< of each estimator without a value in some of the runs
};

/// What would suffice instead of a camera that is much better than needed: the errors of its runs as tracks, with one
/// property reduced, times the factor added by rendering.
struct Enough {
  double times = 1.0;  ///< target over error, of the hardest target
  std::optional<double> frame_rate_hz = {};
  std::optional<double> noise_m = {};  ///< of a position
};

/// How frames are compressed.
struct CodecSetting {
  enum class Kind { lossless, mjpeg, h264_quality, h264_bitrate };
  Kind kind = Kind::lossless;
  double value = 0.0;  ///< mjpeg: quality; h264: constant rate factor, or kbit/s
};

/// How a camera should be set.
struct CameraMode {
  int width_px = 0, height_px = 0;
  double exposure_s = 0.0;
  CodecSetting codec = {};
};

/// What may limit a camera, and what it would have instead.
enum class Limitation {
  // Of the bound.
  frame_rate,    ///< kFast_hz, with the same exposure
  light,         ///< no shot noise
  camera_noise,  ///< none
  motion_blur,   ///< none
  resolution,    ///< kFiner times finer
  // Of runs: no bound contains it.
  clock,            ///< even
  rolling_shutter,  ///< global
  codec,            ///< lossless
  calibration,      ///< the true camera
  imaging,          ///< true positions with the expected noise: no lens, no calibration, no tracker
};
inline constexpr double kFast_hz = 1000.0;
inline constexpr double kFiner = 4.0;

/// A hypothetically removed limitation: the factor by which the bound, or the error by runs, of the hardest target then
/// decreases.
struct Limit {
  Limitation what = Limitation::frame_rate;
  double gain = 1.0;
};

enum class Verdict {
  reached,      ///< by runs: `high` of every target is within it
  by_bound,     ///< the bound has room of kClearMargin
  unconfirmed,  ///< the bound allows it, and nothing was run; or tracks reach it, and a cheaper one is the one to buy
  undecided,    ///< by runs: `low` is within the target, `high` is not; or tracks miss what a few rendered runs reach
  missed,       ///< by runs: `low` of a target is beyond it
  impossible,   ///< the bound is above the target
  refused,      ///< the scenario or the analysis rejects it: `why`
};

/// One point of the sweep.
struct Candidate {
  std::string name;  ///< of the camera and the values
  std::string price_class;
  std::optional<double> price;  ///< middle of the range stated in the camera's file
  double pixels_s = 0.0;        ///< width x height x rate
  double frame_rate_hz = 0.0;
  double noise_m = 0.0;  ///< of a position: rms over the clips
  Verdict verdict = Verdict::unconfirmed;
  Confirm judged_by = Confirm::none;  ///< source of the errors in `results`
  std::string why;
  double need = 0.0;                  ///< bound over target, of the hardest target
  std::vector<TargetResult> results;  ///< one for each target
  std::vector<Limit> limits;          ///< a clock that makes most of the error first, then the largest gain
  CameraMode mode = {};
  std::optional<Enough> enough = {};  ///< for the first that reaches the targets, if its errors are kMuchLess times
                                      ///< smaller than allowed
};

}  // namespace glidelab::validate
