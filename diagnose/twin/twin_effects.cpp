#include "diagnose/twin/twin_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/effects/effect_library.h"
#include "diagnose/pictures/picture_evidence.h"

namespace glidelab::diagnose {
namespace {

constexpr double kAssumedExposure_s = 0.001;
constexpr double kMostFocalChange = 0.2;  // that a scenario allows

TwinCamera as_filmed(const std::optional<Filming>& filming, const TwinView& view, double frame_s, double reference_m) {
  TwinCamera camera;
  camera.filmed = filming.has_value();
  camera.exposure_known = filming && filming->settings.exposure_s;
  camera.stated_frame_s = camera.frame_s = frame_s;
  camera.height_px = filming ? filming->height_px : 0;
  camera.downhill = view.downhill;
  camera.x_m = view.position_m.x();
  camera.z_m = view.position_m.z();
  camera.distance_m = view.distance_m();
  camera.focal_px = view.focal_px[0];
  camera.reference_m = reference_m;
  // Of an unknown exposure, half of the frame time at most leaves the clock room.
  camera.exposure_s =
      camera.exposure_known ? *filming->settings.exposure_s : std::min(kAssumedExposure_s, 0.5 * frame_s);
  camera.line_s = filming ? stated_line_s(filming->settings) : 0.0;
  return camera;
}

std::string section(const std::string& name, const std::string& keys) {
  return keys.empty() ? "" : "\n" + name + "\n" + keys;
}

std::string shutter_section(const TwinCamera& camera) {
  if (camera.line_s == 0.0) return "";
  return section("[shutter]", fmt::format("kind = \"rolling\"\nline_readout_s = {:.9g}\nfirst_row = \"{}\"\n",
                                          std::abs(camera.line_s), camera.line_s < 0.0 ? "bottom" : "top"));
}

std::string mount_sections(TwinCamera& camera) {
  if (std::abs(camera.focal_factor - 1.0) > kMostFocalChange) {
    camera.lack(camera.focal_by, "a focal length is off by a fifth at most");
    camera.focal_factor = 1.0;
  }
  const double change = camera.focal_factor - 1.0;
  return section("[mount]", change == 0.0 ? "" : fmt::format("focal_change = {:.12g}\n", change)) + camera.motions;
}

std::string codec_sections(const std::optional<Filming>& filming, TwinCamera& camera) {
  const bool deep = filming && filming->settings.bit_depth > 8;
  const std::string depth =
      section("[sensor]", deep ? fmt::format("bit_depth = {}\n", filming->settings.bit_depth) : "");
  const bool stated_lossy = filming && filming->lossy.value_or(false);
  if (!camera.lossy && !stated_lossy) return depth;
  if (deep) {
    camera.lack(ids::compression, "what has more than 8 bits is kept without loss");
    return depth;
  }
  const bool motion_jpeg = !filming || filming->codec == "MJPG";
  const bool even = filming && filming->width_px % 2 == 0 && filming->height_px % 2 == 0;
  // Of 8 x 8 blocks in a file that does not say which codec made them, each image by itself is the simplest.
  const bool h264 = stated_lossy && !motion_jpeg && even;
  camera.notes.emplace_back("how strongly the codec compresses is not known: the scenario's default is used");
  return depth + section("[codec]", h264 ? "name = \"h264\"\n" : "name = \"mjpeg\"\n");
}

TwinSizes sizes_of(const DiagnosedEffect& effect) {
  std::vector<std::pair<std::string, double>> sizes;
  for (const DiagnosedParameter& parameter : effect.parameters) sizes.emplace_back(parameter.key, parameter.value);
  return TwinSizes(std::move(sizes));
}

/// All named effects of one part of the camera, in the order of the list.
void apply(TwinPart part, const std::vector<DiagnosedEffect>& effects, TwinCamera& camera) {
  for (const EffectInfo& info : effect_list()) {
    if (info.twin.camera == nullptr || info.twin.part != part) continue;
    const auto named = std::find_if(effects.begin(), effects.end(), [&](const auto& e) { return e.id == info.id; });
    if (named != effects.end()) info.twin.camera(sizes_of(*named), camera);
  }
}

}  // namespace

TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m) {
  TwinCamera camera = as_filmed(filming, view, 1.0 / frame_rate_hz, reference_m);
  for (const TwinPart part :
       {TwinPart::exposure, TwinPart::clock, TwinPart::shutter, TwinPart::light, TwinPart::mount, TwinPart::codec}) {
    apply(part, effects, camera);
  }
  TwinEffects twin;
  twin.exposure_s = camera.exposure_s;
  if (camera.line_s != 0.0) twin.readout_s = std::abs(camera.line_s) * camera.height_px;
  twin.sections = section("[clock]", camera.clock) + shutter_section(camera) + section("[light]", camera.light);
  twin.sections += mount_sections(camera);
  twin.sections += codec_sections(filming, camera);
  twin.notes = camera.notes;
  for (const MissingInTwin& lack : camera.lacks) twin.lacks.push_back({std::string(lack.id), lack.why});
  for (const DiagnosedEffect& effect : effects) {
    const EffectInfo& info = effect_of(effect.id);
    if (info.stage != Stage::dynamics && !info.twin.why_not.empty())
      twin.lacks.push_back({effect.id, std::string(info.twin.why_not)});
  }
  return twin;
}

}  // namespace glidelab::diagnose
