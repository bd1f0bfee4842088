/// Which of a sweep's points (cameras, settings) reach a target: first by the Cramér-Rao bound, then by runs.
///
/// A target is on the worst configuration of the scenario: its root mean square error, a bias included ("sd": of an
/// unbiased estimator the standard deviation), what 95 % of the errors stay within ("error95"), or the mean error
/// ("bias"); validate/error_measure.h. The bound takes the noise of the sweep's tracks, or predicts it from the camera
/// (validate/camera_noise.h), and is that of the standard deviation, times 1.96 for "error95". A point whose bound is
/// above the target cannot reach it. Any other is run as tracks with that noise and judged by its errors (of the better
/// estimator), for a bound knows nothing of dropped frames. Where rendered clips are to confirm, those that miss the
/// target by less than kClear or reach it by less than kClearOfClips are rendered as well, with lens, shutter, codec
/// and calibration, and these judge. Where the errors' uncertainty spans the target, nothing is decided. Where nothing
/// is run, a bound below the target by kClear is said to have room.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

inline constexpr double kClear = 4.0;
/// Clips of a cheap camera with a compressing codec were seen to err 13 times as much as tracks
/// (docs/evidence/requirements.md).
inline constexpr double kClearOfClips = 20.0;

/// Resamples of the runs' errors that a ± comes from (validate/error_measure.h).
inline constexpr int kResamples = 1000;

struct Target {
  enum class Measure { sd, error95, bias };  ///< sd: root mean square error
  std::string quantity;                      ///< "mu"
  Measure measure = Measure::sd;
  double value = 0.0;
  std::string name() const;  ///< "mu sd 0.0005"
};

/// "mu=0.0005", "k_over_m_1_s:error95=0.01"; InputError for anything else.
Target parse_target(const std::string& text);

enum class Confirm { none, tracks, clips };

/// What is about to be rendered.
struct ConfirmationSize {
  std::uint64_t close = 0, points = 0;  ///< to be rendered, of all
  std::uint64_t recordings = 0;
  double seconds = 0.0;  ///< on the threads asked for, from one recording; what keeps a miss from it takes more
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
  std::optional<double> bound;  ///< empty where the motion does not determine the quantity
  std::optional<double> found;  ///< by runs
  double found_sd = 0.0;        ///< standard deviation of it
  std::size_t runs = 0;         ///< whose errors these are
  std::size_t beyond = 0;       ///< of these, with an error larger than the target's value
  std::string estimator;
};

/// A limitation thought away: how many times smaller the bound of the hardest target then is.
struct Limit {
  std::string name;
  double gain = 1.0;
};

enum class Verdict {
  reached,      ///< by runs
  by_bound,     ///< the bound has room of kClear
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

struct Requirement {
  std::string name;
  std::vector<Target> targets;
  Confirm confirm = Confirm::none;
  std::uint64_t track_runs = 0, runs = 0;
  bool by_price = false;              ///< all have a price; else by pixels a second
  std::vector<Candidate> candidates;  ///< the cheapest first
  bool any_reached() const;
};

/// Judges every point. InputError where the sweep has more than 100,000; what refuses a single point is its verdict.
Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
