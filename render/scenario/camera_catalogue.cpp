#include "render/scenario/camera_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/files/staged_output.h"
#include "base/toml/toml_set.h"
#include "render/scenario/scenario_sections.h"

namespace glidelab::render {
namespace {

using base::TomlFile;
using base::TomlTable;

/// The sections that a camera's file may have.
std::vector<std::string_view> camera_file_sections() {
  std::vector<std::string_view> names;
  for (const ScenarioSection* section : scenario_sections()) {
    if (section->in_camera_file) names.push_back(section->name);
  }
  return names;
}

/// With a key of the scenario's own, these keys of the camera make no sense.
struct Choice {
  std::string_view section;
  std::string_view key;
  std::vector<std::string> belonging;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all = {
      {"codec", "name", {"container", "quality", "crf", "bitrate_kbit_s", "gop"}},
      {"codec", "crf", {"bitrate_kbit_s"}},
      {"codec", "bitrate_kbit_s", {"crf"}},
      {"shutter", "kind", {"line_readout_s", "first_row"}},
      {"camera", "lens", {"distortion"}},
      {"sensor", "tone", {"gamma", "tone_from", "tone_to"}},
      {"sensor", "white_level", {"white_photons_s"}},
      {"sensor", "white_photons_s", {"white_level"}},
      {"clock", "variable", {"stamp_tick_s"}},
  };
  return all;
}

std::vector<std::string> left_out(const TomlTable& own, std::string_view section) {
  std::vector<std::string> keys;
  for (const Choice& choice : choices()) {
    if (choice.section != section || !own.has(choice.key)) continue;
    keys.insert(keys.end(), choice.belonging.begin(), choice.belonging.end());
  }
  return keys;
}

void check_source(const TomlTable& values, const TomlTable& sources, const std::string& key) {
  const std::vector<std::string> found = sources.texts_or_none(key);
  const std::vector<std::string> kinds = {"measured", "data sheet", "derived", "assumed"};
  const bool known = !found.empty() && std::find(kinds.begin(), kinds.end(), found.front()) != kinds.end();
  if (found.size() == 2 && known && !found[1].empty()) return;
  const TomlTable& where = sources.has(key) ? sources : values;
  where.reject(key, sources.has(key) ? "another source" : "a value without a source",
               "[kind, where from] in [source…], kind being measured, data sheet, derived or assumed");
}

void check_sources(const TomlTable& root) {
  const std::optional<TomlTable> source = root.maybe_table("source");
  if (!source) return;
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> values = root.maybe_table(section);
    if (!values) continue;
    const TomlTable sources = source->table(section);
    for (const std::string& key : values->keys()) {
      values->ignore(key);
      check_source(*values, sources, key);
    }
  }
}

}  // namespace

CameraFile read_camera_name(const std::filesystem::path& path) {
  TomlFile file = TomlFile::load(path);
  const TomlTable root = file.root();
  root.integer_or("format", 1, 1, 1);
  CameraFile camera{root.text_or("name", path.stem().string()), root.text_or("price_class", "unknown")};
  root.ignore("notes");
  for (const std::string_view section : camera_file_sections()) root.ignore(section);
  check_sources(root);
  file.finish();
  return camera;
}

CameraFile take_camera_file(const std::filesystem::path& path, TomlFile& scenario, std::string_view scenario_text) {
  const CameraFile camera = read_camera_name(path);
  // Asking marks a key as known, so what is asked here is another copy of both files.
  TomlFile values = TomlFile::load(path);
  const TomlFile own = TomlFile::parse(scenario_text, scenario.name());
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> table = own.root().maybe_table(section);
    scenario.add_missing(section, values, table ? left_out(*table, section) : std::vector<std::string>{});
  }
  return camera;
}

std::string with_camera_written_in(std::string_view scenario_text, const std::filesystem::path& scenario_file) {
  const TomlFile scenario = TomlFile::parse(scenario_text, scenario_file.string());
  const std::optional<std::string> camera = scenario.root().maybe_text("camera_file");
  if (!camera) return std::string(scenario_text);
  const std::filesystem::path path = scenario_file.parent_path() / *camera;
  read_camera_name(path);  // says what is wrong with the file
  std::vector<base::TomlSection> sections;
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> table = scenario.root().maybe_table(section);
    sections.push_back({std::string(section), table ? left_out(*table, section) : std::vector<std::string>{}});
  }
  return base::with_missing(scenario_text, scenario_file.string(), base::read_file(path), path.string(), sections,
                            "camera_file");
}

}  // namespace glidelab::render
