/// experiment.toml, in a folder in which the files of the seeds exist.
#include "core/experiment/experiment.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder(
      {"clips/a.mkv", "tracks/a.csv", "calibration/view-00.png", "calibration/plane.png", "plumb.png", "lines.csv"});
  folder.with("experiment.toml", data, size);
  return fuzz::read_or_refuse([&] { core::read_experiment(folder.path()); });
}
