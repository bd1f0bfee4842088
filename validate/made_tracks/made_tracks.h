/// The motions of a scenario as tracks: x at the times of the frames, with white noise, and no images.
///
/// They are for studies that run estimators thousands of times. The frames follow the scenario's clock (including
/// dropped, duplicated and late ones), and their times are those that an analysis of the file would use: frame j at
/// j / rate; for a variable rate, its stamp in the container, or even times where these explain the rounded stamps
/// (core/math/even_times.h). Nothing else of the camera is modelled: no exposure, lens, shutter, calibration or
/// plumb line. `noise_sd_m` represents all of that, and predicted_noise_m() predicts its size before anything is
/// rendered. x is measured from the track's reference point, as in the scenario.
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

/// Limitations of a camera that can be hypothetically removed, one at a time.
struct WithoutLimit {
  bool shot_noise = false;
  bool camera_noise = false;  ///< read noise, dark signal, quantisation, fixed patterns
  bool motion_blur = false;
  double finer = 1.0;  ///< factor on the pixels per metre; each pixel keeps its amount of light
};

/// How well a camera can locate the marker: the bound of the marker's centre (core/pictures/marker/marker_fit.h) for
/// the scenario's light, sensor, distance and speed, in metres in the plane of motion. It is the standard deviation of
/// a position for each clip of the truth, infinite if the marker is no brighter than the wall or smaller than two
/// pixels.
///
///     variance of a pixel = shot + dark + read^2 + quantisation^2 + (PRNU signal)^2 + DSNU^2,
///
/// taken as the mean of the values on the marker and on the wall. The marker moves by L = v exposure in a frame, which
/// blurs its edge like a normal distribution of variance L^2 / 12. Lens blur, tone curves, a mosaic, codecs and the
/// calibration are not included; rendered runs have them.
std::vector<double> predicted_noise_m(const render::Scenario& scenario, const Truth& truth,
                                      const WithoutLimit& without = {});

struct MadeTracks {
  std::vector<core::ClipSetup> setups;
  std::vector<core::TrackData> tracks;  ///< without noise when first made
  Truth truth;                          ///< true times of the frames
  double gravity_m_s2 = 9.80665;
};

/// Makes tracks without noise. The seed is that of the clock. NumericalError if a motion cannot be simulated.
MadeTracks make_tracks(const render::Scenario& scenario, std::uint64_t seed);

/// The same tracks with independent normal deviates added; a duplicated frame repeats its deviate. Clip c draws by its
/// number (random_use.h).
MadeTracks with_noise(const MadeTracks& clean, double noise_sd_m, std::uint64_t seed);
/// The same with a standard deviation for each track (as many as there are: asserted).
MadeTracks with_noise(const MadeTracks& clean, const std::vector<double>& noise_sd_m, std::uint64_t seed);

/// The phase diagram of every clip and the configurations, as in core::analyze() with tracks from files: by any of its
/// methods, with a given or a chosen bandwidth.
core::AnalysisResults analyze_tracks(const MadeTracks& made, const core::MotionOptions& how, int jobs = 1);
core::AnalysisResults analyze_tracks(const MadeTracks& made, std::optional<double> bandwidth_s, int jobs = 1);

}  // namespace glidelab::validate
