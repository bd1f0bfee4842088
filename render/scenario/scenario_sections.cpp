#include "render/scenario/scenario_sections.h"

#include <array>
#include <nlohmann/json.hpp>

namespace glidelab::render {

void sections::keep(Scenario&) {}

Eigen::Vector3d sections::vector_or(const base::TomlTable& table, std::string_view key,
                                    const Eigen::Vector3d& otherwise) {
  const auto values = table.maybe_numbers(key, 3, base::between(-1000.0, 1000.0));
  return values ? Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]) : otherwise;
}

std::span<const ScenarioSection* const> scenario_sections() {
#define GLIDELAB_LIST_SECTION(name) &sections::name,
  static constexpr std::array all = {GLIDELAB_SCENARIO_SECTIONS(GLIDELAB_LIST_SECTION)};
#undef GLIDELAB_LIST_SECTION
  return all;
}

void read_sections(const base::TomlTable& root, Scenario& scenario) {
  for (const ScenarioSection* section : scenario_sections()) section->read(root.maybe_table(section->name), scenario);
  for (const ScenarioSection* section : scenario_sections()) {
    if (section->settle != nullptr) section->settle(root, scenario);
  }
}

nlohmann::ordered_json sections_truth(const Scenario& scenario) {
  nlohmann::ordered_json camera;
  for (const ScenarioSection* section : scenario_sections()) {
    if (section->truth != nullptr) section->truth(scenario, camera);
  }
  return camera;
}

Scenario ideal_of(const Scenario& scenario) {
  Scenario ideal = scenario;
  for (const ScenarioSection* section : scenario_sections()) section->ideal(ideal);
  return ideal;
}

}  // namespace glidelab::render
