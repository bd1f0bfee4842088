/// Reads what a scenario says of the camera's optics and timing: [camera], [vignetting], [focus], [shutter], [light],
/// [mount].
#pragma once

#include "base/toml/strict_toml.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Fills camera, vignetting, focus, recording, light and mount of the scenario. What is wrong is recorded in the
/// table's file.
void read_optics(const base::TomlTable& root, Scenario& scenario);

/// The frame time, and a billionth for what a rate's and a time's decimals round.
inline double longest_exposure_s(double frame_rate_hz) {
  return (1.0 + 1e-9) / frame_rate_hz;
}

}  // namespace glidelab::render
