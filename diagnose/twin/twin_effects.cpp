#include "diagnose/twin/twin_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/pictures/picture_evidence.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kUsualExposure_s = 0.001;
constexpr double kJitterReach = 2.0 * 5.9;  // standard deviations that a scenario keeps free between two exposures
constexpr double kMostFocalChange = 0.2;    // that a scenario allows,
constexpr double kMostPan_rad = 30.0 / kDegrees;
constexpr double kMostGradient_1_m = 2.0;
constexpr double kMostPpm = 1e5;
constexpr double kMostDropped = 0.9;

const DiagnosedEffect* named(const std::vector<DiagnosedEffect>& effects, std::string_view id) {
  const auto found = std::find_if(effects.begin(), effects.end(), [&](const auto& effect) { return effect.id == id; });
  return found == effects.end() ? nullptr : &*found;
}

std::optional<double> size_of(const DiagnosedEffect* effect, std::string_view key) {
  if (effect == nullptr) return {};
  for (const DiagnosedParameter& parameter : effect->parameters) {
    if (parameter.key == key) return parameter.value;
  }
  return {};
}

class Writer {
 public:
  Writer(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming, const TwinView& view,
         double frame_rate_hz, double reference_m)
      : effects_(effects), filming_(filming), view_(view), frame_s_(1.0 / frame_rate_hz), reference_m_(reference_m) {}

  TwinEffects write() {
    exposure();
    clock();
    shutter();
    light();
    mount();
    codec();
    return std::move(twin_);
  }

 private:
  const DiagnosedEffect* effect(std::string_view id) const { return named(effects_, id); }
  void lack(std::string_view id, std::string why) { twin_.lacks.push_back({std::string(id), std::move(why)}); }
  void section(const std::string& name, const std::string& keys) {
    if (!keys.empty()) twin_.sections += "\n" + name + "\n" + keys;
  }

  void exposure() {
    // Of an unknown one, half of the frame time at most leaves the clock room.
    twin_.exposure_s = filming_ && filming_->settings.exposure_s ? *filming_->settings.exposure_s
                                                                 : std::min(kUsualExposure_s, 0.5 * frame_s_);
    const auto found = size_of(effect("exposure_blur"), "exposure_s");
    if (!found) return;
    if (*found > frame_s_) return lack("exposure_blur", "an exposure ends before the next one begins");
    twin_.exposure_s = *found;
  }

  void clock() {
    std::string keys;
    double frame_s = frame_s_;
    if (const auto e = size_of(effect("frame_rate_error"), "e")) {
      // The true step is (1 + e) times the stated one: the camera runs slower than stated.
      const double ppm = 1e6 * (1.0 / (1.0 + *e) - 1.0);
      const double step_s = frame_s_ * (1.0 + *e);
      if (std::abs(ppm) > kMostPpm || step_s < twin_.exposure_s) {
        lack("frame_rate_error", "a clock is off by a tenth at most, and exposures do not overlap");
      } else {
        keys += fmt::format("rate_error_ppm = {:.9g}\n", ppm);
        frame_s = step_s;
      }
    }
    if (const auto fraction = size_of(effect("dropped_frames"), "fraction")) {
      if (*fraction > kMostDropped) {
        lack("dropped_frames", "nine frames in ten are lost at most");
      } else {
        keys += fmt::format("dropped_fraction = {:.6g}\n", *fraction);
      }
    }
    if (const auto sd_s = size_of(effect("timestamp_jitter"), "sd_s")) {
      const double room_s = frame_s - kJitterReach * *sd_s;
      if (!(filming_ && filming_->settings.exposure_s) && room_s > 0.0) {
        twin_.exposure_s = std::min(twin_.exposure_s, 0.999 * room_s);
      }
      if (twin_.exposure_s > room_s) {
        lack("timestamp_jitter", "exposures do not overlap, with 5.9 standard deviations of each");
      } else {
        keys += fmt::format("jitter_s = {:.6g}\n", *sd_s);
      }
    }
    section("[clock]", keys);
  }

  void shutter() {
    double line_s = filming_ ? stated_line_s(filming_->settings) : 0.0;
    if (const auto found = size_of(effect("rolling_shutter"), "line_s")) {
      if (!filming_ || std::abs(*found) * filming_->height_px > frame_s_) {
        lack("rolling_shutter", "all rows are read within the frame time");
      } else {
        line_s = *found;
        twin_.notes.emplace_back(
            "render states the shutter in experiment.toml, where the data's folder states another");
      }
    }
    if (line_s == 0.0) return;
    twin_.readout_s = std::abs(line_s) * filming_->height_px;
    section("[shutter]", fmt::format("kind = \"rolling\"\nline_readout_s = {:.9g}\nfirst_row = \"{}\"\n",
                                     std::abs(line_s), line_s < 0.0 ? "bottom" : "top"));
  }

  void light() {
    std::string keys;
    const DiagnosedEffect* flicker = effect("light_flicker");
    const auto depth = size_of(flicker, "depth"), f_hz = size_of(flicker, "f_hz");
    if (depth && f_hz) {
      if (*depth > 1.0) {
        lack("light_flicker", "light flickers by its own brightness at most");
      } else {
        keys += fmt::format("flicker_depth = {:.6g}\nflicker_hz = {:.9g}\n", *depth, *f_hz);
      }
    }
    if (const auto gradient = size_of(effect("light_gradient"), "gradient")) {
      if (std::abs(*gradient) > kMostGradient_1_m) {
        lack("light_gradient", "light changes by a factor of exp(2) a metre at most");
      } else {
        keys += fmt::format("gradient_per_m = [{:.6g}, 0.0]\n", *gradient);
      }
    }
    section("[light]", keys);
  }

  void mount() {
    double focal = 1.0;
    std::string motions;
    if (const auto e = size_of(effect("scale_error"), "e")) {
      focal *= 1.0 + *e;
      twin_.notes.emplace_back(
          "the wrong scale is a focal length that was changed after the calibration: it shows in pictures only");
    }
    if (const auto p = size_of(effect("perspective_error"), "p_1_m")) {
      const double before_m = 1.0 + *p * (reference_m_ + view_.downhill * view_.position_m.x());
      const double tangent = view_.downhill * *p / before_m * view_.position_m.z();
      if (!(before_m > 0.0) || std::abs(std::atan(tangent)) > kMostPan_rad) {
        lack("perspective_error", "a camera is turned by 30 degrees at most");
      } else {
        focal /= before_m * before_m * (1.0 + tangent * tangent);
        motions +=
            fmt::format("\n[[mount.motion]]\naxis = \"pan\"\noffset_deg = {:.9g}\n", std::atan(tangent) * kDegrees);
        twin_.notes.emplace_back(
            "the perspective is a camera that was turned after the calibration: it shows in pictures only");
      }
    }
    if (const DiagnosedEffect* motion = effect("camera_motion")) motions += sway(*motion);
    if (std::abs(focal - 1.0) > kMostFocalChange) {
      lack(effect("scale_error") != nullptr ? "scale_error" : "perspective_error",
           "a focal length is off by a fifth at most");
      focal = 1.0;
    }
    section("[mount]", focal == 1.0 ? "" : fmt::format("focal_change = {:.12g}\n", focal - 1.0));
    twin_.sections += motions;
  }

  std::string sway(const DiagnosedEffect& motion) {
    const auto f_hz = size_of(&motion, "f_hz"), along_m = size_of(&motion, "amplitude_m"),
               in_px = size_of(&motion, "amplitude_px");
    if (!f_hz || !(along_m || in_px)) {
      lack("camera_motion", "which way the camera drifts is not measured");
      return "";
    }
    const double pan = along_m ? std::atan(*along_m / view_.distance_m()) : std::atan(*in_px / view_.focal_px[0]);
    if (std::abs(pan) > kMostPan_rad) {
      lack("camera_motion", "a camera is turned by 30 degrees at most");
      return "";
    }
    twin_.notes.emplace_back("the camera's motion is a pan, with one phase for all clips: it shows in pictures only");
    return fmt::format("\n[[mount.motion]]\naxis = \"pan\"\namplitude_deg = {:.9g}\nfrequency_hz = {:.9g}\n",
                       pan * kDegrees, *f_hz);
  }

  void codec() {
    const bool deep = filming_ && filming_->settings.bit_depth > 8;
    if (deep) section("[sensor]", fmt::format("bit_depth = {}\n", filming_->settings.bit_depth));
    const bool named = effect("compression") != nullptr;
    if (!named && !(filming_ && filming_->lossy.value_or(false))) return;
    if (deep) return lack("compression", "what has more than 8 bits is kept without loss");
    const bool motion_jpeg = !filming_ || filming_->codec == "MJPG";
    const bool even = filming_ && filming_->width_px % 2 == 0 && filming_->height_px % 2 == 0;
    // Of 8 x 8 blocks in a file that does not say which codec made them, each picture by itself is the simplest.
    const bool lossy = filming_ && filming_->lossy.value_or(false);
    const bool h264 = lossy && !motion_jpeg && even;
    section("[codec]", h264 ? "name = \"h264\"\n" : "name = \"mjpeg\"\n");
    twin_.notes.emplace_back("how strongly the codec compresses is not known: as a scenario has it by itself");
  }

  const std::vector<DiagnosedEffect>& effects_;
  const std::optional<Filming>& filming_;
  const TwinView& view_;
  double frame_s_;
  double reference_m_;
  TwinEffects twin_;
};

}  // namespace

TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m) {
  TwinEffects twin = Writer(effects, filming, view, frame_rate_hz, reference_m).write();
  if (named(effects, "lens_distortion") != nullptr) {
    twin.lacks.push_back({"lens_distortion", "a scenario's clips are seen through the lens that it calibrates"});
  }
  if (named(effects, "heavy_tailed_noise") != nullptr) {
    twin.lacks.push_back({"heavy_tailed_noise", "a scenario has no outliers of its own"});
  }
  return twin;
}

}  // namespace glidelab::diagnose
