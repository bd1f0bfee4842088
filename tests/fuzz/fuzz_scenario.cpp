/// A scenario with all its checks, among them the motion that decides whether the marker is seen: a solver that breaks
/// down under absurd forces is an outcome.
#include "render/scenario/scenario.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder({}, {{"camera.toml", "name = \"one\"\n[sensor]\nbit_depth = 8\n"}});
  return fuzz::read_or_refuse<base::NumericalError>(
      [&] { render::read_scenario(fuzz::text_of(data, size), folder.path() / "scenario.toml"); });
}
