/// All clips of one analysis, once their x(t) is known: each on its own, then joined by configuration.
#pragma once

#include <vector>

#include "base/long_work.h"
#include "core/experiment/clip_setup.h"
#include "core/motion/analyze_motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// There is one track for each setup (asserted), in the same order; the clips share the glider and the track. `jobs`
/// clips at a time. The clips' `experiment` is left empty. The progress counts clips.
AnalysisResults analyze_tracks(const std::vector<ClipSetup>& setups, const std::vector<TrackData>& tracks,
                               double gravity_m_s2, const MotionOptions& options, int jobs,
                               const base::Progress& progress = base::no_progress);

}  // namespace glidelab::core
