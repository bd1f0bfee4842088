/// The table of numbers that Glidelab writes itself, with a wanted, an optional and other columns.
#include "base/text/csv.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.with("table.csv", data, size);
  fuzz::read_or_refuse([&] { base::read_csv(file, {"t_s"}, {"x_m"}, true); });
  return fuzz::read_or_refuse([&] { base::read_csv(file, {"t_s", "x_m"}, {"force_n"}); });
}
