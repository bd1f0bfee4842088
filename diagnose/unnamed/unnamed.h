/// Explanations without a name: smooth forces and displacements in each variable, and sizes that differ from clip to
/// clip, mass to mass or set-up to set-up for no stated reason. They answer for what is not in the list of effects.
///
/// Each family is a set of bumps (or of members) whose sizes are drawn from N(0, tau²), tau unknown over four decades;
/// or one bump of them at an unknown place; or one step there; its evidence is exact in the linear neighbourhood of a
/// fit. Forces lie over v, x and t, displacements over x and t (also such as swing with x), lateness over t;
/// displacements of each clip, and a lateness, may settle from the clip's start on.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/score_space.h"

namespace glidelab::diagnose {

struct UnnamedRegion {
  double from = 0.0, to = 0.0;
  double excess = 0.0;  ///< size over its standard deviation, where that is largest
  double size = 0.0;    ///< the largest, in the family's unit
  double sd = 0.0;      ///< of that size
  double at = 0.0;      ///< where it is
};

struct UnnamedFamily {
  std::string variable;  ///< x_m, v_m_s, t_s, mass_kg, direction, group, clip
  std::string what;      ///< "force", "friction", "displacement", "acceleration", "lateness", "viscous drag", "scale"
  std::string unit;      ///< of the sizes
  double log_evidence = 0.0;
  double gain = 0.0;
  std::vector<double> at, size, sd;  ///< the unnamed function over its variable
  std::vector<std::string> names;    ///< of members (clips, groups); empty for a variable
  std::vector<UnnamedRegion> regions;
  Eigen::MatrixXd columns;  ///< of the likeliest family that clips share only: its bumps over the noise, own parameters
                            ///< projected out
  double tau = 0.0;         ///< standard deviation of their sizes
};

/// All families around a fit.
std::vector<UnnamedFamily> unnamed_families(const ScoreSpace& space);

/// The likeliest of those that say of one clip something about another; null: none. Their columns must be there.
const UnnamedFamily* likeliest_shared(const std::vector<UnnamedFamily>& families);

/// The fit with the family's bumps as further parameters, each N(0, tau²): at the minimum of its linear neighbourhood,
/// for held_out_gap(), statement_pulls() and what it leaves of the positions. The family must have its columns.
MotionFit with_unnamed(const TrackSet& set, const MotionFit& fit, const UnnamedFamily& family);

/// Their joint evidence: each variable as likely beforehand as another, and of one variable each family.
double log_unnamed_evidence(const std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
