/// How alike what two effects do to a table of lines is: the angle between their columns (ln K/m and a0 of all lines,
/// each over its scatter), the usual model projected out. The sizes that were measured do not enter.
#pragma once

#include <vector>

#include "diagnose/lines/line_solution.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// Of every two of the terms; `least_seen` is the size that makes one standard deviation. Scatters above 0.
Isolability line_isolability(const LineData& data, const std::vector<LineTerm>& terms, double sd_log_k, double sd_a0);

/// Whether terms without a name take up nearly all (a cosine of kAlike) of what this one does: beside it they say
/// nothing that they do not say alone.
bool taken_up(const LineData& data, const LineTerm& term, const std::vector<LineTerm>& by, double sd_log_k,
              double sd_a0);

}  // namespace glidelab::diagnose
