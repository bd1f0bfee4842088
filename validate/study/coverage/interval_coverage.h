/// Do the stated intervals contain the truth as often as stated, and how close is each estimator to the bound?
///
/// A scenario's motions are made and analysed in many replicates that differ in the positions' noise and in the rate of
/// the camera's clock (made_tracks.h; frames are lost and doubled as the scenario says); each estimator sees the same
/// ones. Of n intervals of a level, the number that contain the truth is binomial. The interval of a level other than
/// 95 % is the stated one with its arms scaled by the quantiles of Student's t, for the degrees of freedom implied by
/// the stated interval and its standard deviation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "fit/outside/outside_estimator.h"
#include "render/scenario/scenario.h"
#include "validate/study/coverage/naive_lines.h"

namespace glidelab::validate {

struct CoverageOptions {
  std::size_t replicates = 1000;
  /// For each position, white and normal, above 0. If left out, the noise of each clip is the smallest that the
  /// scenario's camera allows (made_tracks.h).
  std::optional<double> noise_sd_m = {};
  std::optional<double> bandwidth_s = {};
  std::vector<double> levels = {0.50, 0.68, 0.90, 0.95, 0.99};  ///< of the intervals counted
  std::uint64_t seed = 1;
  int jobs = 1;
  std::optional<fit::OutsideEstimator> outside = {};  ///< also counted
};

/// Intervals of one level; `determined` of its row is n.
struct LevelCount {
  double level = 0.95;
  std::size_t covered = 0;  ///< number that contain the truth
  double coverage = 0.0;
  double low95 = 0.0, high95 = 0.0;  ///< exact binomial interval of the coverage (Clopper and Pearson 1934)
  double p_value = 1.0;              ///< of a count at least as far from the level, two-sided
};

/// All counted estimators, in the order of their rows: fit/estimators.h, the naive lines, and an outside one.
std::vector<std::string> coverage_estimators(const std::optional<fit::OutsideTally>& outside = {});

/// One quantity of one configuration by one of coverage_estimators().
struct CoverageRow {
  std::string configuration;
  std::string estimator;
  std::string quantity;
  double truth = 0.0;
  std::size_t determined = 0;  ///< replicates in which the estimator gave a value
  std::size_t covered = 0;     ///< of these, intervals that contain the truth
  double bias = 0.0;           ///< mean error
  double sd = 0.0;             ///< of the values over the replicates
  double stated_sd = 0.0;      ///< rms of the sd stated by the estimator
  double coverage = 0.0;       ///< covered / determined
  double low95 = 0.0;          ///< exact binomial interval of the coverage (Clopper and Pearson 1934)
  double high95 = 0.0;
  double p_value = 1.0;                 ///< of a count at least as far from 0.95, two-sided
  std::vector<LevelCount> levels = {};  ///< one for each of Coverage::levels; the four values above are for 95 %
  std::optional<double> cramer_rao_sd;
  std::optional<double> efficiency;  ///< cramer_rao_sd² / (sd² + bias²)
};

struct Coverage {
  std::size_t replicates = 0;
  std::vector<double> noise_sd_m;  ///< of each clip
  bool camera_noise = false;       ///< set by the camera, not given
  std::vector<double> levels = {};
  std::vector<CoverageRow> rows;
  std::optional<fit::OutsideTally> outside = {};
};

/// InputError for a noise or a number of replicates that is not above 0, for a level that is not between 0 and 1 or
/// occurs twice, and for a camera that cannot see the marker.
Coverage measure_coverage(const render::Scenario& scenario, const CoverageOptions& options,
                          const base::Progress& progress = base::no_progress);

/// Intervals of one row and one level that do not contain the truth as often as stated.
struct CoverageFailure {
  CoverageRow row;
  LevelCount at;
};

/// Intervals of estimators other than kNaiveLines that contain the truth less often than stated, or more often (they
/// are wider than necessary), at the 1 % level corrected for the number of rows and levels (Bonferroni).
std::vector<CoverageFailure> too_narrow(const Coverage& coverage);
std::vector<CoverageFailure> too_wide(const Coverage& coverage);

/// The range that contains at least 95 % of the fractions k / n, for n intervals that contain the truth with
/// probability `level`: the exact binomial quantiles of 2.5 and 97.5 %.
struct CoverageBand {
  double low = 0.0, high = 1.0;
};
CoverageBand band_of(double level, std::size_t n);

/// The half width of an interval of this level over that of the 95 % interval, which is `half95` for the standard
/// deviation `sd`: a ratio of quantiles of Student's t. Both are above 0; half95 is at least kNormal95 sd, except for
/// rounding.
double arm_ratio(double level, double half95, double sd);

}  // namespace glidelab::validate
