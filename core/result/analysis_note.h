/// What a reader of results should know besides the numbers, as data: one struct for each remark, with what belongs to
/// it. report/analysis/note_words.h puts it into words.
///
/// A remark names no clip: it stands in the notes of the clip, the configuration or the calibration that it is about.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glidelab::core {

// Of a file, as it was read.

/// What the reader of a file says of the file's own words: its columns, units, rates. Worded where it is read.
struct AboutFile {
  std::string text;
};

/// Frames that are equal to the one before, bit by bit.
struct RepeatedFrames {
  std::size_t repeated = 0, frames = 0;
};

/// Rounded time stamps that frames at an even distance explain.
struct EvenStamps {
  double tick_s = 0.0, step_s = 0.0;
  double half_width_s = 0.0;  ///< of the steps that would explain them
};

/// Nobody states these of a file on its own.
struct AssumedStatements {
  std::optional<double> mass_kg;  ///< as assumed; none where it is stated
  bool level = false;             ///< an inclination of 0 is assumed
};

/// Of positions without a file: a mass of 1 kg is assumed.
struct AssumedMass {};

// Of a calibration.

/// An image that departs from the fitted camera.
struct OutlyingView {
  std::string file;
  double error_px = 0.0;
  bool left_out = false;  ///< or kept, since fewer than three would be left
};

struct NoPatternInSight {
  std::vector<std::string> files;
};

/// Corners that keep the detector's position.
struct UnrefinedCorners {
  std::size_t corners = 0;
};

/// Neighbouring corners err together: a bent pattern, or a lens that the model does not describe.
struct CornersErrTogether {
  double shared_px = 0.0, own_px = 0.0;
};

struct UncertainFocalLength {
  double focal_px = 0.0, sd_px = 0.0;
};

/// Corners fit better to an equidistant fisheye than to Brown and Conrady's model.
struct FisheyeFitsBetter {
  double rms_px = 0.0, brown_conrady_rms_px = 0.0;
};

/// The corners of a group's plane views do not lie where the camera places them, or the views among each other do not.
struct PlaneViewsDisagree {
  std::string group;
  double rms_px = 0.0, expected_px = 0.0;
  std::size_t views = 1;
};

// Of the marker in a clip.

struct MarkerAtRest {};

/// Frames in which the marker counts as not seen: beside a similar object at rest, or partly hidden.
struct MarkerConcealed {
  enum class By { similar, disturbance } by = By::disturbance;
  std::size_t frames = 0;
};

/// By what a marker that is no plain disc is measured.
struct MarkerMeasuredBy {
  enum class What { centroid, shading } what = What::centroid;
};

/// Its image over what its diameter predicts.
struct MarkerOfOtherSize {
  double ratio = 1.0;
};

/// What a second look at the clip's images fitted.
struct MarkerFittedAgain {
  bool sphere = false;           ///< lit from one side; else a disc
  bool still_background = true;  ///< before what other frames show; else before what moves with it
  std::size_t seen = 0, seen_before = 0;
};

/// Sightings that keep what a mosaic or a tone curve does to them: the windows around them take too much memory, or
/// their fit with the pixels' answer does not converge.
struct PixelsAnswerLeft {
  std::size_t kept = 0, sightings = 0;
};

struct DarkMarker {};

/// A marker of the stated diameter is not found; one of another size is.
struct NotOfStatedSize {
  std::string failure;
};

// Of positions in the plane of motion.

struct NoRay {
  std::size_t sightings = 0;
};

struct SlantedLine {
  double angle_deg = 0.0;  ///< to the pattern's X axis
};

struct ExactScale {};

/// What a codec did to the positions is subtracted.
struct CodecDragSubtracted {
  double rms_px = 0.0;
};

// Of a clip's motion.

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

/// Points scatter about a line by more than noise explains.
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
  int direction = 0;  ///< in which it moves
  std::optional<double>
      until_s;             ///< where motion as launched begins; without a value there is none, and nothing is left out
  double share = 0.0;      ///< of the points that move freely
  bool at_a_turn = false;  ///< it turns into motion as launched with neither a rest nor a push between
};

// Of a configuration.

struct MassInGrams {
  double mass_kg = 0.0;
  std::optional<double> lightest_kg;  ///< of the others, where it stands out against it
};

/// An angle that somebody states, in degrees.
struct StatedIncline {
  double deg = 0.0;
  std::optional<double> sd_deg;
  std::string_view by;  ///< "incline_deg", "the plumb line"
};

/// The stated inclination against that of the motion (incline_contradiction()).
struct InclineContradiction {
  StatedIncline stated;
  double deg = 0.0, sd_deg = 0.0;             ///< of the motion
  int bound = 0;                              ///< -1: it is at most `deg`, 1: at least
  std::optional<double> beyond_gravity = {};  ///< the acceleration without friction, where no inclination has it; m/s^2
  double gravity_m_s2 = 0.0;
  double off_deg = 0.0;  ///< infinite where no inclination has the acceleration that was found
  bool gross = false;    ///< more than a track that was set up carelessly explains; see incline_contradiction()
};

/// A robust fit of the whole motion.
struct RobustFit {
  std::size_t left_out = 0, positions = 0;
};

/// The intervals of a fit of the whole motion are widened.
struct FitScatters {
  double ratio = 1.0, degrees = 0.0;
};

using AnyNote =
    std::variant<AboutFile, RepeatedFrames, EvenStamps, AssumedStatements, AssumedMass, OutlyingView, NoPatternInSight,
                 UnrefinedCorners, CornersErrTogether, UncertainFocalLength, FisheyeFitsBetter, PlaneViewsDisagree,
                 MarkerAtRest, MarkerConcealed, MarkerMeasuredBy, MarkerOfOtherSize, MarkerFittedAgain,
                 PixelsAnswerLeft, DarkMarker, NotOfStatedSize, NoRay, SlantedLine, ExactScale, CodecDragSubtracted,
                 FramesMissing, OutliersLeftOut, CorrelatedNoise, LineScatters, NoiseGrowsWithSpeed, CoarseRounding,
                 GeneralisedLine, NoGeneralisedLine, AgainstLaunch, MassInGrams, InclineContradiction, RobustFit,
                 FitScatters>;

/// One remark. What copies, moves and destroys so many kinds is compiled once (analysis_note.cpp), not wherever results
/// are.
struct Note : AnyNote {
  using AnyNote::AnyNote;
  Note(const Note&);
  Note(Note&&) noexcept;
  Note& operator=(const Note&);
  Note& operator=(Note&&) noexcept;
  ~Note();
};

}  // namespace glidelab::core
