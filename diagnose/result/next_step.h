/// What to record or measure next, as data; report/diagnosis/words/diagnosis_words.h puts it into words. SI units.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "diagnose/result/explanation.h"

namespace glidelab::diagnose {

/// A further clip.
struct NextClip {
  std::size_t group = 0;  ///< index in TrackSet::groups; one beyond them: a new set-up
  double mass_kg = 0.0;
  double v0_m_s = 0.0;
  double rate_hz = 0.0;
  double exposure = 1.0;  ///< relative to the one so far
};

/// A new set-up: its inclination, and how well that would be stated (0: not at all).
struct NextSetUp {
  double alpha_rad = 0.0;
  double sd_rad = 0.0;
};

/// A further statement.
struct NextStatement {
  enum class Of { inclination, length, clock } of = Of::inclination;
  std::size_t group = 0;            ///< whose inclination
  double from_m = 0.0, to_m = 0.0;  ///< a length that is measured
  double sd = 0.0;                  ///< rad; m; relative, of the clock
};

enum class ChangeKind { launch, mass, inclination, frame_rate, exposure, plumb, pattern, clock };

/// One further clip that differs in one respect, or one further measurement of a stated quantity.
struct Change {
  ChangeKind kind = ChangeKind::launch;
  std::optional<NextClip> clip = {};
  std::optional<NextSetUp> set_up = {};
  std::vector<NextStatement> statements = {};
  bool falls = false;           ///< its clip is one more fall: nothing is launched
  std::string on = {};          ///< the set-up's name, if there are several
  int downhill = 0;             ///< sign of x downhill where its clip is recorded; 0: the track is level there
  double rate_so_far_hz = 0.0;  ///< highest frame rate of the clips so far
  bool mass_assumed = false;    ///< nobody states a mass, and 1 kg stands for it
};

/// What was compared to find the best change.
struct ChangesWeighed {
  std::size_t count = 0;
  std::vector<ChangeKind> kinds;  ///< each once
};

/// The effects that each of two explanations has and the other lacks; if `other` is empty, the question is whether
/// `one` acts at all.
struct Alternative {
  Explanation one, other;
};

/// Steps that need no numbers.
enum class Routine {
  repeat_each_kind,     ///< one launch of each kind
  repeat_launch,        ///< one launch, three times
  start_later,          ///< launches later after the camera was started
  turn_glider,          ///< the same launches with the glider turned round
  set_up_again,         ///< the same inclination, set up once more
  move_camera,          ///< along the track
  other_speeds,         ///< launches at two further speeds
  other_forces,         ///< the same places with other recorded forces
  measure_inclination,  ///< it and the motion contradict each other
  check_statements,     ///< downhill, inclinations, masses: a drag or friction is below zero
  second_mass           ///< of a table of lines of one mass
};

/// One clip by itself, three times.
struct RepeatClip {
  std::string clip;
};

/// The launch that best covers the positions or speeds at which something without a name acts.
struct CoverRegion {
  enum class Over { places, speeds } over = Over::places;
  double from = 0.0, to = 0.0;
  Change launch;
  std::size_t launches = 0, inside = 0, positions = 0;  ///< weighed; positions inside, of all, of this one
};

/// A further mass.
struct AddMass {
  double mass_kg = 0.0;
  bool assumed = false;  ///< nobody states a mass, and 1 kg stands for the one so far
};

/// What would show an effect that only images or single frames reveal.
struct RecordForEffect {
  std::string words;                 ///< the effect's own
  std::optional<Alternative> doubt;  ///< between two explanations; none if the effect is named
};

/// The change that would tell the leading explanation from its rivals; none if no change would.
struct SettleDoubt {
  std::vector<Alternative> doubt;
  std::optional<Change> by;
  ChangesWeighed weighed;
  double log_likelihood = 0.0;  ///< that the rivals are expected to lose; the largest, if no change is enough
};

/// The change that would reduce the uncertainty of the weakest parameter, if nothing is in doubt, or only whether
/// something else acts that no further clip would show; none if no change would.
struct SharpenParameter {
  std::string key, effect;  ///< for K and mu: key "K" or "mu" and no effect
  double value = 0.0, sd = 0.0;
  std::optional<Change> by;
  ChangesWeighed weighed;
  double sd_after = 0.0;
  bool one_mass = false;                    ///< nothing is missing, but there is only one mass: a friction force would
                                            ///< count as mu
  std::vector<Alternative> undecided = {};  ///< what may act as well, which none of the changes would decide
};

/// What would tell a friction force from a smoothing bias in a table of lines: a glider of this mass, and by how much
/// each would move its intercepts.
struct TellLinesApart {
  double mass_kg = 0.0;
  double force_n = 0.0, by_force_m_s2 = 0.0, by_bias_m_s2 = 0.0;
};

using NextStep = std::variant<std::monostate, Routine, RepeatClip, CoverRegion, AddMass, RecordForEffect, SettleDoubt,
                              SharpenParameter, TellLinesApart>;

}  // namespace glidelab::diagnose
