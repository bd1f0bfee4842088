/// Whether one point of a requirement (requirement.h) reaches its targets, by the Cramér-Rao bound and by runs, and
/// what limits it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "render/scenario/scenario.h"
#include "validate/film/film_studio.h"
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

/// The runs of one point, on options.jobs threads. Rendered ones share what stands still and kLeastRendered
/// calibrations, each with the noise of its own stills, as the recordings of some afternoons do.
class RecordedRuns {
 public:
  /// As RequirementOptions::confirm says, tracks or clips: options.runs of them at most. All outlive this.
  RecordedRuns(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options)
      : sweep_(sweep), setting_(setting), point_(point), options_(options) {}

  /// Fills `results` (one for each target) with the better estimator's errors over the runs; reached, missed (any of
  /// them), or undecided. Of tracks all runs; rendered ones until they decide.
  Verdict judge(std::vector<TargetResult>& results);
  /// The same with all runs.
  Verdict judge_all(std::vector<TargetResult>& results) { return judge(setting_, options_.runs, results); }

  /// Limitations that no bound contains, removed one by one, by the same runs (of rendered ones the first
  /// kLeastRendered): how many times smaller the errors are with an even clock; and, where clips are rendered, with a
  /// global shutter, with a lossless codec, with the true camera in place of the calibrated one (not of a rational
  /// lens, which the analysis cannot write), and with the true positions and the noise that the camera lets one expect
  /// (no lens, no calibration, no tracker).
  std::vector<Limit> limits();

 private:
  using Outcome = std::vector<QuantityComparison>;  ///< of one run, by each estimator
  Verdict judge(const Setting& setting, std::uint64_t runs, std::vector<TargetResult>& results);
  Outcome outcome_of(const Setting& setting, std::uint64_t run, Confirm confirm);
  void run_on(const Setting& setting, Confirm confirm, std::uint64_t runs, std::vector<Outcome>& done);
  MadeTracks tracks_of(const Setting& setting, const MadeTracks& clean, std::uint64_t run, Confirm confirm);

  const Sweep& sweep_;
  const Setting& setting_;
  std::uint64_t point_;
  const RequirementOptions& options_;
  std::vector<Outcome> done_;  ///< of the setting itself, the first runs
  /// A camera with its calibration: run r is filmed by number r % kLeastRendered, one at a time, once it is there.
  struct Studio {
    std::mutex busy;
    std::unique_ptr<FilmStudio> studio;
  };
  std::array<Studio, kLeastRendered> studios_;
  std::shared_ptr<const render::Stage> stage_;  ///< once any was
};

}  // namespace glidelab::validate
