/// The errors of replicated tracks of a scenario, stored as a JSON file and compared with later ones (gate.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/result/results.h"
#include "render/scenario/scenario.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {

/// Errors of one quantity over the runs.
struct ErrorRecord {
  std::string configuration, estimator, quantity;
  std::uint64_t runs = 0;
  std::uint64_t answers = 0;
  std::uint64_t covered = 0;  ///< the truth lies within 1.96 stated sd
  double mean = 0.0;
  double sd = 0.0;
  double deviation = 0.0;     ///< mean of |error - mean|
  double deviation_sd = 0.0;  ///< standard deviation of |error - mean|
  double efficiency = 0.0;    ///< (Cramér-Rao bound / rms error)²; 0 if there is no bound
};

/// How the clips of the first estimator were smoothed, over the runs with points that count.
struct SmoothingRecord {
  std::string clip;
  std::uint64_t runs = 0;
  double log_bandwidth = 0.0, log_bandwidth_sd = 0.0;  ///< of ln(h/s): mean, standard deviation
  double log_a_error = 0.0, log_a_error_sd = 0.0;      ///< of ln(rms error of a / (m/s²))
};

struct Baseline {
  std::string scenario;  ///< its text
  double noise_m = 0.0;
  std::uint64_t runs = 0;
  std::optional<std::uint64_t> seed = {};  ///< of the noise; files of earlier versions have none
  std::vector<ErrorRecord> records;
  std::vector<SmoothingRecord> smoothing;
};

struct BaselineOptions {
  double noise_m = 2e-5;
  std::uint64_t runs = 100;
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// All results of one run's tracks, one for each estimator. If the first has no clips, smoothing is not recorded.
using AnalyzeTracks = std::function<std::vector<core::AnalysisResults>(const MadeTracks&)>;

/// Results of each of fit::judged_estimators().
std::vector<core::AnalysisResults> analyze_as_judged(const MadeTracks& made);

/// The errors of each quantity with a true value. All runs list the same quantities in the same order; there is one or
/// more.
std::vector<ErrorRecord> error_records(const std::vector<std::vector<QuantityComparison>>& runs);

Baseline measure_baseline(const render::Scenario& scenario, const std::string& scenario_text,
                          const BaselineOptions& options, const AnalyzeTracks& analyze = analyze_as_judged,
                          const base::Progress& progress = base::no_progress);

/// A seed whose noise differs from the baseline's; for a baseline without a seed, from that of the default seed, 1.
std::uint64_t other_seed(const Baseline& then);

std::string baseline_json(const Baseline& baseline);
/// InputError for a file that --write-baseline did not write, with the first key that is wrong.
Baseline read_baseline(const std::filesystem::path& file);

}  // namespace glidelab::validate
