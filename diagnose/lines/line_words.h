/// What a table of lines says, in plain words.
#pragma once

#include <string>
#include <vector>

#include "diagnose/lines/line_table.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A paragraph for somebody who knows the experiment and no statistics. `diagnosis.lines` is there.
std::string line_summary(const Diagnosis& diagnosis);

/// What would decide between a friction force (N) and a smoothing bias (s² m/s²) of these sizes.
std::string next_for_lines(const std::vector<TableLine>& lines, double force_n, double bias_s2_m_s2);

}  // namespace glidelab::diagnose
