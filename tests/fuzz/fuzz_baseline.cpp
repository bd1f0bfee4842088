/// The stored errors of an analysis (validate --baseline), compared with themselves once read.
#include "validate/study/baseline/baseline.h"
#include "validate/study/baseline/gate.h"

#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  const auto file = folder.with("baseline.json", data, size);
  return fuzz::read_or_refuse([&] {
    const validate::Baseline baseline = validate::read_baseline(file);
    validate::compare_baselines(baseline, baseline);
  });
}
