/// sweep.toml beside a small scenario and a camera. A sweep whose scenario cannot be solved is refused by
/// NumericalError.
#include "validate/study/sweep/design/read_sweep.h"

#include "tests/fuzz/fuzz_target.h"
#include "tests/one_glider.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string scenario = "format = 1\nname = \"swept\"\n[camera]\nposition_m = [0.0, 0.1, 2.4]\n" +
                                      tests::one_glider(4.0, 2.7, 0.0, {{"up", 0.2, -1.0, 0.1}});
  static const fuzz::InputFolder folder({}, {{"scenario.toml", scenario}, {"cameras/one.toml", "name = \"one\"\n"}});
  const auto file = folder.with("sweep.toml", data, size);
  return fuzz::read_or_refuse<base::NumericalError>([&] { validate::read_sweep(file); });
}
