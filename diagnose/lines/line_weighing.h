/// How probable each explanation of a table of lines is.
///
/// The odds are those of tracks: nothing 0.3, one effect 0.4 (shared), two 0.1, each four times as likely as with
/// something without a name beside it; of that each variable (mass, set-up, both together, direction) is as likely as
/// another.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/lines/line_solution.h"

namespace glidelab::diagnose {

struct LineExplanation {
  std::vector<std::size_t> named;     ///< indices of the named terms; two at most
  std::optional<std::size_t> family;  ///< index of the family without a name
  LineSolution solution;
  double log_evidence = 0.0;
  double probability = 0.0;  ///< 0 where a size is impossible
};

/// The usual model first.
std::vector<LineExplanation> weigh_lines(const LineData& data, const std::vector<LineTerm>& named,
                                         const std::vector<LineFamily>& families);

}  // namespace glidelab::diagnose
