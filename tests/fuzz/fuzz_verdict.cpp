/// A diagnosis.json, as a blind study reads what another process has written.
#include "validate/blind/blind_score.h"

#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.with("diagnosis.json", data, size);
  return fuzz::read_or_refuse([&] { validate::read_blind_verdict(file); });
}
