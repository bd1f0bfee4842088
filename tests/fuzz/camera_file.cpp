/// A camera of the catalogue, taken over by a scenario that states nothing of its own camera.
#include "render/camera_file.h"
#include "render/scenario.h"
#include "target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static constexpr std::string_view kScenario = R"(format = 1
name = "camera"
camera_file = "camera.toml"
[[configuration]]
name = "m"
mass_kg = 0.3
incline_deg = 4.0
[[configuration.clip]]
name = "up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.0
duration_s = 0.1
)";
  folder.with("camera.toml", data, size);
  return fuzz::read_or_refuse(
      [&] { render::read_scenario(kScenario, folder.path() / "scenario.toml", render::ScenarioChecks::values); });
}
