/// One run of a sweep: its scenario is simulated (and filmed), analysed in every way that the sweep names, and
/// compared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "core/result/why_unknown.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// A recovered quantity of one configuration with its truth.
struct QuantityRow {
  std::string configuration;
  std::string estimator;  ///< Analysis::name()
  std::string quantity;   ///< a key of core::kQuantities
  std::optional<double> truth, value, sd, low95, high95;
  std::optional<double> least_sd;       ///< Cramér-Rao bound; only for tracks, whose noise is known
  std::optional<core::WhyUnknown> why;  ///< why there is no value
  /// The value including the smoothing's bias; empty if none was subtracted.
  std::optional<double> uncorrected = {};
};

struct ClipRow {
  std::string clip;
  std::string estimator;
  std::size_t frames = 0, detected = 0;
  double bandwidth_s = 0.0;
  double position_noise_m = 0.0;
  std::optional<double> r2_up, r2_down;    ///< of the line for v < 0, v > 0
  std::optional<double> a_rms_error_m_s2;  ///< of the points that count (validate/made_tracks/oracle_bandwidth.h)
};

struct RunRecord {
  std::uint64_t run = 0, point = 0, replicate = 0, seed = 0;
  std::vector<base::TomlScalar> values;  ///< one for each axis
  bool failed = false;                   ///< scenario, simulation or analysis refused it; `why` gives the reason
  std::string why;
  std::vector<QuantityRow> quantities;
  std::vector<ClipRow> clips;
};

/// Evaluates runs, one after another; one worker for each thread. A run's result does not depend on earlier runs.
class RunWorker {
 public:
  /// `progress` is called often while a recording is made; an exception from it is passed on.
  explicit RunWorker(const Sweep& sweep, base::Progress progress = base::no_progress)
      : sweep_(sweep), progress_(std::move(progress)) {}
  /// InputError and NumericalError of a run are its outcome; EnvironmentError is passed on.
  RunRecord evaluate(std::uint64_t run);

 private:
  void fill(RunRecord& record);
  MadeTracks tracks_for(const RunRecord& record, const std::string& text, const render::Scenario& scenario);
  /// The studio of the record's point, whose stills have the noise of its first run's seed.
  FilmStudio& studio_for(const RunRecord& record, const std::string& text, const render::Scenario& scenario);
  std::shared_ptr<const render::Stage> stage_for(const RunRecord& record, const std::string& text,
                                                 const render::Scenario& scenario);

  const Sweep& sweep_;
  base::Progress progress_;
  // Replicates of one point share their calibration if the sweep says so; drawn values may change the scenario.
  std::uint64_t studio_point_ = 0;
  std::string studio_of_;
  std::unique_ptr<FilmStudio> studio_;
  // The static scene is the same in them anyway.
  std::uint64_t stage_point_ = 0;
  std::string stage_of_;
  std::shared_ptr<const render::Stage> stage_;
  // The motion of replicates of one point is the same, except for random clock errors.
  std::string made_of_;
  MadeTracks made_;
};

}  // namespace glidelab::validate
