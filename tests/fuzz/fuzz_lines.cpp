/// A table of fitted lines, read only: what is made of the numbers is fuzz_diagnosed_lines.cpp.
#include "diagnose/lines/line_model.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.with("lines.csv", data, size);
  return fuzz::read_or_refuse([&] { diagnose::read_lines(file); });
}
