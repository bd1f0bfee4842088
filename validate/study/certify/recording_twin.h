/// Twins of a recording: its fitted motions, with the causes that its diagnosis named, recorded anew as often as
/// wanted.
///
/// The truth of a twin is drawn: it follows one of the explanations that the diagnosis weighed, as often as that one is
/// probable, so a drag that is likely and not named is in some of the twins. And each clip has what that explanation
/// leaves (diagnose/causes/remainder.h): inclination, friction and drag that scatter from clip to clip, and a white
/// acceleration, each with the size that the recording has most likely. What they change in x is added to the recorded
/// positions. Filmed twins are without it: of a nominal film it made certificates that are far too bad.
///
/// A recording whose clips were all filmed is filmed again (film_studio.h): its camera as the folder, calibration and
/// images tell it, each twin with the noise of its own clips and of its own calibration stills (as many views as were
/// used), the pixels' noise scaled so that positions scatter as they do in the recording. Where the clips have one
/// scale instead of a pattern, the camera is known and the scale is off by a normal deviate of its stated standard
/// deviation.
///
/// A recording of tracks is simulated at its own frame times: x = (true position as a wrong scale or perspective shows
/// it) + noise, rounded where the file's positions are. The noise has the variance and the autocovariance c rho^k that
/// the analysis found in each clip (core/motion/smoothing/noise.h), the part that rounding makes taken off.
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
#include "validate/study/certify/certificate.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {

/// How the positions of one clip err.
struct ClipNoise {
  std::vector<double> frame_s;  ///< stated times of its positions after the first one, in seconds
  double white_m = 0.0;         ///< standard deviation of the part that is independent from frame to frame
  double lasting_m = 0.0;       ///< and of the part that lasts: autocovariance lasting² rho^lag
  double rho = 0.0;             ///< of two successive positions, 0 to 1
  double rounding_m = 0.0;      ///< step of the file's positions; 0: none
};

/// What one explanation makes of the motions, and what it leaves.
struct TwinExplanation {
  std::vector<sim::ConfigurationSetup> configurations;  ///< as the scenario's, with other forces and starts
  double probability = 1.0;                             ///< beside the others
  std::vector<std::string> ids = {};                    ///< effects that it holds
  double q_m2_s3 = 0.0;                                 ///< spectral density of a white acceleration
  double force_m_s2 = 0.0;  ///< sd from clip to clip of the acceleration by friction, and of that by the inclination
  double drag = 0.0;        ///< relative sd from clip to clip of K

  bool leaves_nothing() const { return q_m2_s3 <= 0.0 && force_m_s2 <= 0.0 && drag <= 0.0; }
};

struct RecordingTwin {
  render::Scenario scenario;                  ///< of the explanation that the diagnosis reports
  std::vector<TwinExplanation> explanations;  ///< empty: the scenario, and it leaves nothing
  bool filmed = false;
  std::vector<ClipNoise> clips;    ///< of tracks: one for each clip of the scenario, in its order
  double scale_sd_relative = 0.0;  ///< of one px_per_m
  double scale_error = 0.0;        ///< as diagnosed: x is seen as (1 + e) x / (1 + p x)
  double perspective_1_m = 0.0;
  double from_m = 0.0;              ///< x of the recording where the twin's is 0
  double noise_m = 0.0;             ///< of the recording's positions: median over clips
  std::vector<std::string> causes;  ///< ids of the effects that the diagnosis named and the twin has
  std::vector<NotInTwins> without;
};

/// `results` as diagnose::diagnose_results() had them, with their pictures, and the folders (or files) they are of, in
/// order. A recording of which a scenario's camera would not see enough is simulated as tracks, and `without` says so.
/// InputError where the motions cannot be told as a scenario.
RecordingTwin twin_of_recording(const core::AnalysisResults& results, const diagnose::Diagnosis& diagnosis,
                                const std::vector<core::Experiment>& folders);

/// One thing that is otherwise than in the recording.
struct TwinChange {
  double noise = 1.0;         ///< times the noise of pixels, or of tracked positions
  double marker = 1.0;        ///< times its diameter
  bool camera_known = false;  ///< the calibration is without error; of tracks and of one scale: the scale is
  bool lossless = false;      ///< the codec loses nothing
  bool unrounded = false;     ///< of tracks: all digits
  bool twice = false;         ///< every clip is recorded once more
  bool double_rate = false;   ///< of tracks: twice as many frames a second
  bool nominal = false;       ///< no force but the viscous and the Coulomb friction of the law
  bool alike = false;         ///< every clip follows the law without a remainder
};

/// Which explanation the twin of a seed follows; 0 where there is none to choose.
std::size_t explanation_of(const RecordingTwin& twin, std::uint64_t seed);

/// The configurations' true values in the twins that follow this explanation: of one whose law has further forces, K/m
/// and mu of its viscous and Coulomb terms. `nominal` as in TwinChange.
Truth truth_of(const RecordingTwin& twin, std::size_t explanation, bool nominal = false);

/// What stands still in filmed twins is drawn once, and the calibrations of the first seeds are kept for changes that
/// leave camera, light and pattern as they are. Shared by threads that record different seeds.
class TwinStudios {
 public:
  /// Calibrations are kept of `most` seeds, those that come first.
  explicit TwinStudios(std::size_t most) : most_(most) {}

 private:
  friend class TwinFilm;
  std::mutex mutex_;
  std::size_t most_;
  std::map<std::uint64_t, std::shared_ptr<FilmStudio>> of_seed_;
  /// By explanation, noise and marker.
  std::map<std::tuple<std::size_t, double, double>, std::shared_ptr<const render::Stage>> stages_;
};

/// One recording of the twin, with its truth. Of one seed and another change the motions, and as far as may be the
/// noise, are the same; the studios change nothing in it. `progress` is called often while it is filmed, and may throw
/// to stop; it outlives the studios.
MadeTracks record_twin(const RecordingTwin& twin, const TwinChange& change, std::uint64_t seed, TwinStudios& studios,
                       const base::Progress& progress = base::no_progress);

/// Of a clip's positions, as the analysis found it: the median over the clips (one at least).
double median_noise(const core::AnalysisResults& results);

/// Scales the noise of a sensor's pixels: its electrons by 1 / factor², its read noise in codes by the factor; codes
/// stay what they are.
void scale_noise(render::Sensor& sensor, double factor);

}  // namespace glidelab::validate
