#include "validate/film/run_validation.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "fit/estimators.h"
#include "render/film/marker_view.h"
#include "validate/made_tracks/outside_runs.h"
#include "validate/truth/cramer_rao.h"
#include "validate/truth/truth_folder.h"

namespace glidelab::validate {
namespace {

/// The noise of the positions of each clip of the truth, as found by the analysis.
std::vector<double> noise_of(const core::AnalysisResults& results, const Truth& truth) {
  std::vector<double> noise_sd_m;
  for (const TrueClip& clip : truth.clips) {
    const auto found = std::find_if(results.clips.begin(), results.clips.end(),
                                    [&](const core::ClipResult& candidate) { return candidate.name == clip.name; });
    if (found == results.clips.end())
      throw base::InputError(base::Issue{"truth.json", 0, "clips", clip.name, "clips that were analysed"});
    noise_sd_m.push_back(found->position_noise_m);
  }
  return noise_sd_m;
}

}  // namespace

ValidationResult run_validation(const render::Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const ValidationOptions& options,
                                const base::Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  render::render_experiment(scenario, experiment_dir, truth_dir, options.render, progress);
  ValidationResult result;
  result.results = core::analyze({experiment_dir}, options.analysis, progress);
  std::optional<fit::OutsideOutcome> outside;
  if (options.outside) {
    progress(options.outside->name, 0.0);
    outside = run_outside_on_film(*options.outside, experiment_dir, result.results);
  }
  const Truth truth = read_truth(truth_dir);
  result.comparison = compare(result.results, truth);
  std::vector<QuantityComparison> quantities;
  for (const core::AnalysisResults& by :
       fit::estimate_each(fit::judged_estimators(), [&](core::LineMethod) { return result.results; })) {
    quantities = join_estimators(std::move(quantities), compare_quantities(by, truth));
  }
  if (outside) {
    quantities = join_estimators(std::move(quantities), compare_quantities(outside->results, truth));
    result.comparison.outside = fit::tally_of(*options.outside, {outside->run});
    result.outside_json = std::move(outside->json);
  }
  result.comparison.quantities = with_bounds(
      std::move(quantities), least_sds(truth, noise_of(result.results, truth), scenario.motion.gravity_m_s2));
  for (const render::ClipView& view : render::views_of(scenario)) {
    if (view.outside == 0) continue;
    result.comparison.frames_out_of_view += view.outside;
    result.comparison.out_of_view.push_back(render::sentence(view));
  }
  result.comparison.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace glidelab::validate
