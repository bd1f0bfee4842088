/// validate --baseline, --write-baseline: is the analysis worse than it was?
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/shell/common_options.h"
#include "fit/outside/outside_estimator.h"

namespace glidelab::app {

struct BaselineGate {
  std::string compare;  ///< --baseline
  std::string write;    ///< --write-baseline
  std::uint64_t runs = 100;
  std::optional<double> noise_m = {};
  bool wanted() const { return !compare.empty() || !write.empty(); }
};

/// NotMet if something is worse. If there is an outside estimator, it alone is judged.
void run_baseline_gate(const BaselineGate& gate, const CommonOptions& common, const std::string& scenario_file,
                       const std::optional<fit::OutsideEstimator>& outside);

}  // namespace glidelab::app
