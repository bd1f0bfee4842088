#include "validate/study/coverage/interval_coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "base/errors.h"
#include "base/long_work.h"
#include "base/math/angles.h"
#include "base/math/distributions.h"
#include "core/math/quantile.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"
#include "core/result/quantity.h"
#include "fit/estimators.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/made_tracks/outside_runs.h"
#include "validate/random_use.h"
#include "validate/truth/binomial.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

constexpr double kLevel = 0.95;

/// One estimator's answer for one quantity in one replicate.
using Outcome = std::optional<core::Estimate>;

/// The same scenario filmed with another clock of its kind: its rate is off by a normal deviate of the standard
/// deviation that the estimators assume for clocks. Frames are lost as stated by the scenario.
render::Scenario with_other_clock(render::Scenario scenario, std::uint64_t seed) {
  std::mt19937_64 engine = random_engine(RandomUse::clock_rate, seed);
  std::normal_distribution<double> deviate(0.0, core::kClockSdRelative);
  scenario.recording.clock.rate_error_ppm = 1e6 * deviate(engine);
  return scenario;
}

/// The bound including the clock: K/m scales with its rate, accelerations with its square.
LeastSd with_clock(LeastSd least, const TrueConfiguration& truth) {
  const double rate = core::kClockSdRelative;
  if (least.k_over_m_1_s) least.k_over_m_1_s = std::hypot(*least.k_over_m_1_s, rate * truth.k_over_m_1_s.value_or(0.0));
  if (least.mu) least.mu = std::hypot(*least.mu, 2.0 * rate * truth.mu.value_or(0.0));
  if (least.v_lim_m_s) least.v_lim_m_s = std::hypot(*least.v_lim_m_s, rate * truth.v_lim_m_s.value_or(0.0));
  if (least.alpha_deg && truth.alpha_deg) {
    const double by_rate = 2.0 * rate * std::tan(*truth.alpha_deg / base::kDegreesPerRad) * base::kDegreesPerRad;
    least.alpha_deg = std::hypot(*least.alpha_deg, by_rate);
  }
  return least;
}

/// The index among the results' configurations of each true one, identified by its first clip.
std::vector<std::size_t> places_of(const Truth& truth, const core::AnalysisResults& results) {
  std::vector<std::size_t> places;
  for (const TrueConfiguration& configuration : truth.configurations) {
    for (std::size_t i = 0; i < results.configurations.size(); ++i) {
      const std::vector<std::string>& clips = results.configurations[i].clips;
      if (std::find(clips.begin(), clips.end(), configuration.clips.front()) != clips.end()) places.push_back(i);
    }
  }
  return places;
}

LevelCount counted(double level, std::size_t covered, std::size_t n) {
  LevelCount count{level, covered, static_cast<double>(covered) / static_cast<double>(n)};
  const ProportionInterval interval = proportion_interval(covered, n, kLevel);
  count.low95 = interval.low;
  count.high95 = interval.high;
  count.p_value = binomial_p_value(covered, n, level);
  return count;
}

bool holds(const core::Estimate& estimate, double truth, double level) {
  const double ratio = level == kLevel ? 1.0 : arm_ratio(level, 0.5 * (estimate.high95 - estimate.low95), estimate.sd);
  return estimate.value - ratio * (estimate.value - estimate.low95) <= truth &&
         truth <= estimate.value + ratio * (estimate.high95 - estimate.value);
}

void summarise(const std::vector<std::vector<Outcome>>& outcomes, std::size_t place, const std::vector<double>& levels,
               CoverageRow& row) {
  double sum = 0.0, squares = 0.0, stated = 0.0;
  std::vector<std::size_t> covered(levels.size());
  for (const std::vector<Outcome>& replicate : outcomes) {
    const std::optional<core::Estimate>& estimate = replicate[place];
    if (!estimate) continue;
    ++row.determined;
    if (estimate->low95 <= row.truth && row.truth <= estimate->high95) ++row.covered;
    for (std::size_t i = 0; i < levels.size(); ++i) covered[i] += holds(*estimate, row.truth, levels[i]) ? 1 : 0;
    const double error = estimate->value - row.truth;
    sum += error;
    squares += error * error;
    stated += estimate->sd * estimate->sd;
  }
  if (row.determined == 0) return;
  const auto n = static_cast<double>(row.determined);
  row.bias = sum / n;
  row.sd = row.determined > 1 ? std::sqrt(std::max(0.0, squares - n * row.bias * row.bias) / (n - 1.0)) : 0.0;
  row.stated_sd = std::sqrt(stated / n);
  row.coverage = static_cast<double>(row.covered) / n;
  const LevelCount at95 = counted(kLevel, row.covered, row.determined);
  row.low95 = at95.low95;
  row.high95 = at95.high95;
  row.p_value = at95.p_value;
  for (std::size_t i = 0; i < levels.size(); ++i) row.levels.push_back(counted(levels[i], covered[i], row.determined));
  const double mean_square = row.sd * row.sd + row.bias * row.bias;
  if (row.cramer_rao_sd && mean_square > 0.0) row.efficiency = *row.cramer_rao_sd * *row.cramer_rao_sd / mean_square;
}

}  // namespace

std::vector<std::string> coverage_estimators(const std::optional<fit::OutsideTally>& outside) {
  std::vector<std::string> names = fit::estimator_names();
  names.emplace_back(kNaiveLines);
  if (outside) names.push_back(outside->name);
  return names;
}

Coverage measure_coverage(const render::Scenario& scenario, const CoverageOptions& options,
                          const base::Progress& progress) {
  if (options.noise_sd_m && !(std::isfinite(*options.noise_sd_m) && *options.noise_sd_m > 0.0)) {
    throw base::InputError(
        base::Issue{"", 0, "noise", fmt::format("{}", *options.noise_sd_m), "a length in metres above 0"});
  }
  if (options.replicates == 0) {
    throw base::InputError(base::Issue{"", 0, "replicates", "0", "a whole number above 0"});
  }
  for (std::size_t i = 0; i < options.levels.size(); ++i) {
    const double level = options.levels[i];
    if (!(level > 0.0 && level < 1.0)) {
      throw base::InputError(base::Issue{"", 0, "level", fmt::format("{}", level), "a number above 0 and below 1"});
    }
    if (std::count(options.levels.begin(), options.levels.end(), level) > 1) {
      throw base::InputError(base::Issue{"", 0, "level", fmt::format("{} twice", level), "each level once"});
    }
  }
  const MadeTracks clean = make_tracks(with_other_clock(scenario, options.seed), options.seed);
  const std::vector<double> noise_sd_m = options.noise_sd_m
                                             ? std::vector<double>(clean.tracks.size(), *options.noise_sd_m)
                                             : predicted_noise_m(scenario, clean.truth);
  for (const double sd : noise_sd_m) {
    if (std::isfinite(sd) && sd > 0.0) continue;
    throw base::InputError(base::Issue{"", 0, "camera", "an image in which the marker has no edge of its own",
                                       "a marker of two pixels or more that is brighter than the wall, or --noise-m"});
  }
  const std::vector<LeastSd> bounds = least_sds(clean.truth, noise_sd_m, clean.gravity_m_s2);
  const std::size_t configurations = clean.truth.configurations.size();
  std::vector<std::vector<Outcome>> outcomes(options.replicates);
  std::vector<fit::OutsideRun> outside_runs(options.outside ? options.replicates : 0);
  std::atomic<std::size_t> done = 0;
  base::for_each_parallel(options.replicates, options.jobs, [&](std::size_t r) {
    const MadeTracks noisy = with_noise(make_tracks(with_other_clock(scenario, options.seed + r), options.seed + r),
                                        noise_sd_m, options.seed + r);
    const std::vector<fit::Estimator>& wanted = fit::estimators();
    std::vector<core::AnalysisResults> results = fit::estimate_each(wanted, [&](core::LineMethod lines) {
      return analyze_tracks(noisy, core::MotionOptions{.bandwidth_s = options.bandwidth_s, .lines = lines});
    });
    results.push_back(with_naive_lines(results.front()));
    if (options.outside) {
      fit::OutsideOutcome outcome = run_outside_on_tracks(*options.outside, noisy);
      outside_runs[r] = std::move(outcome.run);
      results.push_back(std::move(outcome.results));
    }
    for (const core::AnalysisResults& by : results) {
      const std::vector<std::size_t> places = places_of(clean.truth, by);
      for (std::size_t c = 0; c < configurations; ++c) {
        for (const core::QuantityName& quantity : core::kQuantities)
          outcomes[r].push_back(core::value_of(by.configurations[places[c]], quantity.which).estimate);
      }
    }
    progress("replicates", static_cast<double>(++done) / static_cast<double>(options.replicates));
  });
  Coverage coverage{options.replicates, noise_sd_m, !options.noise_sd_m, options.levels, {}, {}};
  if (options.outside) coverage.outside = fit::tally_of(*options.outside, outside_runs);
  const std::vector<std::string> estimators = coverage_estimators(coverage.outside);
  for (std::size_t c = 0; c < configurations; ++c) {
    for (std::size_t e = 0; e < estimators.size(); ++e) {
      for (std::size_t q = 0; q < core::kQuantities.size(); ++q) {
        const core::QuantityName& quantity = core::kQuantities[q];
        const std::optional<double> truth = core::value_of(clean.truth.configurations[c], quantity.which);
        if (!truth) continue;
        CoverageRow row;
        row.configuration = clean.truth.configurations[c].name;
        row.estimator = estimators[e];
        row.quantity = quantity.key;
        row.truth = *truth;
        const LeastSd bound = with_clock(bounds[c], clean.truth.configurations[c]);
        row.cramer_rao_sd = core::value_of(bound, quantity.which);
        summarise(outcomes, (e * configurations + c) * core::kQuantities.size() + q, options.levels, row);
        coverage.rows.push_back(std::move(row));
      }
    }
  }
  return coverage;
}

CoverageBand band_of(double level, std::size_t n) {
  // The smallest k with P(X <= k) at least `part`.
  const auto quantile = [&](double part) {
    long low = -1, high = static_cast<long>(n);
    while (high - low > 1) {
      const long middle = low + (high - low) / 2;
      (binomial_cdf(middle, n, level) < part ? low : high) = middle;
    }
    return static_cast<double>(high) / static_cast<double>(n);
  };
  return {quantile(0.025), quantile(0.975)};
}

double arm_ratio(double level, double half95, double sd) {
  const double wanted = half95 / sd, upper = 0.5 * (1.0 + level);
  constexpr double kMost = 1e6;  // degrees: practically normal
  if (!(wanted > core::student_t975(kMost))) {
    return base::normal_quantile(upper) / core::kNormal95;
  }
  double low = 1.0, high = kMost;  // t decreases with the degrees
  while (high - low > 1e-9 * high) {
    const double middle = std::sqrt(low * high);
    (core::student_t975(middle) > wanted ? low : high) = middle;
  }
  return base::student_t_quantile(low, upper) / base::student_t_quantile(low, 0.975);
}

namespace {

std::vector<CoverageFailure> significant(const Coverage& coverage, bool below) {
  std::vector<CoverageFailure> judged, failing;
  for (const CoverageRow& row : coverage.rows) {
    if (row.estimator == kNaiveLines || row.determined == 0) continue;
    for (const LevelCount& at : row.levels) judged.push_back({row, at});
  }
  for (const CoverageFailure& one : judged) {
    if (one.at.p_value < 0.01 / static_cast<double>(judged.size()) && (one.at.coverage < one.at.level) == below) {
      failing.push_back(one);
    }
  }
  return failing;
}

}  // namespace

std::vector<CoverageFailure> too_narrow(const Coverage& coverage) {
  return significant(coverage, true);
}

std::vector<CoverageFailure> too_wide(const Coverage& coverage) {
  return significant(coverage, false);
}

}  // namespace glidelab::validate
