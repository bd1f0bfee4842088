#include "validate/run_validation.h"

#include <chrono>

#include "validate/truth.h"

namespace glidelab::validate {

ValidationResult run_validation(const render::Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const ValidationOptions& options,
                                const base::Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  render::render_experiment(scenario, experiment_dir, truth_dir, options.render, progress);
  ValidationResult result;
  result.results = core::analyze({experiment_dir}, options.analysis, progress);
  result.comparison = compare(result.results, read_truth(truth_dir));
  result.comparison.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace glidelab::validate
