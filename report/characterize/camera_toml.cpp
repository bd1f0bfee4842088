#include "report/characterize/camera_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/characterize/measured_words.h"

namespace glidelab::report {
namespace {

/// The text on one line of a comment.
std::string in_comment(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

/// A TOML number with enough significant digits to show three of its standard deviation; 4 without one.
std::string number(double value, double sd) {
  int digits = 4;
  if (sd > 0.0 && value != 0.0) {
    digits = std::clamp(static_cast<int>(std::floor(std::log10(std::abs(value) / sd))) + 3, 2, 9);
  }
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string line(const std::string& key, const std::string& value, const std::string& comment) {
  return fmt::format("{} = {}  # {}\n", key, value, in_comment(comment));
}

std::string entry(const std::string& key, const core::Measured& measured) {
  if (measured.value) {
    std::string comment = fmt::format("measured, sd {:.2g}", measured.sd);
    if (measured.how) comment += "; " + how_words(measured);
    return line(key, number(*measured.value, measured.sd), comment);
  }
  if (measured.limit) {
    return line(key, number(*measured.limit, 0.0), "NOT measured, this is the limit: " + why_words(measured));
  }
  return line(key, "nan", "NOT measured: " + why_words(measured));
}

std::string dark_signal(const core::Measured& measured) {
  if (!measured.value) return fmt::format("# dark_signal_e_s: not measured: {}\n", in_comment(why_words(measured)));
  if (*measured.value > 0.0) return entry("dark_signal_e_s", measured);
  return line("dark_signal_e_s", "0.0",
              fmt::format("measured as {:.2g}, sd {:.2g}: not significant", *measured.value, measured.sd));
}

std::string head(const core::CameraMeasurement& camera) {
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
  std::string text = head(camera) + "\n[sensor]\n";
  text += fmt::format("bit_depth = {}\n", camera.folder.bit_depth);
  text += entry("full_well_e", camera.full_well_e);
  text += entry("read_noise_e", camera.read_noise_e);
  text += entry("gain_dn_per_e", camera.gain_dn_per_e);
  text += entry("offset_dn", camera.offset_dn);
  text += dark_signal(camera.dark_signal_e_s);
  text += entry("prnu", camera.prnu);
  text += entry("dsnu_e", camera.dsnu_e);
  return text;
}

}  // namespace glidelab::report
