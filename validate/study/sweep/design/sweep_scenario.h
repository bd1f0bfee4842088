/// The scenario of one run (the sweep's scenario with the run's values), and the trial of all values before the first
/// run.
#pragma once

#include <string>
#include <vector>

#include "render/scenario/scenario.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// The only key that does not belong to the scenario: the standard deviation of a track's positions.
inline constexpr const char* kNoiseKey = "tracks.noise_m";

struct RunScenario {
  std::string text;  ///< TOML, complete except for the camera's file
  render::Scenario scenario;
  double noise_m = 0.0;
};

/// `values` has one for each axis. InputError, with the values in the file's name, if the scenario refuses them. For
/// tracks, the camera's view is not checked.
RunScenario scenario_with(const Sweep& sweep, const std::vector<base::TomlScalar>& values);

/// InputError if the scenario refuses a value of an axis, with the others at their first values; it gives the line of
/// the key or of the choice in the sweep's file. Up to 200 values of an axis are tried, including its ends.
void try_values(const Sweep& sweep);

}  // namespace glidelab::validate
