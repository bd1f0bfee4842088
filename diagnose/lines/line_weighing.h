/// How probable each explanation of a table of lines is, and how similar two effects are in it.
///
/// The odds are those of tracks: nothing 0.3, one effect 0.4 (shared), two 0.1. Each is four times as likely alone as
/// with something without a name beside it; of that each variable (mass, set-up, both together, direction) is as likely
/// as another.
///
/// Two effects are as alike as the angle between their columns is small (ln K/m and a0 of all lines, each over its
/// scatter), the nominal model projected out. Measured sizes do not enter.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/lines/line_solution.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct LineExplanation {
  std::vector<std::size_t> named;     ///< indices of the named terms; two at most
  std::optional<std::size_t> family;  ///< index of the family without a name
  LineSolution solution;
  double log_evidence = 0.0;
  double probability = 0.0;  ///< 0 where a size is impossible
};

/// The nominal model first.
std::vector<LineExplanation> weigh_lines(const LineData& data, const std::vector<LineTerm>& named,
                                         const std::vector<LineFamily>& families);

/// Of every two of the terms; `least_seen` is the size that makes one standard deviation. Scatters above 0.
Isolability line_isolability(const LineData& data, const std::vector<LineTerm>& terms, double sd_log_k, double sd_a0);

/// Whether terms without a name take up nearly all (a cosine of kAlike) of what this one does: beside it they say
/// nothing that they do not say alone.
bool taken_up(const LineData& data, const LineTerm& term, const std::vector<LineTerm>& by, double sd_log_k,
              double sd_a0);

}  // namespace glidelab::diagnose
