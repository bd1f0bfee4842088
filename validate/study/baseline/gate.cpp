#include "validate/study/baseline/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/errors.h"
#include "base/math/distributions.h"
#include "core/result/results.h"
#include "validate/made_tracks/outside_runs.h"

namespace glidelab::validate {
namespace {

bool same(const ErrorRecord& a, const ErrorRecord& b) {
  return a.configuration == b.configuration && a.estimator == b.estimator && a.quantity == b.quantity;
}

bool same_clip(const SmoothingRecord& a, const SmoothingRecord& b) {
  return a.clip == b.clip;
}

std::string name_of(const ErrorRecord& record) {
  return fmt::format("{} {} {}", record.configuration, record.estimator, record.quantity);
}

/// Of one of two samples.
struct Side {
  double mean, sd, count;
};

/// One-sided p for the hypothesis that the mean is now no larger, by Welch's t test.
double p_of_mean(const Side& then, const Side& now) {
  const double a = then.sd * then.sd / then.count, b = now.sd * now.sd / now.count;
  const double more = now.mean - then.mean;
  if (a + b == 0.0) return more > 0.0 ? 0.0 : 1.0;
  const double degrees = (a + b) * (a + b) / (a * a / (then.count - 1.0) + b * b / (now.count - 1.0));
  return base::student_t_tail(degrees, more / std::sqrt(a + b));
}

double p_of_spread(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({then.deviation, then.deviation_sd, static_cast<double>(then.answers)},
                   {now.deviation, now.deviation_sd, static_cast<double>(now.answers)});
}

/// p for the hypothesis that the mean error is now no farther from zero.
double p_of_bias(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({std::abs(then.mean), then.sd, static_cast<double>(then.answers)},
                   {std::abs(now.mean), now.sd, static_cast<double>(now.answers)});
}

/// One-sided p for the hypothesis that the proportion is now no smaller.
double p_of_proportion(std::uint64_t then, std::uint64_t of_then, std::uint64_t now, std::uint64_t of_now) {
  const double n = static_cast<double>(of_then), m = static_cast<double>(of_now);
  const double pooled = static_cast<double>(then + now) / (n + m);
  const double variance = pooled * (1.0 - pooled) * (1.0 / n + 1.0 / m);
  if (variance == 0.0) return 1.0;
  const double fewer = static_cast<double>(then) / n - static_cast<double>(now) / m;
  return base::normal_tail(fewer / std::sqrt(variance));
}

[[noreturn]] void reject(const std::string& key, const std::string& found, const std::string& expected) {
  throw base::InputError(base::Issue{"baseline", 0, key, found, expected});
}

/// Checks that both are of the same scenario, noise, quantities and clips.
void check_alike(const Baseline& then, const Baseline& now) {
  if (then.scenario != now.scenario) reject("scenario", "another scenario", "the scenario that it was made with");
  if (then.noise_m != now.noise_m) {
    reject("noise_m", fmt::format("{}", now.noise_m), fmt::format("{} as in the baseline", then.noise_m));
  }
  const auto check = [](const auto& some, const auto& others, const auto& is_same, const char* found, const char* what,
                        const auto& name) {
    for (const auto& one : some) {
      if (std::any_of(others.begin(), others.end(), [&](const auto& other) { return is_same(one, other); })) continue;
      reject(name(one), found, what);
    }
  };
  const auto clip_of = [](const SmoothingRecord& record) { return record.clip; };
  check(now.records, then.records, same, "nothing in the baseline", "a quantity of both", name_of);
  check(now.smoothing, then.smoothing, same_clip, "nothing in the baseline", "a clip of both", clip_of);
  check(then.records, now.records, same, "nothing now", "a quantity of both", name_of);
  check(then.smoothing, now.smoothing, same_clip, "nothing now", "a clip of both", clip_of);
}

/// The comparison's level for each of its tests, so that all together have that of the comparison.
double level_of(const BaselineComparison& comparison) {
  return comparison.significance / static_cast<double>(comparison.tests);
}

constexpr std::size_t kTestsOfQuantity = 4, kTestsOfClip = 2;

void compare_quantity(const ErrorRecord& then, const ErrorRecord& now, BaselineComparison& comparison) {
  const auto judge = [&](const char* what, double p, double value_then, double value_now) {
    if (p >= level_of(comparison)) return;
    comparison.worse.push_back({then.configuration, then.estimator, then.quantity, what, value_then, value_now, p});
  };
  const auto part = [](std::uint64_t some, std::uint64_t all) {
    return static_cast<double>(some) / static_cast<double>(all);
  };
  judge("answers", p_of_proportion(then.answers, then.runs, now.answers, now.runs), part(then.answers, then.runs),
        part(now.answers, now.runs));
  if (then.answers < 2 || now.answers < 2) return;
  judge("spread", p_of_spread(then, now), then.deviation, now.deviation);
  judge("bias", p_of_bias(then, now), then.mean, now.mean);
  judge("coverage", p_of_proportion(then.covered, then.answers, now.covered, now.answers),
        part(then.covered, then.answers), part(now.covered, now.answers));
}

/// Errors of a(t) may not grow; the bandwidth may change in neither direction.
void compare_smoothing(const SmoothingRecord& then, const SmoothingRecord& now, BaselineComparison& comparison) {
  if (then.runs < 2 || now.runs < 2) return;
  const auto judge = [&](const char* quantity, const char* what, double p, double log_then, double log_now) {
    if (p >= level_of(comparison)) return;
    comparison.worse.push_back({then.clip, core::name_of(core::LineMethod::ordinary), quantity, what,
                                std::exp(log_then), std::exp(log_now), p});
  };
  const auto n = static_cast<double>(then.runs), m = static_cast<double>(now.runs);
  judge("a", "rms error",
        p_of_mean({then.log_a_error, then.log_a_error_sd, n}, {now.log_a_error, now.log_a_error_sd, m}),
        then.log_a_error, now.log_a_error);
  const Side h_then{then.log_bandwidth, then.log_bandwidth_sd, n}, h_now{now.log_bandwidth, now.log_bandwidth_sd, m};
  judge("bandwidth", "mean", std::min(1.0, 2.0 * std::min(p_of_mean(h_then, h_now), p_of_mean(h_now, h_then))),
        then.log_bandwidth, now.log_bandwidth);
  const double sd = then.log_bandwidth_sd * std::sqrt(1.0 / n + 1.0 / m);
  if (!(sd > 0.0)) return;
  const double power = base::normal_cdf(std::log(2.0) / sd - base::normal_upper_quantile(0.5 * level_of(comparison)));
  comparison.power_doubled = std::min(comparison.power_doubled, power);
}

/// The power to detect a spread larger by a factor of 1.5, and a bias of half a standard deviation.
void tell_power(double runs_then, double runs_now, BaselineComparison& comparison) {
  if (!(runs_now > 2.0 && runs_then > 2.0)) return;
  constexpr double kErrorFactorToFind = 1.5, kBiasToFind_sd = 0.5;
  const double needed = base::normal_upper_quantile(level_of(comparison));
  // For |z|, z standard normal: mean sqrt(2/pi), standard deviation sqrt(1 - 2/pi).
  constexpr double kMean = 0.7978845608, kSd = 0.6028102750;
  comparison.power_spread =
      base::normal_cdf((kErrorFactorToFind - 1.0) * kMean /
                           (kSd * std::sqrt(kErrorFactorToFind * kErrorFactorToFind / runs_now + 1.0 / runs_then)) -
                       needed);
  comparison.power_bias = base::normal_cdf(kBiasToFind_sd / std::sqrt(1.0 / runs_now + 1.0 / runs_then) - needed);
}

}  // namespace

BaselineComparison compare_baselines(const Baseline& then, const Baseline& now) {
  check_alike(then, now);
  BaselineComparison comparison;
  comparison.tests = kTestsOfQuantity * then.records.size() + kTestsOfClip * then.smoothing.size();
  for (const ErrorRecord& before : then.records) {
    const auto is_same = [&](const ErrorRecord& record) { return same(record, before); };
    compare_quantity(before, *std::find_if(now.records.begin(), now.records.end(), is_same), comparison);
  }
  comparison.power_doubled = then.smoothing.empty() ? 0.0 : 1.0;
  for (const SmoothingRecord& before : then.smoothing) {
    const auto is_same = [&](const SmoothingRecord& record) { return same_clip(record, before); };
    compare_smoothing(before, *std::find_if(now.smoothing.begin(), now.smoothing.end(), is_same), comparison);
  }
  tell_power(static_cast<double>(then.runs), static_cast<double>(now.runs), comparison);
  return comparison;
}

namespace {

double z_above(double part) {
  return base::normal_upper_quantile(part);
}

/// The factor f of the header, the larger root of its square; empty if no factor is large enough.
std::optional<double> factor_of(double mean, double sd, double z, double n, double m) {
  const double d2 = mean * mean, now = z * z * sd * sd / n, then = z * z * sd * sd / m;
  if (!(d2 > now)) return std::nullopt;
  return (d2 + std::sqrt(d2 * d2 - (d2 - now) * (d2 - then))) / (d2 - now);
}

std::uint64_t rounded_up(double runs) {
  return static_cast<std::uint64_t>(std::ceil(runs));
}

/// Number of answers, both then and now, needed to detect errors `factor` times as large.
std::uint64_t answers_for(double factor, double z, const ErrorRecord& before) {
  const double needed = z * before.deviation_sd / ((factor - 1.0) * before.deviation);
  return rounded_up(needed * needed * (factor * factor + 1.0));
}

/// The same for a logarithm with this standard deviation.
std::uint64_t logs_for(double factor, double z, double sd) {
  const double needed = z * sd / std::log(factor);
  return rounded_up(2.0 * needed * needed);
}

}  // namespace

std::vector<Detectable> detectable(const Baseline& then, const Baseline& now, const BaselineComparison& comparison) {
  std::vector<Detectable> all;
  const double level = comparison.significance / static_cast<double>(comparison.tests);
  const double found = z_above(1.0 - kDetectionProbability);
  const double one_sided = z_above(level), two_sided = z_above(0.5 * level), z = one_sided + found;
  for (const ErrorRecord& before : then.records) {
    const auto same_now = std::find_if(now.records.begin(), now.records.end(), [&](const ErrorRecord& record) {
      return record.configuration == before.configuration && record.estimator == before.estimator &&
             record.quantity == before.quantity;
    });
    if (same_now == now.records.end() || before.answers < 2 || same_now->answers < 2 || !(before.deviation > 0.0))
      continue;
    const auto n = static_cast<double>(same_now->answers), m = static_cast<double>(before.answers);
    Detectable of{before.configuration, before.estimator, before.quantity, {}, {}, 0, 0};
    of.factor = factor_of(before.deviation, before.deviation_sd, z, n, m);
    of.bias = z * before.sd * std::sqrt(1.0 / n + 1.0 / m);
    of.runs_for_weak = answers_for(kWeakFactor, z, before);
    of.runs_for_small = answers_for(kSmallFactor, z, before);
    all.push_back(std::move(of));
  }
  for (const SmoothingRecord& before : then.smoothing) {
    const auto same_now = std::find_if(now.smoothing.begin(), now.smoothing.end(),
                                       [&](const SmoothingRecord& record) { return record.clip == before.clip; });
    if (same_now == now.smoothing.end() || before.runs < 2 || same_now->runs < 2) continue;
    const double root = std::sqrt(1.0 / static_cast<double>(same_now->runs) + 1.0 / static_cast<double>(before.runs));
    const auto add = [&](const char* quantity, double sd, double z_level) {
      all.push_back({before.clip, core::name_of(core::LineMethod::ordinary), quantity,
                     std::exp((z_level + found) * sd * root), std::nullopt, logs_for(kWeakFactor, z_level + found, sd),
                     logs_for(kSmallFactor, z_level + found, sd)});
    };
    add("a", before.log_a_error_sd, one_sided);
    add("bandwidth", before.log_bandwidth_sd, two_sided);
  }
  return all;
}

namespace {

/// The baseline, if its errors can be compared with those of these options.
Baseline comparable_baseline(const std::string& text, const std::string& file, const GateOptions& options) {
  Baseline then = read_baseline(options.baseline);
  const auto refuse = [&](const char* key, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{options.baseline.string(), 0, key, found, expected});
  };
  if (then.scenario != text) {
    refuse("scenario", "the text of another scenario",
           fmt::format("that of {}, unchanged since the baseline was written", file));
  }
  if (options.noise_m && *options.noise_m != then.noise_m) {
    refuse("--noise-m", fmt::format("{}", *options.noise_m),
           fmt::format("{}, as for the baseline, or the option left out", then.noise_m));
  }
  if (then.seed && options.seed == then.seed) {
    refuse("--seed", fmt::format("{}, with which the baseline was made", *then.seed),
           "another seed, or the option left out: with the same noise an unchanged analysis would prove nothing");
  }
  return then;
}

}  // namespace

Gate run_gate(const render::Scenario& scenario, const std::string& text, const std::string& file,
              const GateOptions& options, const base::Progress& progress) {
  Gate gate;
  if (!options.baseline.empty()) gate.then = comparable_baseline(text, file, options);
  BaselineOptions how;
  how.noise_m = gate.then ? gate.then->noise_m : options.noise_m.value_or(how.noise_m);
  how.runs = options.runs;
  how.seed = options.seed.value_or(gate.then ? other_seed(*gate.then) : how.seed);
  how.jobs = options.jobs;
  std::vector<fit::OutsideRun> outside_runs;
  std::mutex adding;
  const AnalyzeTracks by_outside = [&](const MadeTracks& made) {
    fit::OutsideOutcome outcome = run_outside_on_tracks(*options.outside, made);
    const std::lock_guard lock(adding);
    outside_runs.push_back(std::move(outcome.run));
    return std::vector<core::AnalysisResults>{std::move(outcome.results)};
  };
  gate.now = measure_baseline(scenario, text, how, options.outside ? by_outside : analyze_as_judged, progress);
  if (options.outside) gate.outside = fit::tally_of(*options.outside, outside_runs);
  return gate;
}

Gate compared(Gate gate) {
  if (!gate.then) return gate;
  gate.comparison = compare_baselines(*gate.then, gate.now);
  gate.detectable = detectable(*gate.then, gate.now, *gate.comparison);
  return gate;
}

}  // namespace glidelab::validate
