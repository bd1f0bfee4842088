/// The excess of the squared gap as a waterfall: before, what each cause takes of it, what is left, and the floor.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// Where the bars of a waterfall begin and end, in percent of the excess g²_0 - 1: 0 is the floor, 100 the gap before.
struct WaterfallBar {
  double from = 0.0, to = 0.0;   ///< `to` is where it ends to the left, and the next cause begins
  double low = 0.0, high = 0.0;  ///< 95 % of `to` by the interval of the cause's own share; both `to` where it has none
};
/// One bar a cause, in order.
std::vector<WaterfallBar> waterfall_bars(const std::vector<diagnose::ExplainedCause>& explained);

/// One plot; none without causes.
std::vector<Plot> waterfall_plots(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
