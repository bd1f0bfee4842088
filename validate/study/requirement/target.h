/// What a requirement asks for, and how the errors of many runs compare with it.
///
/// Over n errors e_i, an infinite one for a run without an answer:
///
///     sd       sqrt(sum e_i² / n): the root mean square error, a bias included
///     error95  the least of the |e_i| that 95 % of them do not exceed: number ceil(0.95 n) of the sorted ones; of
///     fewer
///              than 20 errors, which do not know that quantile, 1.96 times their root mean square
///     bias     |sum e_i / n|
///
/// Errors of tracks have heavy tails (a frame that is lost without a trace), so that what a normal distribution says of
/// these measures does not hold. A limit on either side of a measure (`low`, `high`), each of a confidence of 95 % or
/// as asked for:
///
///     error95, 59 errors or more   the sorted errors between which the quantile lies by the binomial distribution;
///                                  59 is the least number whose largest error is such an upper limit (of 95 %)
///     error95 and sd, fewer        rms sqrt(n / chi²), times 1.96 for error95, chi² the 95 % and the 5 % quantile of n
///                                  degrees of freedom: a tolerance interval of normal errors (too wide where these
///                                  have a bias)
///     sd, 59 errors or more        value ∓ 1.645 of its standard deviation
///     bias                         value ∓ Student's t of its standard deviation
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace glidelab::validate {

struct Target {
  enum class Measure { sd, error95, bias };  ///< sd: root mean square error
  std::string quantity;                      ///< "mu"
  Measure measure = Measure::error95;
  double value = 0.0;
  std::string name() const;  ///< "mu 95 % error 0.0005"
};

/// Errors from which on the 95 % error has limits that rest on no distribution: 0.95^59 < 0.05.
inline constexpr std::size_t kRunsForQuantile = 59;
inline constexpr double kConfidence = 0.95;  ///< of a limit

/// "mu=0.0005" (of the 95 % error), "k_over_m_1_s:sd=0.01"; InputError for anything else.
Target parse_target(const std::string& text);

/// Resamples of the runs' errors that a ± comes from.
inline constexpr int kResamples = 1000;

struct ErrorMeasure {
  double value = 0.0;  ///< in the errors' unit; infinite where the unanswered runs make it so
  /// Standard deviation of the value. "bias": that of the errors over sqrt(n). The others: that of the measure over
  /// kResamples resamples of the errors (bootstrap; a fixed seed), times sqrt(n / (n - 1)), infinite where a resample's
  /// is; of fewer than 20 errors, which tell nothing of their distribution, value / sqrt(2 n) as of normal ones.
  double sd = 0.0;
  double low = 0.0, high = 0.0;  ///< limits of the value
  std::size_t runs = 0;
  std::size_t beyond = 0;  ///< of these, with an error larger than the target's value
};

/// Two errors or more (asserted), and a confidence of more than a half.
ErrorMeasure measure_errors(std::span<const double> errors, const Target& target, double confidence = kConfidence);

}  // namespace glidelab::validate
