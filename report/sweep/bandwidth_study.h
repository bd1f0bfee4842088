/// The outcome of a sweep over bandwidths: which h to use, how much others lose, where the stated intervals fail; and
/// its plot, error against h.
///
/// Over the runs of one h and quantity, with errors e:
///
///     total² = mean of e²,  bias = mean of e,  noise² = total² - bias²
///
/// The h to use is the one whose worst quantity loses least: the minimum over h of the maximum over the quantities of
/// total(h) / (smallest total over h). If there are any h whose stated intervals hold, only these are considered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/html/plot.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// Errors that are at most this many times those of the bandwidth to use are nearly as good.
inline constexpr double kNearlyAsGood = 1.3;
/// Stated intervals are too wide if they contain the truth too often and the stated sd exceeds the error by this
/// factor.
inline constexpr double kTooWide = 1.5;

struct BandwidthAnswer {
  double use_s = 0.0;
  double from_s = 0.0, to_s = 0.0;       ///< range around it, of those that were run, in which all errors are at most
                                         ///< kNearlyAsGood times as large
  std::vector<double> narrow_s, wide_s;  ///< bandwidths whose stated intervals contain the truth too seldom; whose
                                         ///< intervals are too wide
  std::vector<double> unanswered_s;      ///< bandwidths with which some clips have no line
  std::string text;                      ///< "Use h = 0.045 s; anything from …", one line
};

/// For a sweep with lines at three or more bandwidths; empty for any other.
std::optional<BandwidthAnswer> bandwidth_answer(const validate::SweepSummary& summary);

/// For each quantity: total, noise, bias and stated sd against h; the smallest total; the default rule's choice; the
/// fit of the whole motion; the Cramér-Rao bound if known. Empty if there is no bandwidth_answer().
std::vector<Plot> bandwidth_plots(const validate::SweepSummary& summary);

/// Each bandwidth's total error of each quantity, compared with that of the default rule and of the fit of the whole
/// motion. HTML; empty if there is no bandwidth_answer().
std::string bandwidth_table(const validate::SweepSummary& summary);

/// The errors of bandwidth_table(), for a terminal: a row for each bandwidth, for the default rule and for each
/// estimator without a bandwidth; empty if there is no bandwidth_answer().
std::string bandwidth_text(const validate::SweepSummary& summary);

}  // namespace glidelab::report
