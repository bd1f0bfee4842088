#include "validate/study/certify/certificate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/math/distributions.h"

namespace glidelab::validate {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Jackknife: the standard deviation of a statistic from its values with one run left out each.
double jackknife_sd(const std::vector<double>& without_one) {
  const auto n = static_cast<double>(without_one.size());
  if (without_one.size() < 2) return std::numeric_limits<double>::infinity();
  const double mean = sum_of(without_one) / n;
  double square = 0.0;
  for (const double value : without_one) square += (value - mean) * (value - mean);
  return std::sqrt(square * (n - 1.0) / n);
}

}  // namespace

RunShare share_of(const std::vector<RunCount>& runs, double confidence) {
  RunShare result;
  std::vector<double> holds, of;
  for (const RunCount& run : runs) {
    if (run.of == 0) continue;
    result.holds += run.holds;
    result.of += run.of;
    holds.push_back(static_cast<double>(run.holds));
    of.push_back(static_cast<double>(run.of));
  }
  if (result.of == 0) return result;
  const auto n = static_cast<double>(result.of), clusters = static_cast<double>(of.size());
  result.share = static_cast<double>(result.holds) / n;
  double independent = clusters;
  const double binomial = result.share * (1.0 - result.share) / n;
  if (binomial > 0.0 && of.size() > 1) {
    const double between = std::pow(mean_of(holds, of).sd, 2);
    independent = n / std::max(1.0, between / binomial);
  }
  independent = std::max(1.0, independent);
  const double k = result.share * independent, tail = 0.5 * (1.0 - confidence);
  if (result.holds > 0) result.low = base::beta_quantile(k, independent - k + 1.0, tail);
  if (result.holds < result.of) result.high = base::beta_quantile(k + 1.0, independent - k, 1.0 - tail);
  return result;
}

RunMean mean_of(const std::vector<double>& sums, const std::vector<double>& counts) {
  assert(sums.size() == counts.size());
  const double sum = sum_of(sums), count = sum_of(counts);
  std::vector<double> without;
  for (std::size_t r = 0; r < sums.size(); ++r) {
    if (counts[r] > 0.0 && count > counts[r]) without.push_back((sum - sums[r]) / (count - counts[r]));
  }
  return {count > 0.0 ? sum / count : 0.0, jackknife_sd(without)};
}

RunFall fall_of(const std::vector<std::vector<double>>& before, const std::vector<std::vector<double>>& after,
                double confidence) {
  assert(!before.empty() && before.size() == after.size() && before.front().size() > 1);
  const std::size_t runs = before.front().size();
  // ln of rms after over before, without run `out`.
  const auto ratio = [&](std::size_t out) {
    double mean = 0.0;
    for (std::size_t q = 0; q < before.size(); ++q) {
      double sum_before = 0.0, sum_after = 0.0;
      for (std::size_t r = 0; r < runs; ++r) {
        if (r == out) continue;
        sum_before += before[q][r];
        sum_after += after[q][r];
      }
      mean += 0.5 * std::log(sum_after / sum_before) / static_cast<double>(before.size());
    }
    return mean;
  };
  std::vector<double> without;
  for (std::size_t r = 0; r < runs; ++r) without.push_back(ratio(r));
  const double value = ratio(runs), sd = jackknife_sd(without);
  const double t = base::student_t_quantile(static_cast<double>(runs) - 1.0, 0.5 * (1.0 + confidence));
  return {-std::expm1(value), -std::expm1(value + t * sd), -std::expm1(value - t * sd)};
}

bool Certificate::holds() const {
  return !(together.of > 0 && wide_together.high < kCertifiedConfidence) &&
         std::none_of(quantities.begin(), quantities.end(),
                      [](const CertifiedQuantity& quantity) { return quantity.too_narrow(); });
}

bool Certificate::empty() const {
  return std::none_of(quantities.begin(), quantities.end(),
                      [](const CertifiedQuantity& quantity) { return quantity.answered() > 0; });
}

}  // namespace glidelab::validate
