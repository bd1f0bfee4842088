/// The estimators: from an experiment's lines to K/m, mu, alpha and v_lim. Every command, study and page reads this
/// list.
///
/// All start from an analysis of the clips with one of core's two methods of fitting lines. The lines give the
/// quantities themselves or serve as the starting point of another fit.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/results.h"

namespace glidelab::fit {

struct EstimateOptions {
  bool robust = false;  ///< leave out outliers; only for estimators that `take_robust`
};

struct Estimator {
  std::string_view name;    ///< in options and files
  std::string_view title;   ///< on pages: "fit of the whole motion"
  std::string_view method;  ///< in help, after the name: "fits the whole motion to the positions"
  core::LineMethod lines = core::LineMethod::ordinary;  ///< the line method it starts from
  bool of_lines = true;                                 ///< the lines give the quantities, so the result depends on the
                                                        ///< smoothing
  bool takes_robust = false;
  bool judged = false;  ///< validate, require and a baseline use it; a sweep runs it if none is named
  /// The quantities of all configurations, from an analysis with `lines`.
  core::AnalysisResults (*estimate)(core::AnalysisResults of_lines, const EstimateOptions& options) = nullptr;
};

/// The first one is the default.
const std::vector<Estimator>& estimators();
inline const Estimator& default_estimator() {
  return estimators().front();
}
std::vector<Estimator> judged_estimators();
/// Null if there is none of that name.
const Estimator* find_estimator(std::string_view name);
std::vector<std::string> estimator_names();

/// The estimate, and for an estimator of lines also how far the positions lie from the law over the whole motion
/// (set_scatter_of_motion()): what a person is told of one experiment.
core::AnalysisResults estimate_and_compare(const Estimator& estimator, core::AnalysisResults of_lines,
                                           const EstimateOptions& options);

/// The results of each estimator in `wanted` for one experiment; `analyze` is called once for each line method that
/// they start from.
std::vector<core::AnalysisResults> estimate_each(const std::vector<Estimator>& wanted,
                                                 const std::function<core::AnalysisResults(core::LineMethod)>& analyze);

}  // namespace glidelab::fit
