/// The sections of a scenario besides its motions: [camera], [sensor], … One entry of the table holds everything that
/// the program knows about a section as a whole: how it is read, what the truth says about it, and its form for a
/// perfect camera.
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

/// The names, in the order in which they are read and written to truth.json.
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
  /// Fills its part of the scenario; `table` is empty if the file has no such section. Earlier sections have already
  /// been read. Errors are recorded in the table's file.
  void (*read)(const std::optional<base::TomlTable>& table, Scenario& scenario);
  /// Settles what depends on sections that are read later; may be null.
  void (*settle)(const base::TomlTable& root, Scenario& scenario);
  /// Adds its entries of truth.json to the JSON of the camera; null if there are none.
  void (*truth)(const Scenario& scenario, nlohmann::ordered_json& camera);
  /// Converts it to the form shown by `render --ideal`: a perfect camera with the same scene (truth_files.h).
  void (*ideal)(Scenario& scenario);
};

namespace sections {

#define GLIDELAB_DECLARE_SECTION(name) extern const ScenarioSection name;
GLIDELAB_SCENARIO_SECTIONS(GLIDELAB_DECLARE_SECTION)
#undef GLIDELAB_DECLARE_SECTION

/// For a section that ideal frames show unchanged, or do not use.
void keep(Scenario& scenario);

/// Three numbers within 1 km.
Eigen::Vector3d vector_or(const base::TomlTable& table, std::string_view key, const Eigen::Vector3d& otherwise);

}  // namespace sections

std::span<const ScenarioSection* const> scenario_sections();

/// Reads all sections of a scenario's file. Errors are recorded in the file.
void read_sections(const base::TomlTable& root, Scenario& scenario);

/// The camera entry of truth.json: the entries of all sections.
nlohmann::ordered_json sections_truth(const Scenario& scenario);

/// The scenario with a perfect camera, but with its own motions, times, scene and pose.
Scenario ideal_of(const Scenario& scenario);

}  // namespace glidelab::render
