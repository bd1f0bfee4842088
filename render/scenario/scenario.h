/// A scenario from its TOML file (docs/reference/scenario.md), with the camera file whose values it adopts.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/toml/strict_toml.h"
#include "render/scenario/scenario_data.h"

namespace glidelab::render {

/// A camera of the catalogue (docs/reference/cameras.md): the values that a scenario adopts if it has none of its own.
struct CameraFile {
  std::string name;
  std::string price_class;
};

/// Gives `scenario` the sections of the camera file at `path` (camera, vignetting, focus, shutter, sensor, clock,
/// codec), key by key; the scenario's own keys take precedence. If the scenario chooses another codec, shutter, lens or
/// tone, or another of two equivalent keys, the keys that belong to the camera's choice are left out. Must be called
/// before the scenario's sections are read; their readers check the values.
///
/// If the file has a [source], every value of it must have its kind ("measured", "data sheet", "derived", "assumed")
/// and its origin. InputError for that, a missing file, and unknown keys outside the sections. `scenario_text` is the
/// text from which `scenario` was read.
CameraFile take_camera_file(const std::filesystem::path& path, base::TomlFile& scenario,
                            std::string_view scenario_text);

/// The scenario's text with its camera file's values written in (as take_camera_file() does it) and `camera_file` left
/// out: its meaning does not depend on its location. Unchanged without a camera file, whose path is relative to the
/// folder of `scenario_file`.
std::string with_camera_written_in(std::string_view scenario_text, const std::filesystem::path& scenario_file);

/// The name and the price class of the camera file at `path` alone.
CameraFile read_camera_name(const std::filesystem::path& path);

/// Reads a whole scenario file. InputError with all errors, including inconsistencies: an exposure longer than the
/// frame time, a lens that folds the image over, a marker that moves behind the camera or is never seen, a pattern that
/// does not fit into the image, a clip without an end (clip_motion.h).
Scenario read_scenario(const std::filesystem::path& path);

/// How much of a scenario's text is checked: everything, everything but the view of the pattern and the plumb line (for
/// clips alone), or everything but the camera's view (for callers that make no images).
enum class ScenarioChecks { all, clips, values };

/// The same of a text, as if it stood in the file `path`.
Scenario read_scenario(std::string_view text, const std::filesystem::path& path,
                       ScenarioChecks checks = ScenarioChecks::all);

}  // namespace glidelab::render
