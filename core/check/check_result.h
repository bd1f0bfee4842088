/// The result of a check of a recording as plain data (check_recording.h makes it).
///
/// Lengths of the set-up are in metres, those of the image in pixels; brightness is a share of the largest code.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/check/finding.h"
#include "core/pictures/scene/path_light.h"
#include "core/result/analysis_note.h"
#include "core/result/image_record.h"
#include "core/result/results.h"

namespace glidelab::core {

struct PixelPlace {
  double u_px = 0.0;
  double v_px = 0.0;
};

/// One image of the calibration pattern: where its corners are and how well the camera explains them.
struct PatternView {
  std::string file;  ///< without its folder
  bool plane = false;
  double rms_px = 0.0;    ///< of one coordinate of a corner, from where camera and pose put it
  double tilt_deg = 0.0;  ///< between the pattern's normal and the optical axis
  std::vector<PixelPlace> corners;
};

struct PatternCheck {
  std::vector<PatternView> views;    ///< in which the pattern was found
  std::vector<std::string> without;  ///< images in which it was not found
  std::optional<CalibrationResult> calibration;
  std::string failure;  ///< why there is no calibration; empty if there is one
  int width_px = 0, height_px = 0;
  double covered = 0.0;  ///< share of the image's 8 x 6 equal parts that hold a corner
};

/// From the positions alone (motion_look.h).
struct MotionLook {
  std::size_t positions = 0;
  double distance_m = 0.0;
  double noise_m = 0.0;                     ///< of a position, from its neighbours
  double spread_m = 0.0;                    ///< of the positions about their mean; 0 if a force was recorded
  std::optional<double> counted;            ///< the step, if x goes on by the same from row to row, as no body does
  double frame_s = 0.0;                     ///< mean time from one position to the next
  std::optional<double> acceleration_m_s2;  ///< typical size; none if noise hides it, or a force was recorded
  double acceleration_sd_m_s2 = 0.0;        ///< of one of the parabolas that it is the median of
  double speeding_up_m_s2 = 0.0;            ///< the most by which it surely speeds up over a metre or more; 0: nowhere
  double push_m_s2 = 0.0;  ///< by which it surely speeds up at first, beyond any incline; 0: it does not
  double pushed_until_s = 0.0;
  std::size_t turns = 0;
  bool oscillates = false;
  double bend = 0.0;           ///< of the path in the image: sagitta over length
  bool smooth = false;         ///< smoother than any measurement
  double unseen = 0.0;         ///< part of the time that lies in gaps between positions
  double longest_gap_s = 0.0;  ///< of these
};

/// Light on the marker along its path.
struct MarkerLighting {
  double least_contrast = 1.0;  ///< of the darkest twentieth of the frames, over that of the brightest
  double pull_px = 0.0;         ///< from the outline's centre to the centroid of the marker's light, median
  /// Half the range, without a twentieth at either end, of its component along the path: the error of a centroid.
  double pull_change_px = 0.0;
};

/// Brightness along the path, codes: of the marker, or, if that is dark, of its surroundings.
struct PathBrightness {
  std::vector<LitPoint> points;  ///< none of a marker that is known by its hue
  bool of_marker = false;
  double u_px_per_m = 0.0, v_px_per_m = 0.0;  ///< the image of a metre downhill
};

/// The slope of the marker's lengthening (the difference of its second moments along and across its path) over the
/// square of its speed, in s^2: a twelfth of the square of the exposure.
struct SmearSlope {
  double s2 = 0.0, sd_s2 = 0.0;
};

/// Positions between two stretches of free motion in the same direction that follow the law of neither: a stop, a blow,
/// a hand.
struct Interruption {
  double from_s = 0.0, to_s = 0.0;
};

struct ClipCheck {
  std::string name;
  std::string failure;      ///< why nothing more is known; else empty
  bool images = true;       ///< false for a track from a file
  std::size_t frames = 0;   ///< or rows of the file
  std::size_t seen = 0;     ///< frames with the marker
  std::size_t spanned = 0;  ///< frames from the first sighting to the last
  std::size_t first = 0;    ///< frame of the first sighting, counted from 0
  bool entered = false;     ///< the first sighting is at the image's edge
  bool left = false;        ///< the last one is
  int width_px = 0, height_px = 0;
  double frame_rate_hz = 0.0;  ///< as stated; of a track, the median
  std::optional<double> container_rate_hz;
  std::size_t repeated = 0;               ///< frames equal to the one before, bit by bit
  std::optional<RepeatsLeftOut> repeats;  ///< frames in mid-motion that show the image of the one before
  std::size_t irregular_steps = 0;        ///< between the file's time stamps
  double drift_frames = 0.0;              ///< largest departure of the time stamps from even spacing, in frames
  std::size_t jumps = 0;                  ///< places where frames are missing (lost_frames.h)
  std::size_t stalls = 0;                 ///< single steps well below their neighbours: duplicated frames
  double saturated = 0.0;                 ///< share of the pixels at the largest code
  double dark = 0.0;                      ///< share of the pixels at 0
  double bright_level = 0.0;              ///< exceeded by 0.1 % of the pixels
  double marker_px = 0.0;                 ///< median diameter
  double marker_expected_px = 0.0;        ///< from its stated diameter and the scale along its path; 0: not known
  std::optional<double> contrast;         ///< marker minus its surroundings; none for one that is known by its hue
  std::optional<double> marker_level;     ///< its own brightness
  std::optional<MarkerLighting> light;    ///< how it changes along the path; of a marker with an outline
  PathBrightness brightness;
  std::shared_ptr<const ImageRecord> record;  ///< of its scene
  double pixel_noise = 0.0;                   ///< of a pixel at rest from frame to frame; 0 if none is seen
  double combs = 0.0;                         ///< ImageRecord::combs
  bool frames_alone = false;                  ///< each is compressed without the others (MJPEG)
  double block_steps = 0.0;   ///< excess of the steps between pixels at the edges of a codec's 8 x 8 blocks
                              ///< over those elsewhere, relative; 0 if no block is beyond doubt
  double centre_sd_px = 0.0;  ///< of one coordinate of the marker's centre, from its fit, median
  double distance_m = 0.0;    ///< from the uppermost position to the lowest
  double top_speed_m_s = 0.0;
  double top_speed_px_s = 0.0;
  std::optional<double> blur_px;  ///< at that speed, with the stated exposure
  /// From the lengthening of the marker with its speed (check_clip.h), with the corresponding smear at the top speed.
  /// Only if the exposure is above twice the stated one (less may be the camera's tone curve) or none is stated, is
  /// below the time between frames, is not contradicted by another clip, and the smear is above half the marker's
  /// diameter (less may be perspective: in one clip speed and position go together).
  std::optional<double> measured_exposure_s, measured_blur_px;
  std::optional<SmearSlope> lengthening;
  double longest_blur_px = 0.0;            ///< with an exposure as long as the frame time
  std::optional<double> position_noise_m;  ///< as the analysis will state it
  MotionLook motion;
  std::optional<AgainstLaunch> against_launch;  ///< of the motion, as the analysis will find it
  std::vector<Interruption> interruptions;      ///< which the analysis will leave out
  double inside_pattern = 1.0;                  ///< share of the sightings within the outline of all corners seen
  std::vector<PixelPlace> path;                 ///< at most 200 positions
  std::vector<MarkerSighting> sightings;
  std::vector<Note> notes;  ///< from reading the clip
};

struct RecordingCheck {
  std::string name;
  std::optional<PatternCheck> pattern;
  std::vector<ClipCheck> clips;
  std::vector<ConfigurationResult>
      configurations;  ///< what the motion says about the clips, to compare with what is stated
  std::vector<PlumbResult> plumbs;
  std::string plumb_failure;      ///< why the plumb line gives no angle; empty if it does, or if there is none
  std::vector<Finding> findings;  ///< the most severe first
  bool usable = true;             ///< no finding is Severity::unusable
};

}  // namespace glidelab::core
