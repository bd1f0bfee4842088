/// What a requirement asks for, and how the errors of many runs compare with it.
///
/// Over n errors e_i, an infinite one for a run without an answer:
///
///     sd       sqrt(sum e_i² / n): the root mean square error, a bias included
///     error95  the least of the |e_i| that 95 % of them do not exceed: number ceil(0.95 n) of the sorted ones, which
///              is the largest where there are fewer than 20
///     bias     |sum e_i / n|
///
/// Errors of tracks have heavy tails (a frame that is lost without a trace), so that what a normal distribution says of
/// these measures does not hold.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace glidelab::validate {

struct Target {
  enum class Measure { sd, error95, bias };  ///< sd: root mean square error
  std::string quantity;                      ///< "mu"
  Measure measure = Measure::sd;
  double value = 0.0;
  std::string name() const;  ///< "mu sd 0.0005"
};

/// "mu=0.0005", "k_over_m_1_s:error95=0.01"; InputError for anything else.
Target parse_target(const std::string& text);

/// Resamples of the runs' errors that a ± comes from.
inline constexpr int kResamples = 1000;

struct ErrorMeasure {
  double value = 0.0;  ///< in the errors' unit; infinite where the unanswered runs make it so
  /// Standard deviation of the value. "bias": that of the errors over sqrt(n). The others: that of the measure over
  /// kResamples resamples of the errors (bootstrap; a fixed seed), times sqrt(n / (n - 1)). Infinite where a resample's
  /// is.
  double sd = 0.0;
  std::size_t runs = 0;
  std::size_t beyond = 0;  ///< of these, with an error larger than the target's value
};

/// Two errors or more (asserted).
ErrorMeasure measure_errors(std::span<const double> errors, const Target& target);

}  // namespace glidelab::validate
