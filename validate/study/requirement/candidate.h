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

/// What is about to be rendered.
struct ConfirmationSize {
  std::uint64_t close = 0, points = 0;  ///< to be rendered, of all
  std::uint64_t recordings = 0;
  double seconds = 0.0;  ///< on the threads asked for, from one recording; finding what limits a miss takes longer
};

struct RequirementOptions {
  std::vector<Target> targets;
  Confirm confirm = Confirm::tracks;
  std::uint64_t track_runs = 200;  ///< of a point as tracks: one run in a hundred may be far off
  std::uint64_t runs = 12;         ///< of a point that is rendered
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
};

/// A limitation removed in thought: how many times smaller the bound of the hardest target then is.
struct Limit {
  std::string name;
  double gain = 1.0;
};

enum class Verdict {
  reached,      ///< by runs
  by_bound,     ///< the bound has room of kClearMargin
  unconfirmed,  ///< the bound allows it, and nothing was run
  undecided,    ///< by runs: found - found_sd is within the target, found + found_sd is not
  missed,       ///< by runs
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
};

/// "reached, by clips", "impossible", …
std::string describe(const Candidate& candidate);

}  // namespace glidelab::validate
