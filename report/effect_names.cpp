#include "report/effect_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report/html.h"

namespace glidelab::report {
namespace {

/// Up to 30 characters, so that they stand at the axes of a plot.
constexpr std::array<std::pair<std::string_view, std::string_view>, 28> kNames = {{
    {"none", "nothing is missing"},
    {"unknown", "something without a name"},
    {"quadratic_drag", "drag by the speed squared"},
    {"eddy_rolloff", "magnetic drag that levels off"},
    {"power_law_drag", "drag by a power of the speed"},
    {"stribeck", "more friction at low speed"},
    {"load_independent_friction", "friction whatever the load"},
    {"direction_asymmetry", "friction that differs by way"},
    {"track_bow", "bowed track"},
    {"damping_gradient", "drag that differs by place"},
    {"rotational_inertia", "inertia of wheels"},
    {"tether", "cable that tightens"},
    {"base_vibration", "shaking table"},
    {"late_release", "hand that lets go late"},
    {"frame_rate_error", "wrong frame rate"},
    {"dropped_frames", "lost frames"},
    {"timestamp_jitter", "uneven frame times"},
    {"scale_error", "wrong scale"},
    {"perspective_error", "pattern off the plane"},
    {"lens_distortion", "distortion of the lens"},
    {"rolling_shutter", "rolling shutter"},
    {"exposure_blur", "exposure longer than stated"},
    {"camera_motion", "moving camera"},
    {"light_flicker", "flickering light"},
    {"light_gradient", "light from one side"},
    {"compression", "lossy compression"},
    {"heavy_tailed_noise", "outliers"},
    {"smoothing_bias", "bias of the smoothing"},
}};

std::string_view name_of(std::string_view id) {
  const auto found = std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == id; });
  return found == kNames.end() ? id : found->second;
}

}  // namespace

std::string effect_name(std::string_view ids) {
  constexpr std::string_view kAnd = " + ";
  std::string text;
  for (std::size_t at = 0; at <= ids.size();) {
    const std::size_t end = std::min(ids.find(kAnd, at), ids.size());
    text += (text.empty() ? "" : std::string(kAnd)) + std::string(name_of(ids.substr(at, end - at)));
    at = end + kAnd.size();
  }
  return text;
}

std::vector<std::string> effect_names(const std::vector<std::string>& ids) {
  std::vector<std::string> names;
  for (const std::string& id : ids) names.push_back(effect_name(id));
  return names;
}

std::string effect_html(std::string_view ids) {
  const std::string name = effect_name(ids);
  if (name == ids) return escape(ids);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(ids));
}

}  // namespace glidelab::report
