/// sweep.toml beside a small scenario and a camera. A sweep whose scenario cannot be solved is refused by
/// NumericalError.
#include "validate/sweep.h"

#include "target.h"

using namespace glidelab;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::string_view kScenario = R"(format = 1
name = "swept"
[camera]
position_m = [0.0, 0.1, 2.4]
[[configuration]]
name = "m"
mass_kg = 0.3
incline_deg = 4.0
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.7
[[configuration.clip]]
name = "up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.0
duration_s = 0.1
)";
  static const fuzz::InputFolder folder({}, {{"scenario.toml", kScenario}, {"cameras/one.toml", "name = \"one\"\n"}});
  const auto file = folder.with("sweep.toml", data, size);
  return fuzz::read_or_refuse<base::NumericalError>([&] { validate::read_sweep(file); });
}
