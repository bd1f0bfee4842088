/// A gate (validate/study/baseline/gate.h) in words and as JSON: the errors, what a comparison with their baseline
/// detects, and what is worse.
#pragma once

#include <string>

#include "validate/study/baseline/gate.h"

namespace glidelab::report {

/// A row for each quantity: how often it was found, its errors, its coverage.
std::string errors_table(const validate::Baseline& baseline);

/// How many tests, and with what probability they detect large changes: a line.
std::string power_text(const validate::BaselineComparison& comparison);

/// How large a worsening must be to be detected, quantity by quantity, and how many runs detect a small one.
std::string detectable_text(const validate::Gate& gate);
/// A warning if that is large for some quantities; else empty.
std::string weak_text(const validate::Gate& gate);

/// What is worse, a line each; empty if nothing is.
std::string worse_text(const validate::BaselineComparison& comparison);

/// All of these together, as far as there is a baseline, with how the runs of an outside estimator went.
std::string gate_text(const validate::Gate& gate);

/// {"runs", "seed", "noise_m", "errors": [{"configuration", "estimator", "quantity", "runs", "answered", "covered",
/// "bias", "sd", "efficiency"}], "outside"}, and with a baseline "tests", "significance", "passed", "worse":
/// [{"configuration", "estimator", "quantity", "what", "then", "now", "p_value"}], "detectable": [{"configuration",
/// "estimator", "quantity", "factor", "bias", "runs_for_1_1"}]; null where a number does not exist. A newline at its
/// end.
std::string gate_json(const validate::Gate& gate);

}  // namespace glidelab::report
