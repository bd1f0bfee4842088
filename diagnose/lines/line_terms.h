/// What may act beside the nominal model on a table of lines: effects with a name, and friction or drag without one.
///
/// What a named effect does to a line stands in its file (effects/effect.h, OnLines). Without a name, with the line's
/// mass m, direction s and K/m: a0 - s f or ln(K/m) + d, f or d of each mass, of each set-up, of each mass in each
/// set-up; ln(K/m) + s d.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "diagnose/lines/line_table.h"
#include "diagnose/result/line_comparison.h"

namespace glidelab::diagnose {

/// What one unit of a term adds to ln(K/m) and to a0 (m/s²) of every line.
struct LineTerm {
  std::string id, key, stage, words;
  Eigen::VectorXd of_log_k, of_a0;
  bool both_signs = false;
  double largest = 0.0;  ///< in the unit of the key
};

/// Terms without a name that come together.
struct LineFamily {
  UnnamedInLines of;
  double share = 0.0;  ///< of the odds of something without a name: each variable alike, and of it friction and drag
  std::vector<LineTerm> terms;
};

/// Those of the effects that lines can show, less what is left `without`. None where all masses are the same: they are
/// K and mu then.
std::vector<LineTerm> named_terms(const std::vector<TableLine>& lines, const std::vector<std::string>& without);

std::vector<LineFamily> unnamed_families(const std::vector<TableLine>& lines);

/// Effects of the speed whose lines are those of load_independent_friction, less what is left `without`.
std::vector<std::string> alike_friction_force(const std::vector<std::string>& without);

}  // namespace glidelab::diagnose
