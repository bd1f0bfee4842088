#include "validate/study/requirement/target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "base/math/distributions.h"
#include "base/text/nearest_word.h"
#include "base/text/readable_text.h"
#include "core/math/quantile.h"
#include "core/result/estimate.h"
#include "core/result/quantity.h"
#include "validate/random_use.h"
#include "validate/truth/binomial.h"

namespace glidelab::validate {
namespace {

using Measure = Target::Measure;

double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double square = 0.0;
  for (const double value : values) square += (value - mean) * (value - mean);
  return square / static_cast<double>(values.size() - 1);
}

constexpr std::size_t kLeastForQuantile = 20;  // with fewer, the 95 % quantile would be the largest

/// `sizes` are the errors without their signs; their order is lost.
double rms_or_quantile(std::vector<double>& sizes, Measure measure) {
  const std::size_t n = sizes.size();
  if (measure == Measure::error95 && n >= kLeastForQuantile) {
    const std::size_t within = (95 * n + 99) / 100;  // ceil(0.95 n), in whole numbers
    const auto at = sizes.begin() + static_cast<std::ptrdiff_t>(within - 1);
    std::nth_element(sizes.begin(), at, sizes.end());
    return *at;
  }
  double square = 0.0;
  for (const double size : sizes) square += size * size;
  return (measure == Measure::error95 ? core::kNormal95 : 1.0) * std::sqrt(square / static_cast<double>(n));
}

/// Sorted errors between which their 95 % quantile lies: at most k - 1 of n are below the quantile with probability
/// binomial_cdf(k - 1, n, 0.95).
void set_quantile_limits(std::vector<double> sizes, double confidence, ErrorMeasure& measure) {
  std::sort(sizes.begin(), sizes.end());
  const std::size_t n = sizes.size();
  std::size_t high = n, low = 1;
  while (high > 1 && binomial_cdf(static_cast<long>(high) - 2, n, 0.95) >= confidence) --high;
  while (low < n && binomial_cdf(static_cast<long>(low), n, 0.95) <= 1.0 - confidence) ++low;
  measure.low = sizes[low - 1];
  measure.high = sizes[high - 1];
}

void set_limits(const std::vector<double>& sizes, Measure of, double confidence, ErrorMeasure& measure) {
  const double n = static_cast<double>(sizes.size());
  const bool many = 1.0 - std::pow(0.95, n) >= confidence;
  if (of == Measure::error95 && many) return set_quantile_limits(sizes, confidence, measure);
  if (of == Measure::error95 || (of == Measure::sd && sizes.size() < kRunsForQuantile)) {
    // For normal errors, hence from their rms, even if the value is one of the sorted errors.
    double square = 0.0;
    for (const double size : sizes) square += size * size;
    const double normal = (of == Measure::error95 ? core::kNormal95 : 1.0) * std::sqrt(square / n);
    const double low = std::isfinite(normal) ? normal : measure.value;
    measure.low = std::min(measure.value, low * std::sqrt(n / base::chi2_quantile(n, confidence)));
    measure.high = std::max(measure.value, normal * std::sqrt(n / base::chi2_quantile(n, 1.0 - confidence)));
    // So few errors do not exclude that more than 5 % of all are as large as the largest (0.95^n > 1 - confidence): if
    // that is beyond the target, no normal distribution speaks against what was seen.
    if (of == Measure::error95 && measure.beyond > 0) {
      measure.high = std::max(measure.high, *std::max_element(sizes.begin(), sizes.end()));
    }
    return;
  }
  const double wider = base::normal_quantile(confidence) / base::normal_quantile(kConfidence);
  const double reach =
      (of == Measure::bias ? core::student_t975(n - 1.0) * wider : base::normal_quantile(confidence)) * measure.sd;
  measure.low = std::isfinite(reach) ? std::max(0.0, measure.value - reach) : measure.value;
  measure.high = measure.value + reach;
}

double bootstrap_sd(const std::vector<double>& sizes, Measure measure) {
  std::mt19937_64 random = random_engine(RandomUse::bootstrap);
  std::vector<double> resample(sizes.size()), found(kResamples);
  for (double& value : found) {
    for (double& size : resample) size = sizes[random() % sizes.size()];
    value = rms_or_quantile(resample, measure);
    if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
  }
  const double n = static_cast<double>(sizes.size());
  return std::sqrt(variance_of(found) * n / (n - 1.0));
}

}  // namespace

Target parse_target(const std::string& text) {
  Target target;
  const std::size_t equals = text.find('='), colon = text.find(':');
  const std::string_view all = text;
  target.quantity = base::trimmed(all.substr(0, std::min(colon, equals)));
  const std::string measure(colon < equals && equals != std::string::npos
                                ? base::trimmed(all.substr(colon + 1, equals - colon - 1))
                                : "error95");
  const std::vector<std::string> quantities = core::quantity_keys();
  std::istringstream number(
      std::string(equals == std::string::npos ? std::string_view() : base::trimmed(all.substr(equals + 1))));
  const bool read = (number >> target.value) && number.peek() == std::istringstream::traits_type::eof();
  const bool known = std::find(quantities.begin(), quantities.end(), target.quantity) != quantities.end();
  const std::vector<std::string> measures = {"sd", "error95", "bias"};
  const bool known_measure = std::find(measures.begin(), measures.end(), measure) != measures.end();
  if (!read || !known || !(target.value > 0.0) || !known_measure) {
    throw base::InputError(base::Issue{
        "", 0, "--target", fmt::format("\"{}\"", text),
        fmt::format("QUANTITY=VALUE, or QUANTITY:sd|error95|bias=VALUE, with one of {} "
                    "and a number above 0{}{}",
                    fmt::join(quantities, ", "), known ? "" : base::did_you_mean(target.quantity, quantities),
                    known_measure ? "" : base::did_you_mean(measure, measures))});
  }
  target.measure = measure == "sd"     ? Target::Measure::sd
                   : measure == "bias" ? Target::Measure::bias
                                       : Target::Measure::error95;
  return target;
}

ErrorMeasure measure_errors(std::span<const double> errors, const Target& target, double confidence) {
  assert(errors.size() >= 2 && confidence > 0.5 && confidence < 1.0);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  ErrorMeasure result;
  result.runs = errors.size();
  std::vector<double> sizes(errors.size());
  std::transform(errors.begin(), errors.end(), sizes.begin(), [](double error) { return std::abs(error); });
  result.beyond = static_cast<std::size_t>(
      std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size > target.value; }));
  if (target.measure == Measure::bias) {
    const bool answered = std::all_of(sizes.begin(), sizes.end(), [](double size) { return std::isfinite(size); });
    result.value = answered ? std::abs(mean_of(errors)) : kNever;
    result.sd = answered ? std::sqrt(variance_of(errors) / static_cast<double>(errors.size())) : kNever;
    set_limits(sizes, target.measure, confidence, result);
    return result;
  }
  std::vector<double> sorted = sizes;
  result.value = rms_or_quantile(sorted, target.measure);
  const double n = static_cast<double>(sizes.size());
  result.sd = !std::isfinite(result.value)        ? kNever
              : sizes.size() >= kLeastForQuantile ? bootstrap_sd(sizes, target.measure)
                                                  : result.value / std::sqrt(2.0 * n);
  set_limits(sizes, target.measure, confidence, result);
  return result;
}

}  // namespace glidelab::validate
