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
#include "validate/study/requirement/candidate.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/tracks/made_tracks.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {

/// All that the bound of one point rests on.
struct Setting {
  render::Scenario scenario;
  std::optional<double> given_noise_m = {};  ///< of tracks; else as the camera lets one expect
  bool lens_known = false;                   ///< rendered clips are restituted with the true camera
};

/// Of a position, clip by clip.
std::vector<double> noise_of(const Setting& setting, const Truth& truth);

/// The worst configuration's Cramér-Rao bound in each target's measure (infinite where the noise is).
std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets);

/// Bound over target, of the hardest target; infinite where the motion does not determine it.
double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets);

/// How many times smaller `need` were without one limitation, the largest gain first.
std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets);

/// The runs of one point. Each rendered one takes stills of its own and calibrates from them; they share what stands
/// still before the camera.
class RecordedRuns {
 public:
  /// As RequirementOptions::confirm says, tracks or clips: options.runs of them at most. All outlive this.
  RecordedRuns(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options)
      : sweep_(sweep), setting_(setting), point_(point), options_(options) {}

  /// How many runs are to be made in all; those that were made stay.
  void plan(std::uint64_t runs) { done_.resize(std::max<std::size_t>(done_.size(), runs)); }
  std::uint64_t planned() const { return done_.size(); }
  /// Makes one of the planned runs, if it was not made before. For any thread, at most one for each run; an InputError
  /// or NumericalError comes out of judge().
  void make(std::uint64_t run);
  /// What stands still is forgotten; it is drawn again where it is needed.
  void clear_stage() { stage_.reset(); }

  /// Fills `results` (one for each target) with the better estimator's errors over the planned runs, all of which were
  /// made, with limits of this confidence; reached, missed (any of them), or undecided.
  Verdict judge(std::vector<TargetResult>& results, double confidence = kConfidence) const;
  /// Plans and makes `runs` on options.jobs threads, and judges.
  Verdict judge_after(std::uint64_t runs, std::vector<TargetResult>& results, double confidence = kConfidence);

  /// Limitations that no bound contains, removed one by one, by the same runs on options.jobs threads (of rendered ones
  /// kLimitRuns): how many times smaller the errors are with an even clock; and, where clips are rendered, with a
  /// global shutter, with a lossless codec, with the true camera in place of the calibrated one (not of a rational
  /// lens, which the analysis cannot write), and with the true positions and the noise that the camera lets one expect
  /// (no lens, no calibration, no tracker).
  std::vector<Limit> limits();

 private:
  using Outcome = std::vector<QuantityComparison>;  ///< of one run, by each estimator
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
  std::vector<Run> done_;  ///< of the setting itself, the first runs
  std::mutex drawing_;
  std::shared_ptr<const render::Stage> stage_;  ///< once a run needed it
};

}  // namespace glidelab::validate
