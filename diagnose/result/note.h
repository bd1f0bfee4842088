/// What a reader of a diagnosis should know besides the verdict, as data; report/diagnosis/words/diagnosis_words.h puts
/// it into words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/check/finding.h"
#include "core/result/analysis_note.h"
#include "diagnose/result/explanation.h"
#include "diagnose/result/gap_place.h"

namespace glidelab::diagnose {

// Which part of the data was used.

/// A clip has no free motion of this many points.
struct NoFreeMotion {
  std::string clip;
  std::size_t fewest = 0;
};

/// One position in `every` is weighed; of the pieces of driven motions, or of all others.
struct ThinnedPositions {
  std::size_t points = 0, every = 1;
  bool driven = false;
};

/// A recorded force turns the motion so often that it is cut into pieces.
struct CutAtTurns {
  std::size_t turns = 0, turns_of_piece = 0;
};

/// Only some of the pieces of driven motions are weighed.
struct SomePieces {
  std::size_t pieces = 0, kept = 0;
};

/// Frames that look like a hand or a stop are left out.
struct HandLeftOut {
  std::size_t frames = 0;
};

/// Frames that look like a hand or a stop are included, and a named effect explains them.
struct HandExplained {
  std::size_t frames = 0;
  std::string effect;  ///< its id
};

/// A large part of the positions is not used: left out, or outliers.
struct SetAside {
  std::size_t positions = 0;  ///< of the motion, all
  double part = 0.0;

  /// A third or more: the rest does not show that nothing is missing.
  bool is_large() const { return part >= 1.0 / 3.0; }
};

/// With a single clip, pieces or quarters are held out in place of clips.
struct PiecesHeldOut {};
struct QuartersHeldOut {};

/// Errors of successive positions are correlated.
struct LastingErrors {
  double next = 0.0, fourth = 0.0;  ///< correlation from one frame to the next, and to the fourth
};

// Statements.

/// Two statements of one set-up's inclination contradict each other.
struct StatementsDisagree {
  std::string group;
  Against one = Against::stated, other = Against::stated;
  double z = 0.0;  ///< standard deviations apart
};

/// Set-ups without a plumb line or an inclination with its uncertainty.
struct NoInclination {
  std::vector<std::string> groups;
};

/// Tracks of several folders: their positions count from one origin.
struct OneOrigin {
  bool left_out = false;  ///< nobody states one for files by themselves: causes at a place are not considered
};

/// Nobody states a mass: 1 kg is assumed.
struct NoMassStated {};

/// Only falls were recorded: friction on a track is not determined.
struct OnlyFalls {};

/// A fall is faster than any viscous drag allows, and its drag is quadratic: K is held at 0, and the gap is that of a
/// fall without any drag.
struct FallsThroughAir {
  /// Log evidence by which the positions alone prefer the quadratic drag to a viscous one; none if it was not measured.
  std::optional<double> over_viscous = {};
  /// Gaps of held-out clips with a viscous drag alone, and with what the verdict names; none if that leaves no gap.
  struct Gaps {
    double viscous = 1.0, named = 1.0;
  };
  std::optional<Gaps> gaps = {};

  /// Whether a viscous drag would leave clearly less. Air cannot brake like that, so something else is wrong as well.
  bool viscous_leaves_less() const;
};

/// A fall with a wrong scale or a wrong frame rate, which slow it, or with an inertia without weight: a buoyancy would
/// do the same.
struct BuoyancyLooksAlike {
  double density_ratio = 0.0;  ///< of the fluid to the body
  bool as_inertia = false;
};

/// Explanations whose fits reached the most steps that a fit may take before they reached a minimum.
struct FitsCutOff {
  std::vector<Explanation> of;
};

/// Clips of one set-up state different inclinations.
struct SplitSetUps {
  std::vector<std::string> groups;
};

/// A clip begins in the opposite direction to its stated launch.
struct OppositeLaunch {
  std::string clip;
  bool stated_up = false;
};

/// A fit with a drag or a friction below zero, which would drive the glider.
struct NegativeLoss {
  enum class Of { drag, friction } of = Of::drag;
  double value = 0.0, sd = 0.0;  ///< N s/m of drag
};

/// The likeliest explanation is impossible: with it, a drag or a friction is below zero, or a size of one of its
/// effects stands at an end of the range that is searched.
struct ImpossibleSizes {
  std::vector<std::string> effects;  ///< of the explanation, ids
  std::vector<NegativeLoss> negative;
  std::vector<std::string> at_end;  ///< of `effects`, those with such a size
};

/// A unit of lengths or times, or a scale, that the positions of a clip make doubtful (core/check/motion_look.h).
struct DoubtfulUnit {
  std::string clip;
  core::Found found;         ///< LongRun, SlowFrames, FallAboveGravity or FallsSlowly
  bool weight_open = false;  ///< what drives the falls, part of their weight, is fitted
};

/// A stated inclination that the motion contradicts.
struct ContradictedIncline {
  std::string group;
  Against against = Against::stated;  ///< where the statement comes from
  double stated_rad = 0.0, stated_sd_rad = 0.0;
  double motion_rad = 0.0, motion_sd_rad = 0.0;
  bool named = false;  ///< by the model with the named effects, not by the nominal model
  double z = 0.0;
};

/// A stated inclination without its uncertainty, which constrains no fit, and which the accelerations contradict
/// grossly.
struct ContradictedReading {
  double mass_kg = 0.0;
  core::InclineContradiction contradiction;
};

/// No inclination is stated, and the body speeds up like one that falls in positions that were taken for those in a
/// hand.
struct SuspectedFall {
  core::MayBeAFall found;
};

/// What a reader must know of how a clip was read (core::is_of_reading()).
struct OfReading {
  std::string clip;
  core::Note note;
};

// Tables of lines.

/// Lines whose mean intercept is larger than gravity.
struct BeyondGravity {
  double stated_deg = 0.0, intercept_m_s2 = 0.0, gravity_m_s2 = 0.0;
};

/// Named effects that only a camera has, of positions that came without images: a motion sensor has none of them.
struct OfCamera {
  std::vector<std::string> ids;
};

/// A motion sensor measured all positions, so that what only a camera has is left out.
struct SensorPositions {
  std::string column;  ///< the header that shows it; empty: it is stated
};

/// The inclination that corresponds to the mean intercept of lines.
struct MeanIncline {
  double stated_deg = 0.0, intercept_deg = 0.0;
  double read_deg = 0.0;  ///< how well the stated one is assumed to have been read
};

/// A table states neither errors nor speeds.
struct TableOfLines {
  std::size_t lines = 0;
};

/// With the recorded force reversed, the nominal model follows the positions far better.
struct ForceReversed {
  double part_of_chi2 = 0.0;  ///< that is then left
};

using AnyNote =
    std::variant<NoFreeMotion, ThinnedPositions, CutAtTurns, SomePieces, HandLeftOut, HandExplained, SetAside,
                 PiecesHeldOut, QuartersHeldOut, LastingErrors, StatementsDisagree, NoInclination, SplitSetUps,
                 OppositeLaunch, NegativeLoss, ContradictedIncline, ContradictedReading, BeyondGravity, MeanIncline,
                 TableOfLines, OnlyFalls, FallsThroughAir, BuoyancyLooksAlike, FitsCutOff, NoMassStated, OfCamera,
                 SensorPositions, OneOrigin, SuspectedFall, OfReading, DoubtfulUnit, ImpossibleSizes, ForceReversed>;

/// One note. The code that copies, moves and destroys it is compiled once (note.cpp), as for core::Note, which says
/// why the two share no template.
struct Note : AnyNote {
  using AnyNote::AnyNote;
  Note(const Note&);
  Note(Note&&) noexcept;
  Note& operator=(const Note&);
  Note& operator=(Note&&) noexcept;
  ~Note();
};

}  // namespace glidelab::diagnose
