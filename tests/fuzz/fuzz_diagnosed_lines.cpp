/// A table of fitted lines, read and diagnosed: any finite numbers may stand in it.
#include "diagnose/lines/line_diagnosis.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.with("lines.csv", data, size);
  return fuzz::read_or_refuse<base::NumericalError>([&] {
    const auto lines = diagnose::read_lines(file);
    if (lines.size() <= 24) diagnose::diagnose_lines(lines, 9.80665);  // time grows with the lines; the paper has 12
  });
}
