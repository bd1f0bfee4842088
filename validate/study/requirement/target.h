/// The target of a requirement, and how the errors of many runs compare with it.
///
/// Over n errors e_i, an infinite one for a run without an answer:
///
///     sd       sqrt(sum e_i² / n): the rms error, including a bias
///     error95  the least of the |e_i| that 95 % of them do not exceed: number ceil(0.95 n) of the sorted ones; of
///              fewer than 20 errors, which do not know that quantile, 1.96 times their root mean square
///     bias     |sum e_i / n|
///
/// Errors of tracks have heavy tails (a frame lost without a trace), so results for a normal distribution do not apply
/// to these measures. Limits on both sides of a measure (`low`, `high`), each with a confidence of 95 % or as
/// requested:
///
///     error95, 59 errors or more   the sorted errors between which the quantile lies by the binomial distribution;
///                                  59 is the least number whose largest error is such an upper limit (of 95 %)
///     error95 and sd, fewer        rms sqrt(n / chi²), times 1.96 for error95, chi² the 95 % and the 5 % quantile of n
///                                  degrees of freedom: a tolerance interval of normal errors (too wide where these
///                                  have a bias). If any error95 is beyond the target, the upper limit is at least the
///                                  largest error: by the binomial distribution fewer than 59 errors do not exclude
///                                  that more than 5 % are as large
///     sd, 59 errors or more        value ∓ 1.645 of its standard deviation
///     bias                         value ∓ Student's t of its standard deviation
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace glidelab::validate {

struct Target {
  enum class Measure { sd, error95, bias };  ///< sd: rms error
  std::string quantity;                      ///< "mu"
  Measure measure = Measure::error95;
  double value = 0.0;
};

/// Number of errors from which the 95 % error has distribution-free limits: 0.95^59 < 0.05.
inline constexpr std::size_t kRunsForQuantile = 59;
inline constexpr double kConfidence = 0.95;  ///< of a limit

/// "mu=0.0005" (of the 95 % error), "k_over_m_1_s:sd=0.01"; InputError for anything else.
Target parse_target(const std::string& text);

/// Number of resamples of the runs' errors for a ±.
inline constexpr int kResamples = 1000;

struct ErrorMeasure {
  double value = 0.0;  ///< in the errors' unit; infinite if unanswered runs make it so
  /// Standard deviation of the value. "bias": that of the errors over sqrt(n). The others: that of the measure over
  /// kResamples resamples of the errors (bootstrap; a fixed seed), times sqrt(n / (n - 1)), infinite if that of a
  /// resample is. For fewer than 20 errors, which do not reveal their distribution, value / sqrt(2 n) as for normal
  /// ones.
  double sd = 0.0;
  double low = 0.0, high = 0.0;  ///< limits of the value
  std::size_t runs = 0;
  std::size_t beyond = 0;  ///< of these, with an error larger than the target's value
};

/// Requires two errors or more (asserted), and a confidence above one half.
ErrorMeasure measure_errors(std::span<const double> errors, const Target& target, double confidence = kConfidence);

}  // namespace glidelab::validate
