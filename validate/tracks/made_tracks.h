/// The motions of a scenario as tracks: x at the times of the frames, with white noise, and no images.
///
/// For studies that run estimators thousands of times. The frames come when the scenario's clock says
/// (dropped, duplicated, late ones too), and their times are what the file would say: frame j at j / rate, or its stamp
/// where the rate is variable. Of the camera nothing else is in it: no exposure, lens, shutter, calibration or plumb;
/// `noise_sd_m` stands for all of that. x counts from the track's reference point, as in the scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/motion/analyze_motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"
#include "render/scenario/scenario.h"
#include "validate/truth/truth_folder.h"

namespace glidelab::validate {

struct MadeTracks {
  std::vector<core::ClipSetup> setups;
  std::vector<core::TrackData> tracks;  ///< without noise as they are made
  Truth truth;                          ///< true times of the frames
  double gravity_m_s2 = 9.80665;
};

/// Without noise. The seed is that of the clock. NumericalError if a motion cannot be moved.
MadeTracks make_tracks(const render::Scenario& scenario, std::uint64_t seed);

/// The same tracks with independent normal deviates added; a duplicated frame repeats its own. Clip c draws from
/// mt19937_64 with the seed sequence {seed low, seed high, c}.
MadeTracks with_noise(const MadeTracks& clean, double noise_sd_m, std::uint64_t seed);
/// The same with a standard deviation for each track (as many as there are: asserted).
MadeTracks with_noise(const MadeTracks& clean, const std::vector<double>& noise_sd_m, std::uint64_t seed);

/// The phase diagram of every clip and the configurations, as core::analyze() does it with tracks from files: by any of
/// its methods, or with a bandwidth (chosen where there is none).
core::AnalysisResults analyze_tracks(const MadeTracks& made, const core::MotionOptions& how, int jobs = 1);
core::AnalysisResults analyze_tracks(const MadeTracks& made, std::optional<double> bandwidth_s, int jobs = 1);

}  // namespace glidelab::validate
