/// The sections of a scenario beside its motions: [camera], [sensor], … One entry of the table says everything that the
/// program knows of a section as a whole: how it is read, what the truth says of it, what a perfect camera makes of it.
///
/// To add one: its member in scenario_data.h, its entry in sections/*.cpp, a line in the list below, and its lines in
/// the documentation of scenarios.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "base/toml/strict_toml.h"
#include "render/scenario/scenario_data.h"

/// The names, in the order in which they are read and in which truth.json has them.
#define GLIDELAB_SCENARIO_SECTIONS(SECTION) \
  SECTION(camera)                           \
  SECTION(clock)                            \
  SECTION(codec)                            \
  SECTION(shutter)                          \
  SECTION(sensor)                           \
  SECTION(vignetting)                       \
  SECTION(focus)                            \
  SECTION(light)                            \
  SECTION(mount)                            \
  SECTION(calibration)                      \
  SECTION(marker)                           \
  SECTION(track)                            \
  SECTION(scene)                            \
  SECTION(plumb)

namespace glidelab::render {

struct ScenarioSection {
  std::string_view name;
  std::string_view help;
  /// Whether a camera's file may have the section (scenario.h).
  bool in_camera_file;
  /// Fills its part of the scenario; nothing where the file has no such section. The sections before it are read. What
  /// is wrong is recorded in the table's file.
  void (*read)(const std::optional<base::TomlTable>& table, Scenario& scenario);
  /// What depends on sections that are read later; may be null.
  void (*settle)(const base::TomlTable& root, Scenario& scenario);
  /// Adds what truth.json says of it to the JSON of the camera; null where it says nothing.
  void (*truth)(const Scenario& scenario, nlohmann::ordered_json& camera);
  /// Makes of it what `render --ideal` shows: a perfect camera before the same scene (truth_files.h).
  void (*ideal)(Scenario& scenario);
};

namespace sections {

#define GLIDELAB_DECLARE_SECTION(name) extern const ScenarioSection name;
GLIDELAB_SCENARIO_SECTIONS(GLIDELAB_DECLARE_SECTION)
#undef GLIDELAB_DECLARE_SECTION

/// For a section that ideal frames show as it is, or do not look at.
void keep(Scenario& scenario);

/// Three numbers within 1 km.
Eigen::Vector3d vector_or(const base::TomlTable& table, std::string_view key, const Eigen::Vector3d& otherwise);

}  // namespace sections

std::span<const ScenarioSection* const> scenario_sections();

/// Reads all sections of a scenario's file. What is wrong is recorded in the file.
void read_sections(const base::TomlTable& root, Scenario& scenario);

/// What truth.json says of the camera: what all sections say.
nlohmann::ordered_json sections_truth(const Scenario& scenario);

/// The scenario with a perfect camera; its motions, times, scene and pose.
Scenario ideal_of(const Scenario& scenario);

}  // namespace glidelab::render
