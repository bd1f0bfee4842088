#include "report/characterize/camera_json.h"

#include <fmt/format.h>

#include "base/text/number_text.h"
#include "report/text/json_numbers.h"
#include "report/text/text_table.h"

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

void put_measured(Json& object, const std::string& key, const core::Measured& measured) {
  if (!measured.value) {
    object[key] = nullptr;
    object["why"][key] = measured.why;
    if (measured.limit) put(object["limit"], key, *measured.limit);
    return;
  }
  Json inner;
  inner["value"] = *measured.value;
  put(inner, "sd", measured.sd);
  if (!measured.how.empty()) inner["how"] = measured.how;
  object[key] = std::move(inner);
}

Json curve_json(const core::CameraMeasurement& camera) {
  Json curve = Json::array();
  for (const core::TransferPoint& point : camera.curve) {
    Json object;
    object["set"] = point.set;
    put(object, "exposure_s", point.exposure_s, "not given");
    put(object, "mean_dn", point.mean_dn);
    put(object, "variance_dn2", point.variance_dn2);
    put(object, "sd_dn2", point.sd_dn2);
    put(object, "at_largest_code", point.at_largest);
    object["used"] = point.used;
    curve.push_back(std::move(object));
  }
  return curve;
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

std::string camera_json(const core::CameraMeasurement& camera) {
  Json document;
  document["format"] = 1;
  document["name"] = camera.folder.name;
  document["bit_depth"] = camera.folder.bit_depth;
  document["width_px"] = camera.width_px;
  document["height_px"] = camera.height_px;
  document["frames"] = camera.frames;
  document["mosaic"] = camera.mosaic;
  Json sensor;
  for (const CameraRow& row : camera_rows(camera)) put_measured(sensor, row.key, *row.measured);
  document["sensor"] = std::move(sensor);
  document["pixels"] = {{"hot", camera.hot_pixels}, {"dead", camera.dead_pixels}, {"outlying", camera.outlying_pixels}};
  put(document, "saturation_dn", camera.saturation_dn);
  put(document, "line_intercept_dn2", camera.intercept_dn2, "there is no line: " + camera.gain_dn_per_e.why);
  document["photon_transfer"] = curve_json(camera);
  document["notes"] = camera.notes;
  return json_text(document);
}

std::string camera_text(const core::CameraMeasurement& camera) {
  std::vector<std::vector<std::string>> rows = {{"", "value", "sd", "unit"}};
  std::string below;
  for (const CameraRow& row : camera_rows(camera)) {
    rows.push_back({row.name, row.value, row.sd, row.unit});
    if (!row.measured->value) below += fmt::format("{}: {}\n", row.name, row.measured->why);
    if (!row.measured->how.empty()) below += fmt::format("{}: {}\n", row.name, row.measured->how);
  }
  std::string text = fmt::format("{}, {} bits, {} x {} pixels, {} frames\n\n", camera.folder.name,
                                 camera.folder.bit_depth, camera.width_px, camera.height_px, camera.frames);
  text += text_table(rows, 1);
  text += fmt::format("\nOutlying pixels: {} hot, {} dead, {} in all.\n", camera.hot_pixels, camera.dead_pixels,
                      camera.outlying_pixels);
  if (!below.empty()) text += "\n" + below;
  for (const std::string& note : camera.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace glidelab::report
