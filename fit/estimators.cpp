#include "fit/estimators.h"

#include <algorithm>
#include <map>
#include <utility>

#include "fit/trajectory/trajectory_results.h"

namespace glidelab::fit {
namespace {

core::AnalysisResults lines_themselves(core::AnalysisResults of_lines, const EstimateOptions&) {
  return of_lines;
}

core::AnalysisResults whole_motion(core::AnalysisResults of_lines, const EstimateOptions& options) {
  return with_trajectory_fits(std::move(of_lines), {.robust = options.robust});
}

}  // namespace

const std::vector<Estimator>& estimators() {
  static const std::vector<Estimator> all = {
      {.name = core::name_of(core::LineMethod::ordinary),
       .title = "lines of the phase diagram",
       .method = "smooths x(t) by a local cubic and fits a line a(v) to each direction by ordinary least squares",
       .lines = core::LineMethod::ordinary,
       .of_lines = true,
       .takes_robust = false,
       .judged = true,
       .estimate = lines_themselves},
      {.name = core::name_of(core::LineMethod::generalised),
       .title = "generalised lines",
       .method =
           "fits the same lines with the points' covariance and with errors in v and a, without bias from the kernel",
       .lines = core::LineMethod::generalised,
       .of_lines = true,
       .takes_robust = false,
       .judged = false,
       .estimate = lines_themselves},
      {.name = kTrajectory,
       .title = "fit of the whole motion",
       .method = "fits the whole motion to the positions",
       .lines = core::LineMethod::ordinary,
       .of_lines = false,
       .takes_robust = true,
       .judged = true,
       .estimate = whole_motion},
  };
  return all;
}

std::vector<Estimator> judged_estimators() {
  std::vector<Estimator> judged;
  std::ranges::copy_if(estimators(), std::back_inserter(judged), &Estimator::judged);
  return judged;
}

const Estimator* find_estimator(std::string_view name) {
  const auto found = std::ranges::find(estimators(), name, &Estimator::name);
  return found == estimators().end() ? nullptr : &*found;
}

std::vector<std::string> estimator_names() {
  std::vector<std::string> names;
  for (const Estimator& estimator : estimators()) names.emplace_back(estimator.name);
  return names;
}

core::AnalysisResults estimate_and_compare(const Estimator& estimator, core::AnalysisResults of_lines,
                                           const EstimateOptions& options) {
  core::AnalysisResults results = estimator.estimate(std::move(of_lines), options);
  if (estimator.of_lines) set_scatter_of_motion(results);
  return results;
}

std::vector<core::AnalysisResults> estimate_each(
    const std::vector<Estimator>& wanted, const std::function<core::AnalysisResults(core::LineMethod)>& analyze) {
  std::map<core::LineMethod, core::AnalysisResults> lines;
  std::vector<core::AnalysisResults> results;
  for (const Estimator& estimator : wanted) {
    auto made = lines.find(estimator.lines);
    if (made == lines.end()) made = lines.emplace(estimator.lines, analyze(estimator.lines)).first;
    results.push_back(estimator.estimate(made->second, {}));
  }
  return results;
}

}  // namespace glidelab::fit
