/// A gate before an analysis or an estimator: replicated tracks of a scenario are analysed, and their errors compared
/// with those of a baseline (baseline_comparison.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "fit/outside/outside_estimator.h"
#include "fit/outside/outside_tally.h"
#include "render/scenario/scenario.h"
#include "validate/study/baseline/baseline.h"
#include "validate/study/baseline/baseline_comparison.h"

namespace glidelab::validate {

struct GateOptions {
  std::filesystem::path baseline;          ///< the file to compare with; empty: nothing is compared
  std::optional<double> noise_m = {};      ///< empty: the baseline's; without one BaselineOptions::noise_m
  std::optional<std::uint64_t> seed = {};  ///< empty: another one than the baseline's; without one 1
  std::uint64_t runs = 100;
  int jobs = 1;
  std::optional<fit::OutsideEstimator> outside = {};  ///< judged alone; without one all of fit::judged_estimators()
};

struct Gate {
  Baseline now;
  std::optional<Baseline> then = {};                  ///< the baseline
  std::optional<BaselineComparison> comparison = {};  ///< of compared()
  std::vector<Detectable> detectable = {};
  std::optional<fit::OutsideTally> outside = {};
};

/// Measures the errors; they are not compared yet, so that they can be kept whatever the comparison says. `text` is the
/// scenario's, `file` its name in messages. InputError for a baseline of another scenario or noise, and for its own
/// seed; as in read_baseline().
Gate run_gate(const render::Scenario& scenario, const std::string& text, const std::string& file,
              const GateOptions& options, const base::Progress& progress = base::no_progress);

/// The same with the comparison, if there is a baseline. InputError as in compare_baselines().
Gate compared(Gate gate);

}  // namespace glidelab::validate
