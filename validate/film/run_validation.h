/// The closed loop: a scenario is rendered, the images are analysed, and the results are compared with the truth.
#pragma once

#include <filesystem>

#include "base/long_work.h"
#include "core/analysis/analyze.h"
#include "core/result/results.h"
#include "render/film/render_experiment.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {

struct ValidationOptions {
  render::RenderOptions render;
  core::AnalysisOptions analysis;
};

struct ValidationResult {
  core::AnalysisResults results;
  Comparison comparison;  ///< with wall_s of rendering, analysis and comparison
};

/// Renders into `experiment_dir` and `truth_dir` (both exist and are empty), analyses the first, and only then reads
/// the second. Throws what rendering and analysis throw.
ValidationResult run_validation(const render::Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const ValidationOptions& options,
                                const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
