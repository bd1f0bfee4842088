/// What a check of a recording finds, as data: one struct for each kind of finding, with its details.
/// report/check/finding_words.h puts it into words.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::core {

enum class Severity {
  note,     ///< good to know
  change,   ///< the analysis works and would improve
  unusable  ///< no analysis, or an untrustworthy one
};

/// What a finding is about, as far as one wrong statement explains several (recording_findings.h).
enum class Topic {
  other,
  length,   ///< a distance, a speed or an acceleration
  size,     ///< of the marker against its stated diameter
  incline,  ///< the stated inclination against the motion
  time,     ///< frame times
  mass,
  failure  ///< a clip that could not be tracked
};

/// What a finding concerns: clips, by their names, or one of the other parts of a recording.
struct Subject {
  enum class Part { clips, pattern, marker, scale, track, masses, plumb_line } part = Part::clips;
  std::vector<std::string> clips = {};  ///< of Part::clips
};

enum class LengthUnit { feet, inches, centimetres, millimetres };

/// How many of a unit make a metre.
constexpr double per_metre(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::feet:
      return 1.0 / 0.3048;
    case LengthUnit::inches:
      return 1.0 / 0.0254;
    case LengthUnit::centimetres:
      return 100.0;
    case LengthUnit::millimetres:
      return 1000.0;
  }
  return 1.0;
}

/// Whichever of centimetres and millimetres brings a value closest to the usual one.
inline LengthUnit likely_unit(double value, double usual_m) {
  const auto off = [&](LengthUnit unit) { return std::abs(std::log(value / per_metre(unit) / usual_m)); };
  return off(LengthUnit::centimetres) < off(LengthUnit::millimetres) ? LengthUnit::centimetres
                                                                     : LengthUnit::millimetres;
}

/// Metres that a body usually covers; kLongestRun_m (core/result/estimate.h) is the most.
inline constexpr double kUsualRun_m = 1.0;
/// The unit in which a run of more than kLongestRun_m is likely to be stated; empty for one that a body may cover.
std::optional<LengthUnit> unit_of_long_run(double range_m);
/// Positions farther apart make a unit doubtful: in space on an incline of less than 60 degrees, in a fall, in time.
inline constexpr double kLongRange_m = 8.0, kLongFall_m = 20.0, kSlowFrames_s = 1.0;

struct UnitName {
  const char *many, *one;
};

constexpr UnitName name_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::feet:
      return {"feet", "foot"};
    case LengthUnit::inches:
      return {"inches", "inch"};
    case LengthUnit::centimetres:
      return {"centimetres", "centimetre"};
    case LengthUnit::millimetres:
      break;
  }
  return {"millimetres", "millimetre"};
}

/// The keys that turn pixels, or a file's numbers, into metres.
struct LengthSources {
  bool square = false, scale = false;  ///< square_m, [scale]
  bool tracks = false;                 ///< the unit of x in tracks
};

namespace found {

// The pattern and its camera.

/// No camera follows from the images of the pattern.
struct NoCamera {
  std::string failure;
  std::size_t with_pattern = 0, images = 0;
};

struct NoPatternIn {
  std::vector<std::string> files;
};

/// The calibration uses few views.
struct FewViews {
  std::size_t views = 0;
};

/// Corners lie off the places that the fitted camera gives them.
struct CornersOff {
  double rms_px = 0.0;
};

/// The views cover a small share of the image.
struct LittleCovered {
  double share = 0.0;
};

struct LittleTilt {
  double most_deg = 0.0;
};

struct PlaneViewsOff {
  double rms_px = 0.0, expected_px = 0.0;
};

// How a clip was tracked.

struct NotTracked {
  std::string failure;
  bool images = true;  ///< false for a track from a file
};

/// A track from a file is short.
struct FewPositions {
  std::size_t positions = 0;
  std::size_t unmarked = 0;  ///< rows between them that lack a time or x, if they are more
};

/// The marker is seen in few frames.
struct FewSightings {
  std::size_t frames = 0;
};

/// It is missing between its first and its last sighting.
struct SightingsMissing {
  std::size_t seen = 0, spanned = 0;
};

/// It is missing before its first sighting, or after its last one.
struct UnseenAtEnd {
  bool at_start = false;
  std::size_t frame = 0, frames = 0;  ///< that of this sighting, counted from 1
  bool at_edge = false;               ///< of the image
};

struct SmallMarker {
  double width_px = 0.0;
};

/// The marker lengthens with its speed, as with a longer exposure than stated.
struct LongExposure {
  double exposure_s = 0.0;
  bool stated = false;  ///< an exposure is stated
};

struct Smeared {
  double speed_m_s = 0.0, blur_px = 0.0, marker_px = 0.0;
  bool known = false;  ///< from a stated or measured exposure; otherwise from one as long as the frame time
};

/// A share of the marker's path lies outside the region in which the pattern was seen.
struct OutsidePattern {
  double share = 0.0;
};

// Its light.

struct MarkerSaturated {};

struct PixelsSaturated {
  double share = 0.0;
};

struct Dark {
  double brightest = 0.0;  ///< share of the camera's range
};

struct LittleContrast {
  double contrast = 0.0;
};

struct NoisyContrast {
  double over_noise = 0.0;
};

struct LitFromOneSide {
  double pull_px = 0.0, change_px = 0.0;  ///< as in MarkerLighting
  std::optional<double> px_per_m;
  bool changes = false;  ///< along the path, by more than noise explains
};

/// The contrast along the path falls to this share of its largest.
struct ContrastFalls {
  double least = 1.0;
};

/// A place at which the light changes within a diameter of the marker.
struct ShadowEdge {
  double x_m = 0.0;
  double fall = 0.0;       ///< part of the brighter side that is lost on the darker one
  bool downhill = false;   ///< whether the darker side is the lower one
  bool of_marker = false;  ///< the marker itself darkens; otherwise what is around it
  struct Frames {
    std::size_t first = 0, last = 0;  ///< counted from 1
  };
  std::string clip;            ///< in which
  std::vector<Frames> frames;  ///< the marker lies across it; of several clips, the first
};

/// The light along the path falls by this part per metre, which displaces the centroid of a marker.
struct LightFalls {
  double part_per_m = 0.0, displaces_m = 0.0;
  bool of_marker = false;  ///< as of ShadowEdge
  enum class Towards { right, left, bottom, top } towards = Towards::right;
};

/// Brightness of 1 ± depth at f_hz, which the frames show as seen_hz.
struct LightFlickers {
  double depth = 0.0, f_hz = 0.0, seen_hz = 0.0, displaces_m = 0.0;
};

/// The images show the blocks of a codec: ClipCheck::block_steps.
struct StrongCompression {
  double block_steps = 0.0;
};

/// The frames are woven from fields half a frame apart.
struct Interlaced {
  double frame_rate_hz = 0.0;
};

// Its times.

struct OtherRateInFile {
  double file_hz = 0.0, stated_hz = 0.0;
  bool by_rate = true;  ///< the stated rate gives the times; otherwise the file's time stamps do
};

struct UnevenStamps {
  double drift_frames = 0.0;
  std::size_t irregular_steps = 0;
  bool by_rate = true;
};

/// The marker jumps by the distance of whole frames.
struct Jumps {
  std::size_t jumps = 0;
};

struct FramesRepeated {
  std::size_t repeated = 0, frames = 0;
  std::size_t stalls = 0;   ///< of the body, for a single frame
  bool times_hold = false;  ///< the analysis leaves them out, and knows the times of the others
};

/// What a file on its own does not state.
struct AssumedForFile {
  std::optional<double> mass_kg, incline_deg;  ///< empty if stated
};

struct NoPlumbAngle {
  std::string failure;
};

// Statements against one another, and against the recording.

struct MassesApart {
  struct Named {
    std::string clip;
    double mass_kg = 0.0;
  };
  std::vector<Named> heavy;
  Named lightest;
  double ratio = 1.0;  ///< or more
};

struct MarkerSizeOff {
  double seen_px = 0.0, expected_px = 0.0;
  double off = 0.0;       ///< by this share
  bool by_scale = false;  ///< the scale comes from [scale], otherwise from the pattern's squares
};

struct BeyondTrack {
  double distance_m = 0.0, length_m = 0.0;
  LengthSources lengths;
};

/// The angle that is stated, or that of the plumb line, against the motion.
struct InclineOff {
  InclineContradiction contradiction;
  LengthSources lengths;
  bool filmed = false;  ///< the frame rate enters
};

struct AgainstStatedLaunch {
  AgainstLaunch motion;                 ///< of the clip that shows it best
  std::string launched;                 ///< its keys
  std::optional<std::string> downhill;  ///< empty if not stated
  std::string clip;
  std::size_t against = 1, clips = 1;  ///< so many of so many clips
  enum class Stated { in_track, in_group, in_either } stated = Stated::in_track;
};

// Units.

/// A length that is not in metres.
struct LengthInUnit {
  std::string key;
  double value = 0.0;
  LengthUnit unit = LengthUnit::millimetres;
};

/// px_per_m counts the pixels of another unit.
struct ScaleInUnit {
  double px_per_m = 0.0;
  LengthUnit unit = LengthUnit::millimetres;
};

struct MassInGrams {
  double mass_kg = 0.0;
};

struct TrackInUnit {
  double distance_m = 0.0;
  LengthUnit unit = LengthUnit::millimetres;
};

struct InclineInRadians {
  double stated_deg = 0.0, as_radians_deg = 0.0, motion_deg = 0.0;
};

/// With the file's frame rate the motion has the stated inclination.
struct WrongFrameRate {
  double stated_hz = 0.0, file_hz = 0.0, incline_deg = 0.0;
};

// Motions that no body on an incline has: a diagnosis refuses them.

struct Oscillation {
  std::size_t turns = 0;
};

struct BeyondGravity {
  double acceleration_m_s2 = 0.0, gravity_m_s2 = 0.0;
  std::vector<LengthUnit> units;  ///< of x, perhaps
  bool fall = false;              ///< in this unit it would be a free fall
};

struct FreeFall {
  double over_gravity = 1.0, incline_deg = 0.0;
};

struct CurvedPath {
  double bend = 0.0;  ///< sagitta over length
};

/// x changes by the same step from row to row: by 1, or by a multiple of a quarter turn.
struct Counted {
  double step = 1.0;
};

/// The scatter of the positions (one standard deviation) is as large as the motion.
struct LostInNoise {
  double noise_m = 0.0, distance_m = 0.0;
};

/// The positions scatter about one place.
struct AtRest {
  double spread_m = 0.0;  ///< about their mean; 0: all are the same
};

using MotionFault = std::variant<Oscillation, BeyondGravity, FreeFall, CurvedPath, Counted, LostInNoise, AtRest>;

/// "this is an oscillation, …", and what to do. Worded here because a diagnosis refuses such a motion with these
/// sentences.
struct FaultWords {
  std::string found, advice;
};
FaultWords fault_words(const MotionFault& fault);

// Other remarks on a motion.

/// A fall somewhat above gravity: x is too long by acceleration / gravity, or the times too short by its square root.
struct FallAboveGravity {
  double acceleration_m_s2 = 0.0, gravity_m_s2 = 0.0;
};

struct LongRun {
  double distance_m = 0.0;
};

/// At first it speeds up by more than any incline gives.
struct Pushed {
  double acceleration_m_s2 = 0.0, until_s = 0.0;
};

/// Positions are far apart in time.
struct SlowFrames {
  double apart_s = 0.0;
};

/// A fall that begins far below gravity.
struct FallsSlowly {
  SlowFall fall;
};

struct Gaps {
  double share = 0.0;  ///< of the time
  double longest_s = 0.0;
};

/// The first of `count` interruptions.
struct Interrupted {
  double from_s = 0.0, to_s = 0.0;
  std::size_t count = 1;
};

/// A sensor that is slower than its logger.
struct SlowSensor {
  ValuesHeld values;
};

struct Smoothed {
  double share = 0.0;  ///< of the distance: the scatter is smaller
};

}  // namespace found

using AnyFound = std::variant<
    Note, found::NoCamera, found::NoPatternIn, found::FewViews, found::CornersOff, found::LittleCovered,
    found::LittleTilt, found::PlaneViewsOff, found::NotTracked, found::FewPositions, found::FewSightings,
    found::SightingsMissing, found::UnseenAtEnd, found::SmallMarker, found::LongExposure, found::Smeared,
    found::OutsidePattern, found::MarkerSaturated, found::PixelsSaturated, found::Dark, found::LittleContrast,
    found::NoisyContrast, found::LitFromOneSide, found::ContrastFalls, found::ShadowEdge, found::LightFalls,
    found::LightFlickers, found::StrongCompression, found::Interlaced, found::OtherRateInFile, found::UnevenStamps,
    found::Jumps, found::FramesRepeated, found::AssumedForFile, found::NoPlumbAngle, found::MassesApart,
    found::MarkerSizeOff, found::BeyondTrack, found::InclineOff, found::AgainstStatedLaunch, found::LengthInUnit,
    found::ScaleInUnit, found::MassInGrams, found::TrackInUnit, found::InclineInRadians, found::WrongFrameRate,
    found::MotionFault, found::FallAboveGravity, found::LongRun, found::Pushed, found::SlowFrames, found::FallsSlowly,
    found::Gaps, found::Interrupted, found::Smoothed, found::SlowSensor>;

/// What was found; a Note if the analysis notes the same. What copies, moves and destroys it is compiled once
/// (finding.cpp), as of Note.
struct Found : AnyFound {
  using AnyFound::AnyFound;
  Found(const Found&);
  Found(Found&&) noexcept;
  Found& operator=(const Found&);
  Found& operator=(Found&&) noexcept;
  ~Found();
};

struct Finding {
  Severity severity = Severity::note;
  Subject about;
  Found found;
  Topic topic = Topic::other;
  std::vector<Finding> follow = {};  ///< findings that follow from this one, which is their root cause
};

/// Whether a file is made to be played slowly, as high-speed clips are: at a third of the stated rate or less. At half
/// of it, frames may have been dropped instead.
bool is_playback(double file_hz, double stated_hz);

/// Collects the findings about one subject; `findings` outlive it.
class FindingBook {
 public:
  FindingBook(std::vector<Finding>& findings, Subject about) : findings_(findings), about_(std::move(about)) {}
  void add(Severity severity, Found found, Topic topic = Topic::other) {
    findings_.push_back({severity, about_, std::move(found), topic});
  }

 private:
  std::vector<Finding>& findings_;
  Subject about_;
};

}  // namespace glidelab::core
