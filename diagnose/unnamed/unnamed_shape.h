/// What the families of unnamed.h are made of: bumps over a range, and the evidence of their sizes.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "diagnose/unnamed/unnamed.h"

namespace glidelab::diagnose {

/// Places from low to high, as many as there are bumps.
struct Grid {
  int bumps = 2;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double x);
  double width() const { return (high - low) / (bumps - 1); }
  double at(int i) const { return low + width() * i; }
};

/// Gauss's bump of unit height, as wide as the bumps are apart.
double bump(double x, double middle, double width);

UnnamedFamily family_of(std::string variable, std::string what, std::string unit);

/// The family with the evidence of the columns' sizes, each N(0, tau²). Where the family leaves more than the noise,
/// the sizes (their tau too) and how sure they are go by what is left.
UnnamedFamily solve(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily family,
                    SpreadEvidence& evidence);

/// The function that bumps of these sizes make together, and its standard deviation, at 73 places of the grid.
void draw_curve(const Grid& grid, const Eigen::VectorXd& sizes, const Eigen::MatrixXd& covariance,
                UnnamedFamily& family);

/// One of many shapes that a family may have: where it gains more than those before, the family takes its gain, columns
/// and tau.
struct Tried {
  double log_evidence = 0.0;
  bool better = false;
};
Tried try_one(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily& family,
              SpreadEvidence& evidence);

/// The stretches of `at` in which the size is sure, each with the largest of the sizes that are at least half as sure
/// as its surest; of members with names each by itself.
void name_regions(UnnamedFamily& family);

/// The three shapes that a function over a grid may have: smooth anywhere, one bump, one step.
void add_shapes(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, const Grid& grid,
                const UnnamedFamily& family, std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
