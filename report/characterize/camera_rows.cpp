#include "report/characterize/camera_rows.h"

#include "base/text/number_text.h"

namespace glidelab::report {
namespace {

CameraRow row(const char* key, const char* name, const char* unit, const core::Measured& measured, double factor = 1.0,
              const char* limit_sign = "< ") {
  CameraRow result{key, name, "–", "", unit, &measured};
  if (measured.value) {
    result.value = base::value_text(factor * *measured.value, factor * measured.sd);
    result.sd = base::sd_text(factor * measured.sd);
  } else if (measured.limit) {
    result.value = limit_sign + base::number_text(factor * *measured.limit, 3);
  }
  return result;
}

}  // namespace

std::vector<CameraRow> camera_rows(const core::CameraMeasurement& camera) {
  constexpr double kPercent = 100.0;
  return {row("gain_dn_per_e", "gain K", "DN/e⁻", camera.gain_dn_per_e),
          row("read_noise_e", "read noise", "e⁻", camera.read_noise_e),
          row("offset_dn", "offset", "DN", camera.offset_dn),
          row("full_well_e", "full well", "e⁻", camera.full_well_e, 1.0, "> "),
          row("saturation_capacity_e", "saturation capacity", "e⁻", camera.saturation_capacity_e),
          row("dark_signal_e_s", "dark signal", "e⁻/s", camera.dark_signal_e_s),
          row("prnu", "PRNU", "%", camera.prnu, kPercent),
          row("dsnu_e", "DSNU", "e⁻", camera.dsnu_e),
          row("linearity_error", "linearity error", "%", camera.linearity_error, kPercent)};
}

}  // namespace glidelab::report
