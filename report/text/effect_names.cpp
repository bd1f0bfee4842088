#include "report/text/effect_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report/html/html.h"

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

/// In the letters that stand beside a size; the equation of motion is m dv/dt = m g sin α − K v − sign(v) µ m g cos α.
constexpr std::array<std::pair<std::string_view, std::string_view>, 25> kMeanings = {{
    {"quadratic_drag", "a force −c v |v|"},
    {"eddy_rolloff", "K v becomes K v / (1 + (v / v_c)²)"},
    {"power_law_drag", "K v becomes K v |v|^(n − 1), v in m/s"},
    {"stribeck", "µ becomes µ (1 + (s − 1) exp(−(v / v_s)²))"},
    {"load_independent_friction", "a friction of this force, whatever the mass"},
    {"direction_asymmetry", "µ becomes µ (1 + d sign(v))"},
    {"track_bow", "sin α becomes sin α + slope (x − x_mid), x_mid the middle of the data"},
    {"damping_gradient", "K becomes K (1 + b (x − x_mid)), x_mid the middle of the data"},
    {"rotational_inertia", "m dv/dt becomes (m + mass) dv/dt"},
    {"tether", "a force −k (x − x_t) beyond x_t"},
    {"base_vibration", "an acceleration of amplitude a and frequency f"},
    {"late_release", "the hand pushes until t_r"},
    {"frame_rate_error", "the time from frame to frame is (1 + e) times what is stated"},
    {"dropped_frames", "this fraction of the frames is missing"},
    {"timestamp_jitter", "sd: of a frame's time"},
    {"scale_error", "x becomes (1 + e) x"},
    {"perspective_error", "x becomes x / (1 + p x)"},
    {"lens_distortion", "x becomes x (1 + k (x − x_c)²)"},
    {"rolling_shutter", "line: from the exposure of a row to the next one's"},
    {"exposure_blur", "exposure: as the marker's image is smeared"},
    {"camera_motion", "what rests in the scene moves by this amplitude, with frequency f"},
    {"light_flicker", "brightness changes by this depth, with frequency f"},
    {"light_gradient", "how much brighter it is on one side of the marker"},
    {"heavy_tailed_noise", "this fraction of the positions is outliers"},
    {"smoothing_bias", "intercepts are off by this for each 1/s² of (K/m)²"},
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

std::string effect_meaning(std::string_view id) {
  const auto found =
      std::find_if(kMeanings.begin(), kMeanings.end(), [&](const auto& entry) { return entry.first == id; });
  return found == kMeanings.end() ? std::string() : std::string(found->second);
}

std::string effect_html(std::string_view ids) {
  const std::string name = effect_name(ids);
  if (name == ids) return escape(ids);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(ids));
}

}  // namespace glidelab::report
