/// The results of blind cases: a file, a text, a page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/html/html.h"
#include "validate/blind/blind_score.h"

namespace glidelab::report {

struct BlindRun {
  std::uint64_t seed = 0;
  std::vector<validate::BlindOutcome> outcomes;
  validate::BlindScore score;
  bool pictures = false;  ///< filmed experiments, not tracks
};

/// The score and every case's outcome, with a newline at its end. No number in it is NaN.
std::string blind_json(const BlindRun& run);

/// Targets, ways of deciding and confusions as tables for a terminal.
std::string blind_text(const BlindRun& run);

/// The same as a page, with what it means first and all cases last. EnvironmentError where gnuplot fails.
Page blind_page(const BlindRun& run);

}  // namespace glidelab::report
