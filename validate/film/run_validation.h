/// The closed loop: a scenario is rendered, the images are analysed, and the results are compared with the truth.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/long_work.h"
#include "core/analysis/analyze.h"
#include "core/result/results.h"
#include "fit/outside/outside_estimator.h"
#include "render/film/render_experiment.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {

struct ValidationOptions {
  render::RenderOptions render;
  core::AnalysisOptions analysis;
  std::optional<fit::OutsideEstimator> outside = {};
};

struct ValidationResult {
  core::AnalysisResults results;
  Comparison comparison;          ///< with wall_s of rendering, analysis and comparison
  std::string outside_json = {};  ///< results.json of the outside estimator; empty if there is none or it failed
};

/// Renders into `experiment_dir` and `truth_dir` (both exist and are empty), analyses the first, and only then reads
/// the second. An outside estimator gets a copy of the first (outside_runs.h). Throws the errors of rendering and
/// analysis.
ValidationResult run_validation(const render::Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const ValidationOptions& options,
                                const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
