#include "report/characterize/camera_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text/number_text.h"
#include "report/characterize/measured_words.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

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
    object["why"][key] = why_words(measured);
    if (measured.limit) put(object["limit"], key, *measured.limit);
    return;
  }
  Json inner;
  inner["value"] = *measured.value;
  put(inner, "sd", measured.sd);
  if (measured.how) inner["how"] = how_words(measured);
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
  put(document, "line_intercept_dn2", camera.intercept_dn2, "there is no line: " + why_words(camera.gain_dn_per_e));
  document["photon_transfer"] = curve_json(camera);
  document["notes"] = notes_words(camera.notes);
  return json_text(document);
}

std::string camera_text(const core::CameraMeasurement& camera) {
  std::vector<std::vector<std::string>> rows = {{"", "value", "sd", "unit"}};
  std::string below;
  for (const CameraRow& row : camera_rows(camera)) {
    rows.push_back({row.name, row.value, row.sd, row.unit});
    if (!row.measured->value) below += fmt::format("{}: {}\n", row.name, why_words(*row.measured));
    if (row.measured->how) below += fmt::format("{}: {}\n", row.name, how_words(*row.measured));
  }
  std::string text = fmt::format("{}, {} bits, {} x {} pixels, {} frames\n\n", camera.folder.name,
                                 camera.folder.bit_depth, camera.width_px, camera.height_px, camera.frames);
  text += text_table(rows, 1);
  text += fmt::format("\nOutlying pixels: {} hot, {} dead, {} in all.\n", camera.hot_pixels, camera.dead_pixels,
                      camera.outlying_pixels);
  if (!below.empty()) text += "\n" + below;
  for (const core::CameraNote& note : camera.notes) text += "note: " + note_words(note) + "\n";
  return text;
}

namespace {

/// The text on one line of a comment.
std::string in_comment(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

/// A TOML number with enough significant digits to show three of its standard deviation; 4 without one.
std::string toml_number(double value, double sd) {
  int digits = 4;
  if (sd > 0.0 && value != 0.0) {
    digits = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value) / sd))) + 3, 2, 9);
  }
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_line(const std::string& key, const std::string& value, const std::string& comment) {
  return fmt::format("{} = {}  # {}\n", key, value, in_comment(comment));
}

std::string toml_entry(const std::string& key, const core::Measured& measured) {
  if (measured.value) {
    std::string comment = fmt::format("measured, sd {:.2g}", measured.sd);
    if (measured.how) comment += "; " + how_words(measured);
    return toml_line(key, toml_number(*measured.value, measured.sd), comment);
  }
  if (measured.limit) {
    return toml_line(key, toml_number(*measured.limit, 0.0), "NOT measured, this is the limit: " + why_words(measured));
  }
  return toml_line(key, "nan", "NOT measured: " + why_words(measured));
}

std::string dark_signal(const core::Measured& measured) {
  if (!measured.value) return fmt::format("# dark_signal_e_s: not measured: {}\n", in_comment(why_words(measured)));
  if (*measured.value > 0.0) return toml_entry("dark_signal_e_s", measured);
  return toml_line("dark_signal_e_s", "0.0",
                   fmt::format("measured as {:.2g}, sd {:.2g}: not significant", *measured.value, measured.sd));
}

std::string toml_head(const core::CameraMeasurement& camera) {
  const core::FlatFieldFolder& folder = camera.folder;
  std::string text = fmt::format("# {}\n# Measured by photon transfer (EMVA 1288) on {} frames of {} x {} pixels.\n",
                                 in_comment(folder.name), camera.frames, camera.width_px, camera.height_px);
  if (folder.frame_rate_hz) text += fmt::format("# Frame rate: {:.6g} Hz\n", *folder.frame_rate_hz);
  if (folder.pixel_pitch_m) text += fmt::format("# Pixel pitch: {:.4g} um\n", *folder.pixel_pitch_m * 1e6);
  if (!folder.price_class.empty()) text += fmt::format("# Price class: {}\n", in_comment(folder.price_class));
  text += fmt::format("# Outlying pixels: {} hot, {} dead, {} in all.\n", camera.hot_pixels, camera.dead_pixels,
                      camera.outlying_pixels);
  for (const core::CameraNote& note : camera.notes) text += fmt::format("# Note: {}\n", in_comment(note_words(note)));
  text += "# No quantum efficiency: it requires a calibrated light.\n";
  return text;
}

}  // namespace

std::string camera_toml(const core::CameraMeasurement& camera) {
  std::string text = toml_head(camera) + "\n[sensor]\n";
  text += fmt::format("bit_depth = {}\n", camera.folder.bit_depth);
  text += toml_entry("full_well_e", camera.full_well_e);
  text += toml_entry("read_noise_e", camera.read_noise_e);
  text += toml_entry("gain_dn_per_e", camera.gain_dn_per_e);
  text += toml_entry("offset_dn", camera.offset_dn);
  text += dark_signal(camera.dark_signal_e_s);
  text += toml_entry("prnu", camera.prnu);
  text += toml_entry("dsnu_e", camera.dsnu_e);
  return text;
}

namespace {

/// Rows of (mean, variance, 2 sd) of the levels in the fit, or of the others.
PlotData points_of(const core::CameraMeasurement& camera, const char* name, bool used) {
  PlotData data{name, {}, {"mean above dark (DN)", "variance (DN²)", "two standard deviations (DN²)"}};
  for (const core::TransferPoint& point : camera.curve) {
    if (point.used == used) data.rows.push_back({point.mean_dn, point.variance_dn2, 2.0 * point.sd_dn2});
  }
  return never_empty(std::move(data));
}

/// The line that was fitted, from dark to saturation.
PlotData line_of(const core::CameraMeasurement& camera) {
  PlotData data{"line", {}, {"mean above dark (DN)", "variance (DN²)"}};
  if (camera.gain_dn_per_e.value && camera.intercept_dn2) {
    for (const double mean_dn : {0.0, camera.saturation_dn}) {
      data.rows.push_back({mean_dn, *camera.intercept_dn2 + *camera.gain_dn_per_e.value * mean_dn});
    }
  }
  return never_empty(std::move(data));
}

double brightest_dn(const core::CameraMeasurement& camera) {
  double most_dn = camera.saturation_dn;
  for (const core::TransferPoint& point : camera.curve) most_dn = std::max(most_dn, point.mean_dn);
  return most_dn;
}

Plot transfer_plot(const core::CameraMeasurement& camera) {
  std::string script(kFrame);
  script += fmt::format(
      "set xlabel 'mean above dark (DN)'\nset ylabel 'variance (DN²)'\nset xrange [0:*]\nset yrange [0:*]\nset xtics "
      "{4:.6g}\nset arrow from {0:.6g}, graph "
      "0 to {0:.6g}, graph 1 nohead dt 2 lc rgb '{1}'\nplot $line using 1:2 with lines lw 2 lc rgb '{2}' title 'line', "
      "$used using 1:2:3 with yerrorbars pt 7 ps 0.7 lc rgb '{3}' title 'in the fit', $others using 1:2 with points pt "
      "6 ps 0.8 lc rgb '{1}' title 'others'\n",
      0.7 * camera.saturation_dn, kGrey, color(1), color(0), tick_step(brightest_dn(camera), 6));
  const std::vector<PlotData> data = {line_of(camera), points_of(camera, "used", true),
                                      points_of(camera, "others", false)};
  return {
      Drawing{script, data},
      "Photon transfer: variance of the pixels from frame to frame, rounding subtracted, against the mean. The slope "
      "is the gain. Bars: 2 sd; dashed: 70 % of saturation",
      "Variance against mean of every level, with the fitted line"};
}

/// If the levels were made by exposures: the mean as a function of exposure.
std::vector<Plot> linearity_plot(const core::CameraMeasurement& camera) {
  PlotData data{"levels", {}, {"exposure (ms)", "mean above dark (DN)"}};
  for (const core::TransferPoint& point : camera.curve) {
    if (point.exposure_s) data.rows.push_back({*point.exposure_s * 1e3, point.image_dn});
  }
  const auto same = [&](const std::vector<double>& row) { return row[0] == data.rows.front()[0]; };
  if (data.rows.size() < 3 || std::all_of(data.rows.begin(), data.rows.end(), same)) return {};
  std::string script(kFrame);
  script += fmt::format(
      "set xlabel 'exposure (ms)'\nset ylabel 'mean above dark (DN)'\nset xrange [0:*]\nset yrange [0:*]\nunset "
      "key\nplot $levels using 1:2 with linespoints pt 7 ps 0.7 lc rgb '{}'\n",
      color(0));
  return {{Drawing{script, std::vector<PlotData>{data}},
           "Linearity: the mean of every level against its exposure, a straight line up to saturation",
           "Mean of every level against its exposure"}};
}

std::string numbers_table(const core::CameraMeasurement& camera) {
  HtmlTable table({"", "value", "sd", "unit"});
  std::string remarks;
  for (const CameraRow& row : camera_rows(camera)) {
    table.row({escape(row.name), escape(row.value), escape(row.sd), escape(row.unit)});
    const std::string remark = row.measured->value ? how_words(*row.measured) : why_words(*row.measured);
    if (!remark.empty()) remarks += fmt::format("<li>{}: {}</li>", escape(row.name), escape(remark));
  }
  return table.str() + (remarks.empty() ? "" : "<ul>" + remarks + "</ul>\n");
}

/// How finely a pixel resolves light, from the known numbers.
std::string camera_meaning(const core::CameraMeasurement& camera) {
  std::string text;
  if (camera.gain_dn_per_e.value && camera.read_noise_e.value) {
    text = fmt::format("In the dark a pixel fluctuates by {} electrons ({} codes)",
                       base::number_text(*camera.read_noise_e.value, 3),
                       base::number_text(*camera.read_noise_e.value * *camera.gain_dn_per_e.value, 3));
    if (camera.full_well_e.value) {
      const double full = *camera.full_well_e.value;
      text += fmt::format("; it is full at {} electrons, where it fluctuates by {} %", base::number_text(full, 3),
                          base::number_text(100.0 / std::sqrt(full), 2));
    }
    text += ". ";
  } else {
    text = "What these frames do not determine is “–” below, with the reason. ";
  }
  return meaning_section("<p>" + text +
                         "<code>camera.toml</code> next to this page has the numbers as a scenario's "
                         "<code>[sensor]</code>, to rehearse an "
                         "experiment with this camera.</p>\n");
}

}  // namespace

Page camera_report(const core::CameraMeasurement& camera) {
  Html body = question_heading(camera.folder.name, "How much noise does this camera have?") +
              fmt::format(
                  "<p class=\"soft\">Measured from {} frames of {} × {} pixels, {} bits, by photon "
                  "transfer (EMVA 1288).</p>\n",
                  camera.frames, camera.width_px, camera.height_px, camera.folder.bit_depth);
  body += camera_meaning(camera);
  body += "<h2>Numbers</h2>\n" + numbers_table(camera);
  body += camera.outlying_pixels == 0
              ? std::string("<p>No pixel is hot or dead.</p>\n")
              : fmt::format("<p>Outlying pixels: {} hot, {} dead, {} in all; they are excluded from the numbers.</p>\n",
                            camera.hot_pixels, camera.dead_pixels, camera.outlying_pixels);
  if (!camera.notes.empty()) {
    body += "<div class=\"note\"><ul>";
    for (const core::CameraNote& note : camera.notes) body += fmt::format("<li>{}</li>", escape(note_words(note)));
    body += "</ul></div>\n";
  }
  std::vector<Plot> plots = {transfer_plot(camera)};
  for (Plot& plot : linearity_plot(camera)) plots.push_back(std::move(plot));
  body += "<h2>Where they come from</h2>\n" + figures(plots);
  return page(camera.folder.name, body);
}

}  // namespace glidelab::report
