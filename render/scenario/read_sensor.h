/// The [sensor], [codec] and [clock] of a scenario.
#pragma once

#include "base/toml/strict_toml.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Fills scenario.sensor and scenario.exposure; scenario.recording is read before. What is wrong is recorded in `root`.
void read_sensor(const base::TomlTable& root, Scenario& scenario);

/// Fills scenario.codec and scenario.compression; scenario.camera and scenario.sensor are read before.
void read_codec(const base::TomlTable& root, Scenario& scenario);

/// Fills scenario.recording.clock; the rest of scenario.recording and the codec are read before.
void read_clock(const base::TomlTable& root, Scenario& scenario);

}  // namespace glidelab::render
