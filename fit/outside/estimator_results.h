/// results.json as an outside estimator writes it, and its results for an experiment.
///
///     {"format": 1,
///      "configurations": [{"clips": ["up", "down"],
///                          "k_over_m_1_s": {"value": 2.77, "sd": 0.01, "interval95": [2.75, 2.79]},
///                          "mu": null, "alpha_deg": {…}, "v_lim_m_s": {…}, "why": {"mu": "…"}}]}
///
/// The clips of a configuration share one mass, stated inclination and group. All four quantities must be present; one
/// that the estimator does not determine is null. `interval95` may be left out: it is then value ± 1.96 sd. Other keys
/// are allowed and ignored, so the results.json of `glidelab analyze` has this form too. As a JSON schema:
/// docs/reference/estimator-results.schema.json.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/results.h"

namespace glidelab::fit {

/// The configurations of these clips, in the order of their first clips. All quantities are undetermined, for the
/// reason `why`.
core::AnalysisResults undetermined_results(const std::vector<core::ClipSetup>& clips, const std::string& estimator,
                                           const core::AnyReason& why);

/// The same, filled with what the text says. InputError with everything that is wrong: not JSON, a key that is missing
/// or of the wrong type, a number that is not finite, an interval that does not contain the value, a clip that the
/// experiment does not have or that is in two configurations, clips of several configurations in one. `file` is for
/// messages.
core::AnalysisResults read_estimator_results(std::string_view text, const std::filesystem::path& file,
                                             const std::vector<core::ClipSetup>& clips, const std::string& estimator);

}  // namespace glidelab::fit
