/// Do the stated intervals hold the truth as often as they say, and how near is each estimator to the bound?
///
/// A scenario's motions are made and analysed in many replicates that differ in the positions' noise and in the rate of
/// the camera's clock (made_tracks.h; frames are lost and doubled as the scenario says); each estimator sees the same
/// ones. Of n intervals of 95 % the number that hold the truth is binomial.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "render/scenario.h"

namespace glidelab::validate {

struct CoverageOptions {
  std::size_t replicates = 1000;
  /// Of each position, white and normal, above 0; left out, each clip's is the least that the scenario's camera allows
  /// (camera_noise.h).
  std::optional<double> noise_sd_m = {};
  std::optional<double> bandwidth_s = {};
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// One quantity of one configuration by one estimator ("phase-diagram", "phase-diagram-gls", "trajectory",
/// "naive-lines").
struct CoverageRow {
  std::string configuration;
  std::string estimator;
  std::string quantity;
  double truth = 0.0;
  std::size_t determined = 0;  ///< replicates in which the estimator gave a value
  std::size_t covered = 0;     ///< of these, intervals that hold the truth
  double bias = 0.0;           ///< mean error
  double sd = 0.0;             ///< of the values over the replicates
  double stated_sd = 0.0;      ///< root mean square of the sd that the estimator states
  double coverage = 0.0;       ///< covered / determined
  double low95 = 0.0;          ///< exact binomial interval of the coverage (Clopper and Pearson 1934)
  double high95 = 0.0;
  double p_value = 1.0;  ///< of a count as far from 0.95, two-sided
  std::optional<double> cramer_rao_sd;
  std::optional<double> efficiency;  ///< cramer_rao_sd² / (sd² + bias²)
};

struct Coverage {
  std::size_t replicates = 0;
  std::vector<double> noise_sd_m;  ///< of each clip
  bool camera_noise = false;       ///< as the camera allows, not as given
  std::vector<CoverageRow> rows;
};

/// InputError for a noise or a number of replicates that is not above 0, and for a camera that cannot see the marker.
Coverage measure_coverage(const render::Scenario& scenario, const CoverageOptions& options,
                          const base::Progress& progress = base::no_progress);

/// Intervals of estimators other than the naive one that hold the truth less often than they say, or more often (they
/// are wider than they need be), at the 1 % level corrected for the number of rows (Bonferroni).
std::vector<CoverageRow> too_narrow(const Coverage& coverage);
std::vector<CoverageRow> too_wide(const Coverage& coverage);

}  // namespace glidelab::validate
