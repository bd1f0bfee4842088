/// The simulation that behaves like the data: the fitted motions as a scenario file.
///
/// Configurations are the fitted masses on the fitted inclinations, clips the fitted starts, forces the fitted ones.
/// Expressed exactly: K, mu, quadratic_drag, eddy_rolloff or power_law_drag, stribeck, load_independent_friction (more
/// mu for a lighter glider), direction_asymmetry (a constant force), and of the clock frame_rate_error, dropped_frames,
/// timestamp_jitter. A scenario has no forces that depend on the place or the time, and no wrong scale, and
/// no force that was recorded: what needs one is listed, and the twin lacks it. x counts from the middle of the data.
#pragma once

#include <string>
#include <vector>

#include "diagnose/hypotheses.h"

namespace glidelab::diagnose {

struct Twin {
  std::string toml;
  std::vector<std::string> lacks;  ///< what a scenario cannot express
};

/// Of a fit and what single frames show; `effects` are those that are named.
Twin twin_of(const TrackSet& set, const MotionFit& fit, const std::vector<std::size_t>& effects,
             const Comparison& comparison);

}  // namespace glidelab::diagnose
