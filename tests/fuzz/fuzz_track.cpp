/// A track: our own `t_s,x_m`, and what Tracker, Logger Pro, Vernier, PASCO Capstone, phyphox and spreadsheets export.
/// The first byte chooses how the column is asked for.
#include "core/track/track_data.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const std::string kColumns[] = {"", "2", "x", "Run 1: Position", "Run #1: Position", "999999999999999999999"};
  if (size == 0) return 0;
  const auto file = folder.with("track.csv", data + 1, size - 1);
  return fuzz::read_or_refuse([&] { core::read_track_csv(file, -1, kColumns[*data % std::size(kColumns)]); });
}
