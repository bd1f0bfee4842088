/// Clips joined by configuration: lines through the points of all clips of one configuration, and from these K/m, mu
/// and alpha (lines/mu_and_alpha.h) and v_lim (lines/line_fit.h). And the whole analysis of tracks, analyze_tracks().
#pragma once

#include <vector>
#include "base/long_work.h"
#include "core/experiment/clip_setup.h"
#include "core/experiment/local_gravity.h"
#include "core/motion/analyze_motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// The configurations of the clips: each holds those of one mass, stated inclination and group. With lines for both
/// directions
///
///     g sin(alpha) = (a0- + a0+)/2,     mu g cos(alpha) = (a0- - a0+)/2        (the paper's equation (13))
///
/// K/m is the directions' mean. With generalised lines the clips' own lines are weighted by their inverse covariances.
std::vector<ConfigurationResult> configurations_of_clips(const std::vector<ClipSetup>& setups,
                                                         const std::vector<ClipResult>& clips, const Gravity& gravity,
                                                         LineMethod lines = LineMethod::ordinary);

/// All clips of one analysis, once their x(t) is known: each on its own, then joined by configuration.
///
/// There is one track for each setup (asserted), in the same order; the clips share the glider and the track. `jobs`
/// clips at a time. The clips' `experiment` is left empty. The progress counts clips.
AnalysisResults analyze_tracks(const std::vector<ClipSetup>& setups, const std::vector<TrackData>& tracks,
                               const Gravity& gravity, const MotionOptions& options, int jobs,
                               const base::Progress& progress = base::no_progress);

}  // namespace glidelab::core
