/// One point of a sweep (a camera, a setting) as a requirement judges it: how it is tried, and the result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validate/study/requirement/target.h"

namespace glidelab::validate {

enum class Confirm { none, tracks, clips };

/// Rendered runs of every point that the bound allows; twice as many, and so on, where these do not decide.
inline constexpr std::uint64_t kLeastRendered = 2;
/// Rendered runs with each limitation removed, of a point that does not reach the target.
inline constexpr std::uint64_t kLimitRuns = 4;

/// Numbers of rendered runs after which a point is judged: kLeastRendered, twice that, …, `most`.
std::vector<std::uint64_t> looks(std::uint64_t most);

/// Of each limit at one look, so that all looks together err with a probability of 1 - kConfidence at most.
double confidence_of_look(std::uint64_t most);

/// What is about to be rendered.
struct ConfirmationSize {
  std::uint64_t close = 0, points = 0;  ///< to be rendered, of all
  std::uint64_t recordings = 0;         ///< kLeastRendered of each, and all those of one, the one to buy
  double seconds = 0.0;  ///< on the threads asked for, from one recording; what is close to the target takes longer
};

struct RequirementOptions {
  std::vector<Target> targets;
  Confirm confirm = Confirm::clips;
  std::uint64_t track_runs = 200;  ///< of a point as tracks: one run in a hundred may be far off
  std::uint64_t runs = 20;         ///< of a point that is rendered, at most
  int jobs = 1;
  std::function<void(const ConfirmationSize&)> before_rendering = {};
  std::function<void()> before_run = {};  ///< called before each; may throw to stop
  /// Called often while a recording is made, from any thread; may throw to stop.
  std::function<void()> watch = [] {};
};

/// One target at one point; in the target's unit and measure.
struct TargetResult {
  std::optional<double> bound;  ///< empty if the motion does not determine the quantity
  std::optional<double> found;  ///< by runs
  double found_sd = 0.0;        ///< standard deviation of it
  std::size_t runs = 0;         ///< whose errors these are
  std::size_t beyond = 0;       ///< of these, with an error larger than the target's value
  std::string estimator;
  double low = 0.0, high = 0.0;  ///< limits of `found` (target.h)
  /// The same as tracks, where rendered runs judge: of many more runs, and of the clock alone.
  std::optional<double> by_tracks = {};
};

/// What would do in place of a camera that errs much less than it may: the errors of its runs as tracks, with less of
/// one thing, times what rendering adds to them.
struct Enough {
  double times = 1.0;  ///< target over error, of the hardest target
  std::optional<double> frame_rate_hz = {};
  std::optional<double> noise_m = {};  ///< of a position
};

/// How a camera is to be set.
struct CameraMode {
  int width_px = 0, height_px = 0;
  double exposure_s = 0.0;
  std::string codec;
};

/// A limitation removed in thought: how many times smaller the bound of the hardest target then is.
struct Limit {
  std::string name;
  double gain = 1.0;
};

enum class Verdict {
  reached,      ///< by runs: `high` of every target is within it
  by_bound,     ///< the bound has room of kClearMargin
  unconfirmed,  ///< the bound allows it, and nothing was run
  undecided,    ///< by runs: `low` is within the target, `high` is not; or tracks miss what few rendered runs reach
  missed,       ///< by runs: `low` of a target is beyond it
  impossible,   ///< the bound is above the target
  refused,      ///< the scenario or the analysis refuses it: `why`
};

/// One point of the sweep.
struct Candidate {
  std::string name;  ///< of the camera and the values
  std::string price_class;
  std::optional<double> price;  ///< middle of the range that the camera's file states
  double pixels_s = 0.0;        ///< width x height x rate
  double frame_rate_hz = 0.0;
  double noise_m = 0.0;  ///< of a position: root mean square over the clips
  Verdict verdict = Verdict::unconfirmed;
  Confirm judged_by = Confirm::none;  ///< whose errors `results` has
  std::string why;
  double need = 0.0;                  ///< bound over target, of the hardest target
  std::vector<TargetResult> results;  ///< one for each target
  std::vector<Limit> limits;          ///< the largest gain first
  CameraMode mode = {};
  std::optional<Enough> enough = {};  ///< of the first that reaches the targets, where it errs kMuchLess times less
};

/// "reached, by clips", "impossible", …
std::string describe(const Candidate& candidate);

}  // namespace glidelab::validate
