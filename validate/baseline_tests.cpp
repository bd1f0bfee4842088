// The comparison of two baselines: one-sided tests of each error's spread, bias, coverage and answers, and of
// smoothing.
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/errors.h"
#include "validate/baseline.h"

namespace glidelab::validate {
namespace {

using boost::math::cdf;
using boost::math::complement;
using boost::math::quantile;

bool same(const ErrorRecord& a, const ErrorRecord& b) {
  return a.configuration == b.configuration && a.estimator == b.estimator && a.quantity == b.quantity;
}

std::string name_of(const ErrorRecord& record) {
  return fmt::format("{} {} {}", record.configuration, record.estimator, record.quantity);
}

/// One-sided p that the mean now is no larger, by Welch's t test. Each side: mean, standard deviation, number.
struct Side {
  double mean, sd, count;
};
double p_of_mean(const Side& then, const Side& now) {
  const double a = then.sd * then.sd / then.count, b = now.sd * now.sd / now.count;
  const double more = now.mean - then.mean;
  if (a + b == 0.0) return more > 0.0 ? 0.0 : 1.0;
  const double degrees = (a + b) * (a + b) / (a * a / (then.count - 1.0) + b * b / (now.count - 1.0));
  return cdf(complement(boost::math::students_t(degrees), more / std::sqrt(a + b)));
}

double p_of_spread(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({then.deviation, then.deviation_sd, static_cast<double>(then.answers)},
                   {now.deviation, now.deviation_sd, static_cast<double>(now.answers)});
}

/// That the mean error now is no farther from zero.
double p_of_bias(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({std::abs(then.mean), then.sd, static_cast<double>(then.answers)},
                   {std::abs(now.mean), now.sd, static_cast<double>(now.answers)});
}

/// One-sided p that the proportion now is no smaller.
double p_of_proportion(std::uint64_t then, std::uint64_t of_then, std::uint64_t now, std::uint64_t of_now) {
  const double n = static_cast<double>(of_then), m = static_cast<double>(of_now);
  const double pooled = static_cast<double>(then + now) / (n + m);
  const double variance = pooled * (1.0 - pooled) * (1.0 / n + 1.0 / m);
  if (variance == 0.0) return 1.0;
  const double fewer = static_cast<double>(then) / n - static_cast<double>(now) / m;
  return cdf(complement(boost::math::normal(), fewer / std::sqrt(variance)));
}

}  // namespace

BaselineComparison compare_baselines(const Baseline& then, const Baseline& now) {
  const auto reject = [](const char* key, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{"baseline", 0, key, found, expected});
  };
  if (then.scenario != now.scenario) reject("scenario", "another scenario", "the scenario that it was made with");
  if (then.noise_m != now.noise_m) {
    reject("noise_m", fmt::format("{}", now.noise_m), fmt::format("{} as in the baseline", then.noise_m));
  }
  for (const ErrorRecord& after : now.records) {
    if (std::any_of(then.records.begin(), then.records.end(), [&](const auto& of) { return same(of, after); }))
      continue;
    reject(name_of(after).c_str(), "nothing in the baseline", "a quantity of both");
  }
  for (const SmoothingRecord& after : now.smoothing) {
    const auto same_clip = [&](const SmoothingRecord& of) { return of.clip == after.clip; };
    if (std::any_of(then.smoothing.begin(), then.smoothing.end(), same_clip)) continue;
    reject(after.clip.c_str(), "nothing in the baseline", "a clip of both");
  }
  BaselineComparison comparison;
  constexpr std::size_t kTestsEach = 4, kTestsOfClip = 2;
  comparison.tests = kTestsEach * then.records.size() + kTestsOfClip * then.smoothing.size();
  const double level = comparison.significance / static_cast<double>(comparison.tests);
  for (const ErrorRecord& before : then.records) {
    const auto found = std::find_if(now.records.begin(), now.records.end(),
                                    [&](const ErrorRecord& record) { return same(record, before); });
    if (found == now.records.end()) reject(name_of(before).c_str(), "nothing now", "a quantity of both");
    const auto judge = [&](const char* what, double p, double value_then, double value_now) {
      if (p < level) {
        comparison.worse.push_back(
            {before.configuration, before.estimator, before.quantity, what, value_then, value_now, p});
      }
    };
    const auto part = [](std::uint64_t some, std::uint64_t all) {
      return static_cast<double>(some) / static_cast<double>(all);
    };
    judge("answers", p_of_proportion(before.answers, before.runs, found->answers, found->runs),
          part(before.answers, before.runs), part(found->answers, found->runs));
    if (before.answers < 2 || found->answers < 2) continue;
    judge("spread", p_of_spread(before, *found), before.deviation, found->deviation);
    judge("bias", p_of_bias(before, *found), before.mean, found->mean);
    judge("coverage", p_of_proportion(before.covered, before.answers, found->covered, found->answers),
          part(before.covered, before.answers), part(found->covered, found->answers));
  }
  comparison.power_doubled = then.smoothing.empty() ? 0.0 : 1.0;
  for (const SmoothingRecord& before : then.smoothing) {
    const auto found = std::find_if(now.smoothing.begin(), now.smoothing.end(),
                                    [&](const SmoothingRecord& record) { return record.clip == before.clip; });
    if (found == now.smoothing.end()) reject(before.clip.c_str(), "nothing now", "a clip of both");
    if (before.runs < 2 || found->runs < 2) continue;
    const auto side = [](double mean, double sd, std::uint64_t count) {
      return Side{mean, sd, static_cast<double>(count)};
    };
    const auto judge = [&](const char* quantity, const char* what, double p, double log_then, double log_now) {
      if (p >= level) return;
      comparison.worse.push_back(
          {before.clip, "phase-diagram", quantity, what, std::exp(log_then), std::exp(log_now), p});
    };
    judge("a", "rms error",
          p_of_mean(side(before.log_a_error, before.log_a_error_sd, before.runs),
                    side(found->log_a_error, found->log_a_error_sd, found->runs)),
          before.log_a_error, found->log_a_error);
    const Side h_then = side(before.log_bandwidth, before.log_bandwidth_sd, before.runs);
    const Side h_now = side(found->log_bandwidth, found->log_bandwidth_sd, found->runs);
    judge("bandwidth", "mean", std::min(1.0, 2.0 * std::min(p_of_mean(h_then, h_now), p_of_mean(h_now, h_then))),
          before.log_bandwidth, found->log_bandwidth);
    const double sd = before.log_bandwidth_sd * std::sqrt(1.0 / h_then.count + 1.0 / h_now.count);
    if (sd > 0.0) {
      const boost::math::normal normal;
      const double power = cdf(normal, std::log(2.0) / sd - quantile(complement(normal, 0.5 * level)));
      comparison.power_doubled = std::min(comparison.power_doubled, power);
    }
  }
  const double n = static_cast<double>(now.runs), m = static_cast<double>(then.runs);
  if (now.runs > 2 && then.runs > 2) {
    constexpr double kLarger = 1.5, kBias = 0.5;
    const boost::math::normal normal;
    const double needed = quantile(complement(normal, level));
    // Of |z|, z standard normal: mean sqrt(2/pi), standard deviation sqrt(1 - 2/pi).
    constexpr double kMean = 0.7978845608, kSd = 0.6028102750;
    comparison.power_spread =
        cdf(normal, (kLarger - 1.0) * kMean / (kSd * std::sqrt(kLarger * kLarger / n + 1.0 / m)) - needed);
    comparison.power_bias = cdf(normal, kBias / std::sqrt(1.0 / n + 1.0 / m) - needed);
  }
  return comparison;
}

std::uint64_t other_seed(const Baseline& then) {
  return then.seed.value_or(1) + 1;
}

}  // namespace glidelab::validate
