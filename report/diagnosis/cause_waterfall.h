/// The excess of the squared gap as a waterfall: the initial excess, the share of each cause, the remainder, and the
/// noise floor.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The start and end of the bars of a waterfall, in percent of the excess g²_0 - 1: 0 is the noise floor, 100 the
/// initial gap.
struct WaterfallBar {
  double from = 0.0, to = 0.0;   ///< `to` is its left end, where the next cause begins
  double low = 0.0, high = 0.0;  ///< 95 % interval of `to` from that of the cause's own share; both equal `to` if it
                                 ///< has none
};
/// One bar per cause, in order.
std::vector<WaterfallBar> waterfall_bars(const std::vector<diagnose::ExplainedCause>& explained);

/// One plot; none without causes.
std::vector<Plot> waterfall_plots(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
