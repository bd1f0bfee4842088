/// Whether one point of a requirement (requirement.h) reaches its targets, by the Cramér-Rao bound and by runs, and
/// what limits it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/requirement/candidate.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {

/// Everything that determines the bound of one point.
struct Setting {
  render::Scenario scenario;
  std::optional<double> given_noise_m = {};  ///< of tracks; otherwise as expected from the camera
  bool lens_known = false;                   ///< rendered clips are restituted with the true camera
};

/// Noise of a position, clip by clip.
std::vector<double> noise_of(const Setting& setting, const Truth& truth);

/// The worst configuration's Cramér-Rao bound in each target's measure (infinite if the noise is).
std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets);

/// Bound over target, for the hardest target; infinite if the motion does not determine it.
double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets);

/// The factor by which `need` would decrease without one limitation, the largest gain first.
std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets);

/// The runs of one point. Each rendered run takes its own stills and calibrates from them; the runs share the static
/// scene.
class RecordedRuns {
 public:
  /// Tracks or clips, according to RequirementOptions::confirm: at most options.runs of them. All arguments must
  /// outlive this object.
  RecordedRuns(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options)
      : sweep_(sweep), setting_(setting), point_(point), options_(options) {}

  /// Sets the total number of runs to be made; finished runs stay.
  void plan(std::uint64_t runs) { done_.resize(std::max<std::size_t>(done_.size(), runs)); }
  std::uint64_t planned() const { return done_.size(); }
  /// Makes one of the planned runs, if not already made. May be called from any thread, but from at most one per run;
  /// an InputError or NumericalError is thrown by judge().
  void make(std::uint64_t run);
  /// Discards the static scene; it is drawn again when needed.
  void clear_stage() { stage_.reset(); }

  /// Fills `results` (one for each target) with the better estimator's errors over the planned runs, all of which must
  /// have been made, with limits of this confidence; reached, missed (any of them), or undecided.
  Verdict judge(std::vector<TargetResult>& results, double confidence = kConfidence) const;
  /// Plans and makes `runs` on options.jobs threads, and judges.
  Verdict judge_after(std::uint64_t runs, std::vector<TargetResult>& results, double confidence = kConfidence);

  /// Limitations that no bound contains, removed one by one, using the same runs on options.jobs threads (kLimitRuns if
  /// rendered, otherwise all that were planned). Gives the factor by which the errors decrease with a uniform clock
  /// and, if clips are rendered, with a global shutter, with a lossless codec, with the true camera instead of the
  /// calibrated one (not for a rational lens, which the analysis cannot represent), and with the true positions plus
  /// the noise expected from the camera (no lens, no calibration, no tracker).
  std::vector<Limit> limits();

 private:
  using Outcome = std::vector<QuantityComparison>;  ///< of one run, for each estimator
  struct Run {
    Outcome outcome;
    std::exception_ptr error;
    bool made = false;
  };
  Outcome outcome_of(const Setting& setting, std::uint64_t run, Confirm confirm);
  std::vector<Outcome> outcomes_of(const Setting& setting, Confirm confirm, std::uint64_t runs);
  MadeTracks tracks_of(const Setting& setting, const MadeTracks& clean, std::uint64_t run, Confirm confirm);
  std::shared_ptr<const render::Stage> stage();

  const Sweep& sweep_;
  const Setting& setting_;
  std::uint64_t point_;
  const RequirementOptions& options_;
  std::vector<Run> done_;  ///< the first runs of the setting itself
  std::mutex drawing_;
  std::shared_ptr<const render::Stage> stage_;  ///< set once a run has needed it
};

}  // namespace glidelab::validate
