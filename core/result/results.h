/// What an analysis finds, as plain data, with the method of its lines. report/ writes it as results.json, CSV and
/// pages.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/result/strength.h"
#include "core/result/why_unknown.h"

namespace glidelab::core {

/// The two ways in which core fits the lines of a phase diagram. ordinary: least squares as the paper does it
/// (line_fit.h); generalised: with the points' covariance (gls_line.h).
enum class LineMethod { ordinary, generalised };

/// The estimator's name in options and files; fit/estimators.h lists all estimators.
constexpr const char* name_of(LineMethod method) {
  return method == LineMethod::ordinary ? "phase-diagram" : "phase-diagram-gls";
}

struct ImageRecord;

/// A number with its standard deviation and its 95 % interval.
struct Estimate {
  double value = 0.0;
  double sd = 0.0;
  double low95 = 0.0;
  double high95 = 0.0;
};

/// A quantity that the data determine, or the reason why they do not.
struct Quantity {
  std::optional<Estimate> estimate;
  std::optional<WhyUnknown> why = {};  ///< empty if there is an estimate
  /// The correction for the kernel's bias of a line (line_law.h) that the estimate contains; without one, the value
  /// comes from the lines as fitted.
  std::optional<double> smoothing_correction = {};
  /// The part of the estimate's standard deviation that is random from clip to clip (the positions' noise and their
  /// scatter beyond it), without the errors that all clips share: calibration, clock, scale, mass, the kernel's bias.
  std::optional<double> noise_sd = {};
};

/// Why a point of the motion is left out of a fit.
enum class LeftOut {
  used,             ///< it is used in the fit
  before_start,     ///< before start_s
  after_end,        ///< after end_s
  hand,             ///< the glider is not free yet (or held)
  rest,             ///< it does not move
  stop,             ///< it hits something: the end of the track, a bumper
  kernel_end,       ///< the kernel reaches over the start or the end of the free motion
  kernel_reversal,  ///< the kernel reaches over a reversal
  kernel_gap,       ///< too few frames with a marker within the kernel
  no_marker,        ///< no marker was found in this frame
  outlier,          ///< the centre lies off the motion by more than the noise allows
  short_stretch,    ///< a stretch so short compared with others of its direction that it adds noise and no information
};
/// In words, for tables ("used", "hand", "kernel over a reversal", …).
std::string describe(LeftOut reason);

/// One frame of a clip: as measured, and as smoothed by the local cubic (equations 10 to 12) or another smoother.
struct MotionPoint {
  double t_s = 0.0;                  ///< middle of the exposure (of the marker's row), from the first frame
  std::optional<double> measured_m;  ///< empty if no marker was found
  double x_m = 0.0;
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
  double sd_x_m = 0.0;
  double sd_v_m_s = 0.0;
  double sd_a_m_s2 = 0.0;
  double force_n = 0.0;    ///< the applied force smoothed like x; 0 if there is none
  double applied_n = 0.0;  ///< the applied force as recorded
  bool smoothed = false;   ///< x, v, a hold values
  LeftOut left_out = LeftOut::used;
};

/// The signed change of a line for one standard deviation of an error that it may share with other lines.
struct LineShift {
  double k = 0.0;
  double a0 = 0.0;
};

/// Covariance of one line's coefficients with another's: k_a0 is that of the one's K/m with the other's a0.
struct LineCross {
  double k_k = 0.0, k_a0 = 0.0, a0_k = 0.0, a0_a0 = 0.0;
};

/// The kernel's bias of a line that follows its own law (line_law.h), to be subtracted, and the random covariance after
/// the subtraction.
struct LawBias {
  LineShift shift;
  double var_k = 0.0;
  double cov = 0.0;
  double var_a0 = 0.0;
  double degrees = 0.0;  ///< of freedom; infinite if the covariance is practically known
};

/// The components of the uncertainty of a line (K/m, a0); the standard deviations in LineFit contain all of them. Parts
/// that two lines share (the kernel's bias, the mass, the scale, the calibration) are signed, so that they add up
/// correctly.
struct LineUncertainty {
  double var_k = 0.0;  ///< random: the noise of the positions, and the scatter of the points beyond it
  double var_a0 = 0.0;
  double cov = 0.0;
  double scatter = 0.0;      ///< rms residual over that expected from the noise: 1 if the line is correct
  bool jackknife = false;    ///< the random part comes from leaving out stretches (line_fit.h)
  double degrees = 0.0;      ///< of freedom of the random part; infinite if it is practically known
  double smoothing_k = 0.0;  ///< estimated kernel bias if it cannot be subtracted; not subtracted
  double smoothing_a0 = 0.0;
  std::optional<LawBias> law = {};  ///< if it can: the line itself keeps it, and counts it as an uncertainty
  double mass_k = 0.0;              ///< change for one standard deviation of the mass (with a known force only)
  double mass_a0 = 0.0;
  /// Random, of a line through clips that scatter: the change by each clip's departure from the line, a clip's at the
  /// same place in the lines of both directions; with `clip_degrees` of freedom (configurations.h).
  std::vector<LineShift> clips = {};
  double clip_degrees = 0.0;
  /// Random, with the line of the other direction, where both rest on positions smoothed together.
  LineCross with_other = {};
  double scale_relative = 0.0;         ///< standard deviation of one px_per_m: of a0 and v_lim, not of K/m
  std::vector<LineShift> calibration;  ///< for each mode of the cameras and planes, the same modes for all lines
};

/// The line a = a0 - (K/m) v through the points of one direction of motion.
struct LineFit {
  int direction = 0;  ///< sign of v
  std::size_t points = 0;
  Estimate k_over_m_1_s;
  Estimate a0_m_s2;
  double covariance = 0.0;  ///< of (K/m, a0)
  double r2 = 0.0;
  double from_v_m_s = 0.0;  ///< the range of v on which it rests
  double to_v_m_s = 0.0;
  LineUncertainty parts;
};

/// A stretch of free motion in one direction.
struct Stretch {
  double from_s = 0.0;
  double to_s = 0.0;
  int direction = 0;
  std::size_t points = 0;
};

struct LeftOutInterval {
  double from_s = 0.0;
  double to_s = 0.0;
  std::size_t frames = 0;
  LeftOut reason = LeftOut::used;
};

/// Lost frames that leave no gap in the file's times (lost_frames.h).
struct LostFrames {
  double after_s = 0.0;   ///< by the file's times: the last frame before them
  std::size_t count = 0;  ///< number of consecutive ones
};

/// Where the marker was seen in one frame; pixels, the centre of the first pixel is (0, 0).
struct MarkerSighting {
  std::size_t frame = 0;
  double u_px = 0.0;
  double v_px = 0.0;
  double sd_px = 0.0;  ///< of one coordinate, from the fit
  double radius_px = 0.0;
};

/// A force recorded with the positions, divided by the mass: linear between its samples.
struct RecordedForce {
  std::vector<double> t_s;
  std::vector<double> a_m_s2;
  double mass_sd_relative = 0.0;  ///< common relative error of the whole force

  bool empty() const { return t_s.empty(); }
};

/// Consecutive measured positions of free motion; the motion may turn at v = 0 and is otherwise free, except for a
/// recorded force.
struct FreeBlock {
  std::vector<double> t_s;
  std::vector<double> x_m;
  std::vector<int> directions;                ///< signs of v that occur, in order: one, or two if it turns
  std::vector<std::vector<double>> shared_m;  ///< as in TrackData, of these points
  RecordedForce force;                        ///< over these points; empty if none was recorded
};

struct ClipResult {
  std::string name;
  std::string experiment;  ///< name of the folder it comes from; another folder's is another name (analyze())
  std::size_t frames = 0;
  std::size_t detected = 0;
  double frame_rate_hz = 0.0;  ///< nominal; of a track, the median
  double bandwidth_s = 0.0;
  StrengthChoice bandwidth_method;                 ///< how the bandwidth was chosen, or what takes its place
  std::optional<SmoothingStrength> strength = {};  ///< of a smoother without a bandwidth
  double position_noise_m = 0.0;
  std::vector<double> noise_autocovariance_m2;  ///< of the positions, at lags of 0, 1, … points
  double scale_sd_relative = 0.0;               ///< as in TrackData
  std::string sensor_column = {};               ///< as in TrackData
  std::optional<double> rounding_m;             ///< step to which the positions are rounded, if that matters
  bool forced = false;                          ///< a known force acts
  /// Standard deviation of one speed, of a clip whose speeds were measured in place of positions: such a clip has no x,
  /// no noise of a position and no blocks.
  std::optional<double> speed_noise_m_s = {};
  std::vector<LostFrames> lost_frames;  ///< found from the motion; MotionOptions says how they are treated
  std::vector<FreeBlock> blocks;        ///< used in the fit of the whole motion
  std::vector<LineFit> segments;        ///< at most one for each direction
  Quantity v_lim_m_s;
  std::vector<Stretch> stretches;
  std::vector<LeftOutInterval> left_out;
  std::optional<AgainstLaunch> against_launch;
  std::vector<Note> notes;  ///< what a reader should know: a container's other rate, gaps, …
  std::vector<MotionPoint> motion;
  std::vector<std::vector<double>> shared_m;  ///< as in TrackData, of every frame of `motion`; 0 without a marker
  std::vector<MarkerSighting> sightings;      ///< empty for a track
  /// What the images show besides the motion (image_record.h); null for a track, and if not requested.
  std::shared_ptr<const ImageRecord> images;
};

/// All clips of one mass, one stated inclination and one group.
struct ConfigurationResult {
  double mass_kg = 0.0;
  double incline_deg = 0.0;
  std::optional<double> incline_sd_deg;  ///< the smallest that its clips state, if any
  bool incline_assumed = false;          ///< nobody states it
  std::string group;
  std::vector<std::string> clips;
  std::vector<LineFit> lines;  ///< at most one for each direction, through the points of all its clips
  Quantity k_over_m_1_s;
  Quantity mu;
  Quantity alpha_deg;
  Quantity v_lim_m_s;
  /// For the fit of the whole motion: rms residual over the noise, if that is more than chance explains.
  std::optional<double> scatter = {};
  std::vector<Note> notes;
};

/// A fall, at 80 degrees or more, whose line begins far below gravity.
struct SlowFall {
  Estimate a0_m_s2;  ///< of the line at v = 0, positive downwards
  double gravity_m_s2 = 0.0;
};

/// The line of the motion downwards in a fall, if it begins, by three standard deviations, below a third of the gravity
/// along it. A body released from rest accelerates by g less the weight of the fluid that it displaces, against its
/// mass and the mass of the fluid that it moves. In air that keeps more than a third of g for all but balloons: of
/// density r times the air's, a sphere begins with g (r - 1)/(r + 1/2). A drag that grows faster than proportionally to
/// the speed makes the intercept of this line larger, not smaller (that of a motion upwards smaller). Empty if gravity
/// is not known (0).
std::optional<SlowFall> slow_fall(const ConfigurationResult& configuration, double gravity_m_s2);

struct CornerCell {
  double u_px = 0.0, v_px = 0.0;    ///< mean position of its corners
  double du_px = 0.0, dv_px = 0.0;  ///< mean residual
  double sd_px = 0.0;               ///< of either coordinate
  std::size_t corners = 0;
};

/// Residuals of the pattern's corners after the camera's fit, over the image (corner_errors.h).
struct CornerMap {
  int width_px = 0, height_px = 0;
  std::vector<CornerCell> cells;  ///< with two corners or more, row by row
  double scatter_px = 0.0;        ///< s
  double excess = 0.0;            ///< 0 if no cell has two corners, or nothing scatters
};

/// The χ² of a lens's terms set to zero, and the threshold for keeping them.
struct TermTest {
  std::string term;
  double statistic = 0.0, limit = 0.0;
};

/// The distortion terms of a lens that the views support.
struct LensTerms {
  bool fisheye = false;           ///< otherwise Brown-Conrady
  std::vector<std::string> kept;  ///< "k1", "p1, p2"
  std::vector<TermTest> tests;
};

struct CalibrationResult {
  std::string experiment;
  double rms_px = 0.0;
  std::vector<double> camera_matrix;  ///< 9 numbers, row by row
  std::vector<double> distortion;     ///< k1, k2, p1, p2, k3; a fisheye's k1 to k4
  std::vector<double> sd;             ///< of fx, fy, cx, cy, then `distortion`; 0 for a term that is fixed
  LensTerms lens;
  double restitution_rms_m = 0.0;  ///< of the plane views' corners after restitution, against the pattern
  double plane_rms_px = 0.0;       ///< the same in the image, of one coordinate
  double plane_expected_px = 0.0;  ///< the part that the corners' noise explains
  std::size_t views_used = 0;
  CornerMap rests;          ///< residuals of the corners after the camera's fit, over the image
  std::vector<Note> notes;  ///< views without a visible pattern, …
};

struct PlumbResult {
  std::string group;
  Quantity plumb_deg;           ///< inclination of the line of motion against the plumb line
  std::string experiment = {};  ///< as in ClipResult: another folder's group of that name is another set-up
};

/// What a clip is in which the marker is not found.
enum class WithoutMarker {
  an_error,  ///< of the whole experiment
  left_out   ///< while the other clips are analysed
};

/// A clip of a folder that is not analysed, because its marker was not found.
struct LeftOutClip {
  std::string name;
  std::string experiment;  ///< as in ClipResult
  std::string why;         ///< what was found in the clip, and what is needed
  std::size_t place = 0;   ///< among the clips of all folders, in order,
  std::size_t of = 0;      ///< and the number of those
};

struct AnalysisResults {
  double gravity_m_s2 = 0.0;
  double gravity_sd_m_s2 = 0.0;  ///< in alpha and mu (core/experiment/local_gravity.h)
  std::vector<ClipResult> clips;
  std::vector<ConfigurationResult> configurations;
  std::vector<CalibrationResult> calibrations;            ///< one for each folder that has a pattern
  std::vector<PlumbResult> plumbs;                        ///< one for each group that has a plumb line
  std::string estimator = name_of(LineMethod::ordinary);  ///< a name of fit/estimators.h
  std::vector<LeftOutClip> left_out = {};                 ///< in order; `clips` has the others
};

/// The elements that belong to the clips of the results; `of_all` has one for each clip of all folders, in order.
template <class T>
std::vector<T> of_analysed(const AnalysisResults& results, std::vector<T> of_all) {
  for (auto clip = results.left_out.rbegin(); clip != results.left_out.rend(); ++clip)
    of_all.erase(of_all.begin() + static_cast<std::ptrdiff_t>(clip->place));
  return of_all;
}

}  // namespace glidelab::core
