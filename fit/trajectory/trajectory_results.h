/// Results of the whole-motion fit, in the same form as those of the phase diagram.
#pragma once

#include "core/result/results.h"
#include "fit/trajectory/trajectory_fit.h"

namespace glidelab::fit {

inline constexpr const char* kTrajectory = "trajectory";  ///< the estimator's name in options and files

/// The same results with K/m, mu, alpha and v_lim of every configuration from fit_trajectories() instead of the lines,
/// and estimator = kTrajectory; the clips and their lines are kept. mu = f / (g cos(alpha)), sin(alpha) = d / g.
///
/// Null with the reason: mu and alpha if the motion has one direction only (the reason says which combination is
/// known); all of them for clips without free motion, and if no fit converges.
core::AnalysisResults with_trajectory_fits(core::AnalysisResults results, const TrajectoryOptions& options = {});

/// Sets the scatter of every configuration (ConfigurationResult::scatter) from that fit, and nothing else: whether the
/// law follows the positions over the whole motion. Lines through a smoothed phase diagram may be straight where it
/// does not. Speeds without positions stay as they are.
void set_scatter_of_motion(core::AnalysisResults& results);

}  // namespace glidelab::fit
