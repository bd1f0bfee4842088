/// [dust]: a speck on the sensor, with an entry that says all that a scenario knows of it.
#include <nlohmann/json.hpp>

#include "render/scenario/scenario_sections.h"

namespace glidelab::render {
namespace {

void read_dust(const std::optional<base::TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  scenario.dust.x_px = table->number("x_px", base::between(0.0, 8192.0));
  scenario.dust.y_px = table->number("y_px", base::between(0.0, 8192.0));
  scenario.dust.radius_px = table->number("radius_px", base::between(0.0, 1000.0));
  scenario.dust.passes = table->number("passes", base::between(0.0, 1.0));
}

void dust_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  if (scenario.dust.passes < 1.0) camera["dust"] = {{"passes", scenario.dust.passes}};
}

void no_dust(Scenario& scenario) {
  scenario.dust = {};
}

}  // namespace

const ScenarioSection sections::dust = {.name = "dust",
                                        .help = "a speck on the sensor's cover glass",
                                        .in_camera_file = true,
                                        .read = read_dust,
                                        .settle = nullptr,
                                        .truth = dust_truth,
                                        .ideal = no_dust};

}  // namespace glidelab::render
