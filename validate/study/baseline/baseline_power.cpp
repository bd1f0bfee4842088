#include "validate/study/baseline/baseline_power.h"
#include "core/result/line_method.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace glidelab::validate {
namespace {

double z_above(double part) {
  return boost::math::quantile(boost::math::complement(boost::math::normal(), part));
}

/// The factor f of the header, the larger root of its square; nothing if no factor is large enough.
std::optional<double> factor_of(double mean, double sd, double z, double n, double m) {
  const double d2 = mean * mean, now = z * z * sd * sd / n, then = z * z * sd * sd / m;
  if (!(d2 > now)) return std::nullopt;
  return (d2 + std::sqrt(d2 * d2 - (d2 - now) * (d2 - then))) / (d2 - now);
}

std::uint64_t rounded_up(double runs) {
  return static_cast<std::uint64_t>(std::ceil(runs));
}

}  // namespace

std::vector<Detectable> detectable(const Baseline& then, const Baseline& now, const BaselineComparison& comparison) {
  std::vector<Detectable> all;
  const double level = comparison.significance / static_cast<double>(comparison.tests);
  const double z = z_above(level) + z_above(1.0 - kDetectionProbability),
               z_two_sided = z_above(0.5 * level) + z_above(1.0 - kDetectionProbability);
  for (const ErrorRecord& before : then.records) {
    const auto found = std::find_if(now.records.begin(), now.records.end(), [&](const ErrorRecord& record) {
      return record.configuration == before.configuration && record.estimator == before.estimator &&
             record.quantity == before.quantity;
    });
    if (found == now.records.end() || before.answers < 2 || found->answers < 2 || !(before.deviation > 0.0)) continue;
    const auto n = static_cast<double>(found->answers), m = static_cast<double>(before.answers);
    Detectable of{before.configuration, before.estimator, before.quantity, {}, {}, 0};
    of.factor = factor_of(before.deviation, before.deviation_sd, z, n, m);
    of.bias = z * before.sd * std::sqrt(1.0 / n + 1.0 / m);
    const double needed = z * before.deviation_sd / ((kWeakFactor - 1.0) * before.deviation);
    of.runs_for_weak = rounded_up(needed * needed * (kWeakFactor * kWeakFactor + 1.0));
    all.push_back(std::move(of));
  }
  for (const SmoothingRecord& before : then.smoothing) {
    const auto found = std::find_if(now.smoothing.begin(), now.smoothing.end(),
                                    [&](const SmoothingRecord& record) { return record.clip == before.clip; });
    if (found == now.smoothing.end() || before.runs < 2 || found->runs < 2) continue;
    const double root = std::sqrt(1.0 / static_cast<double>(found->runs) + 1.0 / static_cast<double>(before.runs));
    const auto add = [&](const char* quantity, double sd, double z_of) {
      const double needed = z_of * sd / std::log(kWeakFactor);
      all.push_back({before.clip, core::name_of(core::LineMethod::ordinary), quantity, std::exp(z_of * sd * root),
                     std::nullopt, rounded_up(2.0 * needed * needed)});
    };
    add("a", before.log_a_error_sd, z);
    add("bandwidth", before.log_bandwidth_sd, z_two_sided);
  }
  return all;
}

}  // namespace glidelab::validate
