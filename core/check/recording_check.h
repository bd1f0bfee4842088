/// What a look at a recording finds before any analysis, as plain data (check_recording.h makes it).
///
/// Lengths on the bench in metres, in the picture in pixels; brightnesses as shares of the largest code.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/pictures/board/pattern_view.h"
#include "core/result/results.h"

namespace glidelab::core {

enum class Severity {
  note,     ///< good to know
  change,   ///< the analysis works, and would be better for it
  unusable  ///< no analysis, or one that cannot be trusted
};

/// One thing that was found, and what to do about it.
struct Finding {
  Severity severity = Severity::note;
  std::string about;   ///< "pattern", "masses", "plumb line", or clips' names
  std::string found;   ///< "the marker is 4.1 px wide"
  std::string advice;  ///< "move closer or use a bigger one"; empty where nothing is to be done
};

struct PatternCheck {
  std::vector<PatternView> views;    ///< in which it was found
  std::vector<std::string> without;  ///< pictures in which it was not
  std::optional<CalibrationResult> calibration;
  std::string failure;  ///< why there is no calibration; empty where there is one
  int width_px = 0, height_px = 0;
  double covered = 0.0;  ///< share of the picture's 8 x 6 equal parts that hold a corner
};

struct ClipCheck {
  std::string name;
  std::string failure;      ///< why nothing more is known; empty where something is
  bool pictures = true;     ///< false for a track from a file
  std::size_t frames = 0;   ///< or rows of the file
  std::size_t seen = 0;     ///< frames with the marker
  std::size_t spanned = 0;  ///< frames from the first sighting to the last
  std::size_t first = 0;    ///< frame of the first sighting, counted from 0
  bool entered = false;     ///< the first sighting is at the picture's edge
  bool left = false;        ///< the last one is
  int width_px = 0, height_px = 0;
  double frame_rate_hz = 0.0;  ///< as stated; of a track, the median
  std::optional<double> container_rate_hz;
  std::size_t repeated = 0;            ///< frames equal to the one before, bit by bit
  std::size_t irregular_steps = 0;     ///< between the file's time stamps
  double drift_frames = 0.0;           ///< how far the stamps leave a uniform row, in frames
  std::size_t jumps = 0;               ///< places where frames are missing (lost_frames.h)
  std::size_t stalls = 0;              ///< single steps well below those around: frames that came twice
  double saturated = 0.0;              ///< share of the pixels at the largest code
  double dark = 0.0;                   ///< share of the pixels at 0
  double bright_level = 0.0;           ///< below which 99.9 % of the pixels are
  double marker_px = 0.0;              ///< diameter, median
  double marker_expected_px = 0.0;     ///< by its stated diameter and the scale along its path; 0: not known
  std::optional<double> contrast;      ///< marker less its surroundings; none for one that is known by its hue
  std::optional<double> marker_level;  ///< its own brightness
  double pixel_noise = 0.0;            ///< of a resting pixel from frame to frame; 0 where none is seen
  double centre_sd_px = 0.0;           ///< of one coordinate of the marker's centre, from its fit, median
  double way_m = 0.0;                  ///< from the uppermost place to the lowest
  double top_speed_m_s = 0.0;
  double top_speed_px_s = 0.0;
  std::optional<double> blur_px;  ///< at that speed, by the stated exposure
  /// By how the marker lengthens with its speed (marker_smear.h), and the smear at the top speed that goes with it;
  /// only where it is above twice the stated exposure (less may be the camera's tone curve), or none is stated, and the
  /// smear above half the marker's diameter (less may be perspective: a clip's speed goes with the place).
  std::optional<double> measured_exposure_s, measured_blur_px;
  double longest_blur_px = 0.0;  ///< by an exposure as long as a frame
  std::optional<double> position_noise_m;
  std::optional<AgainstLaunch> against_launch;  ///< of the motion, as the analysis will find it
  double inside_pattern = 1.0;                  ///< share of the sightings within the outline of all corners seen
  std::vector<PixelPlace> path;                 ///< at most 200 places
  std::vector<MarkerSighting> sightings;
  std::vector<std::string> notes;  ///< what the reading of the clip tells
};

struct RecordingCheck {
  std::string name;
  std::optional<PatternCheck> pattern;
  std::vector<ClipCheck> clips;
  std::vector<ConfigurationResult> configurations;  ///< what the motion makes of the clips, beside what is stated
  std::vector<PlumbResult> plumbs;
  std::string plumb_failure;      ///< why the plumb line tells nothing; empty where it does, or there is none
  std::vector<Finding> findings;  ///< the gravest first
  bool usable = true;             ///< no finding is Severity::unusable
};

}  // namespace glidelab::core
