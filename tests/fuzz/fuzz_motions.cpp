/// The motions of a scenario without a solver: forces, configurations, clips. Quick, and so run far more often than
/// the whole scenario.
#include "base/toml/strict_toml.h"
#include "sim/motion/motion_scenario.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refuse([&] {
    const base::TomlFile file = base::TomlFile::parse(fuzz::text_of(data, size), "scenario.toml");
    sim::read_motions(file.root());
    file.finish();
  });
}
