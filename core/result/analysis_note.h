/// What a reader of results should know besides the numbers, as data: one struct for each remark, with its details.
/// report/analysis/note_words.h puts it into words.
///
/// A remark names no clip: it is stored in the notes of the clip, the configuration or the calibration that it
/// concerns.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glidelab::core {

// About a video or a folder of frames, as it was read.

/// Files in a folder of frames that are not images.
struct FilesSkipped {
  std::size_t files = 0;
};

/// The container's rate differs from that of experiment.toml.
struct ContainerOfOtherRate {
  double container_hz = 0.0, stated_hz = 0.0;
  bool by_rate = true;  ///< the times are those of the stated rate; otherwise the container's time stamps
};

/// They are left out, since the times are the container's.
struct LastFramesUnstamped {};

struct IrregularStamps {
  std::size_t irregular = 0, steps = 0;
  double median_step_s = 0.0, longest_step_s = 0.0;
  bool by_rate = true;  ///< as above
};

/// Frames that are identical to the previous one, bit by bit.
struct RepeatedFrames {
  std::size_t repeated = 0, frames = 0;
};

/// Rounded time stamps that are explained by evenly spaced frames.
/// Frames in mid-motion that show the image of the frame before, left out (core/math/frame_repeats.h).
struct RepeatsLeftOut {
  std::size_t repeats = 0, frames = 0;
  bool in_place_of_lost = false;  ///< the other times are right
  double camera_hz = 0.0;  ///< of a film brought to a higher rate, by which the others are timed; 0: no such film
};

/// Each frame has rows of two times, half a frame apart.
struct InterlacedFilm {
  double frame_rate_hz = 0.0;
};

struct EvenStamps {
  double tick_s = 0.0, step_s = 0.0;
  double half_width_s = 0.0;  ///< of the steps that would explain them
};

// About a table of positions, as it was read. Columns are named by their headers, as in the file.

/// The sheet read of a workbook that has others.
struct SheetTaken {
  std::string sheet;
};

/// The columns read as positions and times, of a table that has others.
struct ColumnsTaken {
  std::string x, t;
  std::string run;  ///< the run that they belong to, if the name of x does not contain it
};

/// A column without a unit is read in SI units.
struct UnitAssumed {
  std::string column;
  std::string_view unit;  ///< "metres", "seconds"
};

struct HeightTaken {
  std::string column;
};

struct ForceUnused {
  std::string column;
};

/// A path in (x, y) whose y is taken, because it covers more of the motion.
struct MotionAlongY {
  double y_m = 0.0, x_m = 0.0;  ///< ranges
};

/// A path in (x, y) at an angle to the axis along which it is read.
struct SlantedPath {
  double off_deg = 0.0;
  double stretch = 1.0;  ///< distances along the path over those along the axis
  bool along_y = false;
};

/// A requested column of x beside one of y that belongs to the same body: the path that the two make is no line along
/// x.
struct OtherAxisUnused {
  std::string column;    ///< that of y
  double off_deg = 0.0;  ///< from the path to the axis along which it is read
  double off_m = 0.0;    ///< range of its deviation from a straight line
};

/// Heights whose sign is changed, so that x rises along the motion.
struct CountedAlongMotion {};

/// Rows between others that lack a time or a position.
struct RowsIncomplete {
  std::size_t rows = 0;
};

/// Rows with the time of the row above, left out.
struct TimesRepeated {
  std::size_t rows = 0;
  double first_s = 0.0;
};

/// Rows that repeat the value before while the body moves on, left out: a sensor that is slower than its logger.
struct ValuesHeld {
  std::size_t held = 0, rows = 0;
  std::size_t usual = 0;  ///< rows from one value to the next
};

/// Rows of a table in which its own measure of certainty is below `least`, and that are left out.
struct UnlikelyLeftOut {
  std::string column;  ///< of the measure
  std::size_t rows = 0;
  double least = 0.0;
};

/// Frame numbers and pixels of a table, and what they were divided by; 0 for what the table has itself.
struct ImageUnitsTaken {
  double frame_rate_hz = 0.0, px_per_m = 0.0;
  bool exact_scale = false;
};

/// Values that a sensor or a tracker wrote while it saw nothing, and that are left out.
struct PositionsUnseen {
  std::size_t positions = 0;
  double value_m = 0.0, from_s = 0.0;  ///< of the first of them
};

/// Positions at the ends of a recording that lie anywhere, and that are left out.
struct PositionsScattered {
  std::size_t at_start = 0, at_end = 0;
};

/// Runs of positions that lie off the motion, as if of something else, and that are left out.
struct PositionsAstray {
  std::size_t positions = 0;
  double from_s = 0.0;  ///< of the first of them
  double off_m = 0.0;   ///< the largest jump to one of them
};

/// Columns without a header, more than one of which could be times.
struct ColumnsGuessed {
  std::string x, t;
  bool either = false;  ///< another could be times as well; otherwise one alone could, and is taken
};

/// A path in (x, y) that leaves its straight line.
struct PathBends {
  double off_m = 0.0;      ///< range of the smooth deviation across the line
  double slope_deg = 0.0;  ///< by how much its direction changes
};

/// Rounded times of a table that are explained by evenly spaced frames.
struct RoundedTimes {
  double tick_s = 0.0, step_s = 0.0;
};

// About a Tracker project, as it was read.

struct NoLengthUnit {};

/// The point mass and the coordinate that are read as x.
struct PointMassTaken {
  std::string mass;
  std::string towards;    ///< the positive direction of x: "+X", "-Y"
  bool along_y = false;   ///< otherwise along X
  bool as_stated = true;  ///< otherwise the coordinate of larger extent
};

/// The line of the positions makes an angle with the coordinate that is read as x.
struct MassMovesAslant {
  double off_deg = 0.0;
  double short_by = 0.0;  ///< fraction of the distance that x lacks
  bool along_y = false;
};

struct PositionsOutsideClip {
  std::size_t positions = 0;
};

/// Positions that Tracker interpolated between two marks.
struct PositionsFilledIn {
  std::size_t positions = 0;
};

// About a file on its own.

/// It does not state these.
struct AssumedStatements {
  std::optional<double> mass_kg;  ///< the assumed mass; empty if it is stated
  bool level = false;             ///< an inclination of 0 is assumed
};

/// No inclination is stated, and the body speeds up like one that falls.
struct MayBeAFall {
  std::size_t positions = 0;  ///< that are taken for those in a hand
  double a_m_s2 = 0.0;        ///< in the first third of these, without its sign
};

/// About positions without a file: a mass of 1 kg is assumed.
struct AssumedMass {};

// About a calibration.

/// An image that departs from the fitted camera.
struct OutlyingView {
  std::string file;
  double error_px = 0.0;
  bool left_out = false;  ///< or kept, because fewer than three would be left
};

struct NoPatternInSight {
  std::vector<std::string> files;
};

/// Corners that keep the detector's position.
struct UnrefinedCorners {
  std::size_t corners = 0;
};

/// Neighbouring corners have correlated errors: a bent pattern, or a lens that the model does not describe.
struct CornersErrTogether {
  double shared_px = 0.0, own_px = 0.0;
};

struct UncertainFocalLength {
  double focal_px = 0.0, sd_px = 0.0;
};

/// An equidistant fisheye fits the corners better than the Brown-Conrady model, or as well with fewer terms.
struct FisheyePreferred {
  double rms_px = 0.0, brown_conrady_rms_px = 0.0;
  int fewer_terms = 0;  ///< if these decided; 0: it fits better
};

/// The corners of a group's plane views do not lie where the camera model puts them, or the views disagree with each
/// other.
struct PlaneViewsDisagree {
  std::string group;
  double rms_px = 0.0, expected_px = 0.0;
  std::size_t views = 1;
};

// About the marker in a clip.

struct MarkerAtRest {};

/// Frames in which the marker counts as not seen: next to a similar object at rest, or partly hidden.
struct MarkerConcealed {
  enum class By { similar, disturbance } by = By::disturbance;
  std::size_t frames = 0;
};

/// How a marker that is not a plain disc is measured.
struct MarkerMeasuredBy {
  enum class What { centroid, shading, own_look, own_centre } what = What::centroid;
};

/// The size of its image over that predicted from its diameter.
struct MarkerOfOtherSize {
  double ratio = 1.0;
};

/// What a second pass over the clip's images fitted.
struct MarkerFittedAgain {
  bool sphere = false;           ///< lit from one side; otherwise a disc
  bool still_background = true;  ///< against the background seen in other frames; otherwise against what moves with it
  std::size_t seen = 0, seen_before = 0;
};

/// Sightings that cannot be corrected for a mosaic or a tone curve: the windows around them take too much memory, or
/// their fit with the pixel response does not converge. Either they are left out, or none of the clip is corrected.
struct PixelsAnswerLeft {
  std::size_t kept = 0, sightings = 0;
  bool left_out = false;
};

/// Frames without the marker, where it is not at the edge of the image.
struct MarkerLost {
  std::size_t before = 0, between = 0, after = 0;  ///< the first sighting, sightings, the last one
  std::size_t frames = 0;                          ///< of the clip
};

struct DarkMarker {};

/// It is treated as a disc in the plane of motion; otherwise as a sphere.
struct DiscMarker {};

/// A marker of the stated diameter is not found; one of another size is.
struct NotOfStatedSize {
  std::string failure;
};

// About positions in the plane of motion.

struct NoRay {
  std::size_t sightings = 0;
};

struct SlantedLine {
  double angle_deg = 0.0;  ///< to the pattern's X axis
};

struct ExactScale {};

/// The codec's effect on the positions is subtracted.
struct CodecDragSubtracted {
  double rms_px = 0.0;
};

// About a clip's motion.

struct FramesMissing {
  std::size_t frames = 0;
  std::vector<double> after_s;
  bool put_right = false;  ///< the later times are corrected
};

struct OutliersLeftOut {
  std::size_t outliers = 0, positions = 0;
};

struct CorrelatedNoise {
  double neighbours = 0.0;  ///< correlation of successive positions
};

/// Points scatter about a line by more than the noise explains.
struct LineScatters {
  int direction = 0;
  double ratio = 1.0;
};

struct NoiseGrowsWithSpeed {
  double slowest_m = 0.0, fastest_m = 0.0;  ///< standard deviations
};

/// Positions are rounded so coarsely that they repeat.
struct CoarseRounding {
  double rounding_m = 0.0;
  bool instead_of_generalised = false;  ///< ordinary lines take the place of generalised ones
};

struct GeneralisedLine {
  int direction = 0;
  std::size_t positions = 0;
};

/// Generalised least squares did not converge.
struct NoGeneralisedLine {
  int direction = 0;
};

/// Motion against the stated direction of the launch, before any along it (free_motion.h).
struct AgainstLaunch {
  int direction = 0;              ///< direction of this motion
  std::optional<double> until_s;  ///< where motion in the launch direction begins; if empty there is none, and nothing
                                  ///< is left out
  double share = 0.0;             ///< fraction of the freely moving points
  bool at_a_turn = false;  ///< it turns into motion in the launch direction with neither a rest nor a push in between
};

// About a configuration.

struct MassInGrams {
  double mass_kg = 0.0;
  std::optional<double> lightest_kg;  ///< of the other gliders, if the mass stands out against it
};

/// A stated angle, in degrees.
struct StatedIncline {
  double deg = 0.0;
  std::optional<double> sd_deg;
  std::string_view by;  ///< "incline_deg", "the plumb line"
};

/// The stated inclination against that of the motion (incline_contradiction()).
struct InclineContradiction {
  StatedIncline stated;
  double deg = 0.0, sd_deg = 0.0;             ///< of the motion
  int bound = 0;                              ///< -1: the inclination is at most `deg`, 1: at least
  std::optional<double> beyond_gravity = {};  ///< the acceleration without friction, if no inclination can produce it;
                                              ///< m/s^2
  double gravity_m_s2 = 0.0;
  double off_deg = 0.0;  ///< infinite if no inclination can produce the measured acceleration
  bool gross = false;    ///< more than a carelessly set up track explains; see incline_contradiction()
};

/// mu of motion in one direction rests on the stated inclination.
struct MuFromIncline {
  double deg = 0.0, sd_deg = 0.0;
};

/// A motion that is no run along an incline: what it is, and what to do (core/check/finding.h, fault_words()).
struct NoRun {
  std::string found, advice;
  bool at_rest = false;  ///< nothing moves: no law is in doubt
};

/// Falls at a constant speed, which is taken for the terminal velocity (core/motion/steady_fall.h).
struct SteadyFall {
  std::size_t clips = 0;
};

/// The value of gravity is that of no particular place: alpha and mu are for it, and contain its uncertainty.
struct GravityAssumed {
  double gravity_m_s2 = 0.0, sd_m_s2 = 0.0;
};

/// A robust fit of the whole motion.
struct RobustFit {
  std::size_t left_out = 0, positions = 0;
};

/// The intervals of a fit of the whole motion are widened, because the positions scatter about it by more than their
/// noise, or because the motions that it joins differ from one another by more than theirs.
struct FitScatters {
  double ratio = 1.0, degrees = 0.0;
  bool motions_differ = false;
};

using AnyNote =
    std::variant<FilesSkipped, ContainerOfOtherRate, LastFramesUnstamped, IrregularStamps, RepeatedFrames,
                 RepeatsLeftOut, InterlacedFilm, EvenStamps, SheetTaken, ColumnsTaken, UnitAssumed, HeightTaken,
                 ForceUnused, MotionAlongY, SlantedPath, CountedAlongMotion, RowsIncomplete, UnlikelyLeftOut,
                 ImageUnitsTaken, PositionsUnseen, PositionsScattered, PositionsAstray, ColumnsGuessed, PathBends,
                 RoundedTimes, NoLengthUnit, PointMassTaken, MassMovesAslant, PositionsOutsideClip, PositionsFilledIn,
                 AssumedStatements, MayBeAFall, AssumedMass, OutlyingView, NoPatternInSight, UnrefinedCorners,
                 CornersErrTogether, UncertainFocalLength, FisheyePreferred, PlaneViewsDisagree, MarkerAtRest,
                 MarkerConcealed, MarkerMeasuredBy, MarkerOfOtherSize, MarkerFittedAgain, PixelsAnswerLeft, MarkerLost,
                 DarkMarker, DiscMarker, NotOfStatedSize, NoRay, SlantedLine, ExactScale, CodecDragSubtracted,
                 FramesMissing, OutliersLeftOut, CorrelatedNoise, LineScatters, NoiseGrowsWithSpeed, CoarseRounding,
                 GeneralisedLine, NoGeneralisedLine, AgainstLaunch, MassInGrams, InclineContradiction, MuFromIncline,
                 GravityAssumed, RobustFit, FitScatters, SteadyFall, OtherAxisUnused, NoRun, TimesRepeated, ValuesHeld>;

/// One remark. The code that copies, moves and destroys so many kinds is compiled once (analysis_note.cpp), not
/// wherever results are used.
///
/// diagnose::Note repeats these declarations rather than share a template with this one. A template would need an
/// `extern template` next to every variant. Where that is forgotten, the code is compiled everywhere again and nothing
/// says so; a definition that is forgotten here does not link.
struct Note : AnyNote {
  using AnyNote::AnyNote;
  Note(const Note&);
  Note(Note&&) noexcept;
  Note& operator=(const Note&);
  Note& operator=(Note&&) noexcept;
  ~Note();
};

/// Whether a reader of the values must know it: data that were left out, columns that were guessed, a bent path.
bool is_of_reading(const Note& note);

}  // namespace glidelab::core
