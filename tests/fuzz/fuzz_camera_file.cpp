/// A camera of the catalogue, taken over by a scenario that states nothing of its own camera.
#include "render/scenario/scenario.h"

#include "tests/fuzz/fuzz_target.h"
#include "tests/one_glider.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const std::string scenario = "format = 1\nname = \"camera\"\ncamera_file = \"camera.toml\"\n" +
                                      tests::one_glider(4.0, 2.7, 0.0, {{"up", 0.2, -1.0, 0.1}});
  folder.with("camera.toml", data, size);
  return fuzz::read_or_refuse(
      [&] { render::read_scenario(scenario, folder.path() / "scenario.toml", render::ScenarioChecks::values); });
}
