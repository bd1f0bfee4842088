/// What an experimenter could do next: one further clip that differs in one thing, or one further measurement of what
/// is stated.
///
/// A clip begins a twentieth of the range of places inside its upper or lower end and lasts as long as the longest one
/// so far (2000 frames at most), or until it leaves that range. Its noise is what positions have so far: of tracks sd²
/// (1 + c v²), c from `wider` of the motions (0 where that is empty), of films as in whitening.h; half the exposure
/// takes a quarter of what grows with the speed. SI units.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// A further clip.
struct NextClip {
  std::size_t group = 0;  ///< index in TrackSet::groups; one beyond them: a new set-up
  double mass_kg = 0.0;
  double v0_m_s = 0.0;
  double rate_hz = 0.0;
  double exposure = 1.0;  ///< of the one so far
};

/// A set-up that is new: its inclination, and how well that would be stated (0: not at all).
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

struct Change {
  enum class Kind { launch, mass, inclination, frame_rate, exposure, plumb, pattern, clock } kind = Kind::launch;
  std::string words;  ///< for a person, an order: "Record a launch uphill at 1.2 m/s with 535 g"
  std::optional<NextClip> clip;
  std::optional<NextSetUp> set_up;
  std::vector<NextStatement> statements;
};

/// Launches each way at half, once and 1.8 times the speeds so far, with the masses so far and a heavier and a lighter
/// one, on the flattest and the steepest set-up; a level track and a steeper one; twice and half the frame rate; half
/// the exposure, where filmed markers scatter the more the faster they are; a plumb view (0.05 degrees) of each of
/// these set-ups that has none; the pattern at both ends of the range of places (0.5 mm); a stop-watch (one frame in
/// ten seconds). `nominal` is the fit of the usual model to `set`.
std::vector<Change> feasible_changes(const TrackSet& set, const MotionFit& nominal);

/// "launches, masses, inclinations, …": the kinds among them, for a person.
std::string kinds_in_words(const std::vector<Change>& changes);

}  // namespace glidelab::diagnose
