/// The scenario of one run, which is the sweep's with the run's values in it, and the trial of all values before the
/// first run.
#pragma once

#include <string>
#include <vector>

#include "render/scenario/scenario.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// The one key that is not the scenario's: the standard deviation of a track's positions.
inline constexpr const char* kNoiseKey = "tracks.noise_m";

struct RunScenario {
  std::string text;  ///< TOML, complete but for the camera's file
  render::Scenario scenario;
  double noise_m = 0.0;
};

/// `values` has one for each axis. InputError, with the values in the file's name, where the scenario refuses them.
/// At the level of tracks what the camera sees is not checked.
RunScenario scenario_with(const Sweep& sweep, const std::vector<base::TomlScalar>& values);

/// InputError if the scenario refuses a value of an axis, the others at their first ones; with the line of the
/// sweep's file that the key stands on, or the choice. Up to 200 values of an axis are tried, its ends among them.
void try_values(const Sweep& sweep);

}  // namespace glidelab::validate
