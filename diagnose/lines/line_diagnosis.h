/// A table of published lines in, a diagnosis out.
///
///     lines ─ line_model (terms, fit, evidence) ─ line_findings (probabilities, gap, regions) ─ Diagnosis
///
/// The held-out gap is the prediction error of each line by the others, over the lines' own scatter.
#pragma once

#include <string>
#include <vector>

#include "diagnose/lines/line_model.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `without`: effects that are not considered, of effect_list() or smoothing_bias. InputError for any other word, and
/// for fewer than kFewestLines.
Diagnosis diagnose_lines(const std::vector<TableLine>& lines, double gravity_m_s2,
                         const std::vector<std::string>& without = {});

}  // namespace glidelab::diagnose
