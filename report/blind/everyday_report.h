/// The results of everyday blind cases: a file, a text, a page; with the targets.
#pragma once

#include <string>
#include <vector>

#include "report/blind/blind_report.h"

namespace glidelab::report {

/// A number that is to be at most, or between, what is wanted.
struct EverydayTarget {
  std::string what;
  validate::BlindShare share;   ///< of a share; of no cases otherwise
  std::optional<double> value;  ///< of what is no share; none where no case bears on it
  double low = 0.0, high = 1.0;
};
std::vector<EverydayTarget> everyday_targets(const validate::EverydayScore& score);

/// Whether some case bears on it, and whether what was found lies where it is wanted.
bool bears(const EverydayTarget& target);
bool is_met(const EverydayTarget& target);

/// As those of blind_report.h, of a run with `everyday`.
std::string everyday_json(const BlindRun& run);
std::string everyday_text(const BlindRun& run);
Page everyday_page(const BlindRun& run);

}  // namespace glidelab::report
