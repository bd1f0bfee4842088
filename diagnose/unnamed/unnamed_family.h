/// A family of explanations without a name, and its parts: bumps over a range, and the evidence for their sizes.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/result/gap_place.h"

namespace glidelab::diagnose {

struct UnnamedRegion {
  double from = 0.0, to = 0.0;
  double excess = 0.0;  ///< size over its standard deviation, where that is largest
  double size = 0.0;    ///< the largest, in the family's unit
  double sd = 0.0;      ///< of that size
  double at = 0.0;      ///< where it is
};

struct UnnamedFamily {
  GapVariable variable = GapVariable::time;
  GapKind what = GapKind::force;
  std::string unit;  ///< of the sizes
  double log_evidence = 0.0;
  double gain = 0.0;
  std::vector<double> at, size, sd;  ///< the unnamed function over its variable
  std::vector<std::string> names;    ///< of members (clips, groups); empty for a variable
  std::vector<UnnamedRegion> regions;
  /// Only set for the likeliest family that clips share and for the likeliest one with a size for each clip: its bumps
  /// divided by the noise, own parameters projected out.
  Eigen::MatrixXd columns;
  double tau = 0.0;  ///< standard deviation of their sizes
};

/// Positions from low to high, one for each bump.
struct Grid {
  int bumps = 2;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double x);
  double width() const { return (high - low) / (bumps - 1); }
  double at(int i) const { return low + width() * i; }
};

/// How many bumps a length takes, so far apart, within limits; any length, also one beyond what a whole number holds.
int bumps_over(double length, double apart, int fewest, int most);

/// A Gaussian bump of unit height, as wide as the spacing of the bumps.
double bump(double x, double middle, double width);

UnnamedFamily family_of(GapVariable variable, GapKind what, std::string unit);

/// The family with the evidence for the columns' sizes, each N(0, tau²). If the family leaves residuals above the
/// noise, its sizes, their tau and their uncertainties are those under noise raised to that level.
UnnamedFamily solve(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily family,
                    SpreadEvidence& evidence);

/// The sum of bumps of these sizes and its standard deviation, at 73 points of the grid.
void draw_curve(const Grid& grid, const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                UnnamedFamily& family);

/// Tries one of many shapes that a family may have. If it gains more than all before, the family takes over its gain,
/// columns and tau.
struct Tried {
  double log_evidence = 0.0;
  bool better = false;
};
Tried try_one(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily& family,
              SpreadEvidence& evidence);

/// The intervals of `at` in which the size is significant, each with the largest of the sizes that are at least half as
/// significant as its most significant one. Members with names are treated one by one.
void name_regions(UnnamedFamily& family);

/// Finds one or more families and adds them.
using FamilySearch = std::function<void(std::vector<UnnamedFamily>&)>;

/// The three shapes that a function over a grid may have: smooth anywhere, one bump, one step.
void add_shapes(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, const Grid& grid,
                const UnnamedFamily& family, std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
