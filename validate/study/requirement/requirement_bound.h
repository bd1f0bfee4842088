/// What the Cramér-Rao bound says of one point of a requirement (requirement.h), and what limits it.
#pragma once

#include <optional>
#include <vector>

#include "render/scenario/scenario.h"
#include "validate/study/requirement/candidate.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {

/// All that the bound of one point rests on.
struct Setting {
  render::Scenario scenario;
  std::optional<double> given_noise_m = {};  ///< of tracks; else as the camera lets one expect
  bool lens_known = false;                   ///< rendered clips are restituted with the true camera
};

/// Of a position, clip by clip.
std::vector<double> noise_of(const Setting& setting, const Truth& truth);

/// The worst configuration's bound in each target's measure (infinite where the noise is).
std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets);

/// Bound over target, of the hardest target; infinite where the motion does not determine it.
double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets);

/// How many times smaller `need` were without one limitation, the largest gain first.
std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets);

}  // namespace glidelab::validate
