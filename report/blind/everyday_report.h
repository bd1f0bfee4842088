/// The results of everyday blind cases: a file, a text, a page; with the targets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/blind/blind_run.h"
#include "report/html/html.h"
#include "validate/blind/everyday_score.h"

namespace glidelab::report {

/// A number with an upper limit, or with a required range.
struct EverydayTarget {
  std::string what;
  validate::BlindShare share;   ///< if the target is a share; of no cases otherwise
  std::optional<double> value;  ///< if the target is not a share; empty if no case bears on it
  double low = 0.0, high = 1.0;
  bool number = false;  ///< not a share: its limits are no percentages
};
std::vector<EverydayTarget> everyday_targets(const validate::EverydayScore& score);

/// Whether some case bears on it, and whether the result lies in the required range.
bool bears(const EverydayTarget& target);
bool is_met(const EverydayTarget& target);

/// Like those of blind_report.h, for a run with `everyday`.
std::string everyday_json(const BlindRun& run);
std::string everyday_text(const BlindRun& run);
Page everyday_page(const BlindRun& run);

}  // namespace glidelab::report
