/// Twins of a recording: its fitted motions, with the causes named by its diagnosis, recorded again as often as wanted.
///
/// Every motion is a clip of its own, from its fitted start: of a cart that bounces, each flight. What lies between the
/// motions of one recorded clip is not in a twin.
///
/// The truth of a twin is drawn: it follows one of the explanations weighed by the diagnosis, with that explanation's
/// probability, so a drag that is likely but not named is in some of the twins. Each clip also has the remainder of
/// that explanation (diagnose/causes/remainder.h): inclination, friction and drag that scatter from clip to clip, and a
/// white acceleration, each with its most likely size in the recording. The resulting changes in x are added to the
/// recorded positions. Filmed twins have no remainder: for a nominal film it gave certificates that were far too
/// pessimistic.
///
/// A recording whose clips were all filmed is filmed again (film_studio.h): its camera follows from the folder,
/// calibration and images; each twin has the noise of its own clips and of its own calibration stills (as many views as
/// were used), with the pixels' noise scaled so that positions scatter as in the recording. If the clips have one scale
/// instead of a pattern, the camera is known and the scale is off by a normal deviate of its stated standard deviation.
///
/// A recording of tracks is simulated at its own frame times: x = (true position as seen with a wrong scale or
/// perspective) + noise, rounded if the file's positions are. The noise has the variance and the autocovariance c rho^k
/// that the analysis found in each clip (core/motion/smoothing/noise.h), minus the contribution of rounding.
///
/// In both, the clock is off by a normal deviate of the standard deviation that the estimators assume. SI units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/result/diagnosis.h"
#include "render/scenario/scenario.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/certify/certificate.h"

namespace glidelab::validate {

/// The position errors of one clip.
struct ClipNoise {
  std::vector<double> frame_s;  ///< stated times of its positions after the first one, in seconds
  double white_m = 0.0;         ///< standard deviation of the part that is independent from frame to frame
  double lasting_m = 0.0;       ///< standard deviation of the correlated part: autocovariance lasting² rho^lag
  double rho = 0.0;             ///< of two successive positions, 0 to 1
  double rounding_m = 0.0;      ///< step of the file's positions; 0: none
};

/// The motions under one explanation, and its remainder.
struct TwinExplanation {
  std::vector<sim::ConfigurationSetup> configurations;  ///< like the scenario's, with other forces and starts
  double probability = 1.0;                             ///< relative to the others
  std::vector<std::string> ids = {};                    ///< effects that it contains
  double q_m2_s3 = 0.0;                                 ///< spectral density of a white acceleration
  double force_m_s2 = 0.0;  ///< sd from clip to clip of the acceleration due to friction, and of that due to the
                            ///< inclination
  double drag = 0.0;        ///< relative sd from clip to clip of K

  bool leaves_nothing() const { return q_m2_s3 <= 0.0 && force_m_s2 <= 0.0 && drag <= 0.0; }
};

struct RecordingTwin {
  render::Scenario scenario;                  ///< of the explanation reported by the diagnosis
  std::vector<TwinExplanation> explanations;  ///< empty: the scenario, without remainder
  bool filmed = false;
  std::size_t recorded_clips = 0;  ///< whose motions the clips of the scenario are; 0: one each
  std::vector<ClipNoise> clips;    ///< of tracks: one for each clip of the scenario, in its order
  bool by_scale = false;           ///< lengths come from one px_per_m, not from a pattern
  double scale_sd_relative = 0.0;  ///< of that
  double scale_error = 0.0;        ///< as diagnosed: x is seen as (1 + e) x / (1 + p x)
  double perspective_1_m = 0.0;
  double from_m = 0.0;              ///< x of the recording at which the twin's x is 0
  double noise_m = 0.0;             ///< of the recording's positions: median over clips
  std::vector<std::string> causes;  ///< ids of the effects named by the diagnosis and present in the twin
  std::vector<NotInTwins> without;
};

/// `results` as passed to diagnose::diagnose_results(), with their images, and the folders (or files) from which they
/// come, in order. A recording of which a scenario's camera would not see enough is simulated as tracks, and `without`
/// says so. InputError if the motions cannot be expressed as a scenario.
RecordingTwin twin_of_recording(const core::AnalysisResults& results, const diagnose::Diagnosis& diagnosis,
                                const std::vector<core::Experiment>& folders);

/// One difference from the recording.
struct TwinChange {
  double noise = 1.0;         ///< factor on the noise of pixels, or of tracked positions
  double marker = 1.0;        ///< factor on its diameter
  bool camera_known = false;  ///< the calibration has no error; for tracks and for one scale: the scale has none
  bool lossless = false;      ///< the codec loses nothing
  bool unrounded = false;     ///< for tracks: all digits
  bool twice = false;         ///< every clip is recorded twice
  bool double_rate = false;   ///< for tracks: twice as many frames per second
  bool nominal = false;       ///< no force except the viscous and the Coulomb friction of the law
  bool alike = false;         ///< every clip follows the law without a remainder
};

/// The explanation followed by the twin of a seed; 0 if there is no choice.
std::size_t explanation_of(const RecordingTwin& twin, std::uint64_t seed);

/// The configurations' true values in the twins that follow this explanation: if its law has further forces, K/m and mu
/// of its viscous and Coulomb terms. `nominal` as in TwinChange.
Truth truth_of(const RecordingTwin& twin, std::size_t explanation, bool nominal = false);

/// The static scene of filmed twins is drawn once, and the calibrations of the first seeds are kept for changes that
/// leave camera, light and pattern unchanged. Shared by threads.
class TwinStudios {
 public:
  /// Keeps the calibrations of the first `most` seeds.
  explicit TwinStudios(std::size_t most) : most_(most) {}

 private:
  friend class TwinFilm;
  std::mutex mutex_;
  std::size_t most_;
  std::map<std::uint64_t, std::shared_ptr<FilmStudio>> of_seed_;
  /// By explanation, noise and marker.
  std::map<std::tuple<std::size_t, double, double>, std::shared_ptr<const render::Stage>> stages_;
};

/// One recording of the twin, with its truth. For the same seed and another change the motions and, as far as possible,
/// the noise are the same; the studios do not affect it. `progress` is called often while it is filmed, and may throw
/// to stop; it outlives the studios.
MadeTracks record_twin(const RecordingTwin& twin, const TwinChange& change, std::uint64_t seed, TwinStudios& studios,
                       const base::Progress& progress = base::no_progress);

/// Noise of a clip's positions as found by the analysis: the median over the clips (at least one).
double median_noise(const core::AnalysisResults& results);

/// Scales the noise of a sensor's pixels: its electrons by 1 / factor², its read noise in codes by the factor; codes
/// are unchanged.
void scale_noise(render::Sensor& sensor, double factor);

}  // namespace glidelab::validate
