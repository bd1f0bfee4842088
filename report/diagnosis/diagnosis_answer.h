/// The open part of the page of a diagnosis, below its first paragraph: the waterfall, K/m, µ, α and terminal velocity
/// with the causes in the model, where the remainder lies, and what to record next. Everything else on the page is
/// folded.
#pragma once

#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The excess of the squared gap as a waterfall: the initial excess, the share of each cause, the remainder, and the
/// noise floor. The start and end of its bars, in percent of the excess g²_0 - 1: 0 is the noise floor, 100 the
/// initial gap.
struct WaterfallBar {
  double from = 0.0, to = 0.0;   ///< `to` is its left end, where the next cause begins
  double low = 0.0, high = 0.0;  ///< 95 % interval of `to` from that of the cause's own share; both equal `to` if it
                                 ///< has none
};
/// One bar per cause, in order.
std::vector<WaterfallBar> waterfall_bars(const std::vector<diagnose::ExplainedCause>& explained);

/// The plot of the waterfall; none without causes.
std::vector<Plot> waterfall_plots(const diagnose::Diagnosis& diagnosis);

/// Regions of a gap; empty if there are none. The unit of a size shown by images is that of a parameter's key.
std::string region_table(const std::vector<diagnose::GapRegion>& regions);

/// Differences between configurations, if an effect has a value for each; empty if none has.
std::string member_section(const diagnose::Diagnosis& diagnosis);

/// Empty parts are left out. Not for a table of lines.
Html answer_sections(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
