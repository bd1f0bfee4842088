#include "diagnose/effects/effect.h"

#include <cmath>
#include <stdexcept>

namespace glidelab::diagnose {

// The largest sizes are what a person would notice at once (half of the drag, a tenth of the length) on a track of
// metres with a glider of some hundred grams.
const std::vector<EffectInfo>& effect_list() {
  using E = EffectValues;
  static const std::vector<EffectInfo> list = {
      {"quadratic_drag",
       "dynamics",
       Search::amplitude,
       false,
       {{"c_kg_m", &E::c_kg_m, false, 0.0, 1.0, 1e-6, true}},
       "a drag that grows with the square of the speed, such as air's"},
      {"eddy_rolloff",
       "dynamics",
       Search::amplitude,
       false,
       {{"v_c_m_s", &E::rolloff_s2_m2, false, 0.0, 100.0, 1e-6}},
       "a magnetic drag that grows less than in proportion to the speed"},
      {"power_law_drag",
       "dynamics",
       Search::amplitude,
       true,
       {{"n", &E::power, false, -0.9, 2.0, 1e-6}},
       "a drag that goes with another power of the speed"},
      {"stribeck",
       "dynamics",
       Search::shape,
       false,
       {{"s", &E::stribeck, false, 0.0, 50.0, 1e-5}, {"v_s_m_s", &E::stribeck_m_s, false, 0.003, 1.0, 1e-5}},
       "a dry friction that is larger at low speeds"},
      {"load_independent_friction",
       "dynamics",
       Search::amplitude,
       false,
       {{"force_n", &E::force_n, false, 0.0, 1.0, 1e-7, true}},
       "a dry friction that does not depend on the load"},
      {"direction_asymmetry",
       "dynamics",
       Search::amplitude,
       true,
       {{"d", &E::asymmetry, false, -1.0, 1.0, 1e-5}},
       "a dry friction that is larger one way than the other"},
      {"track_bow",
       "dynamics",
       Search::amplitude,
       true,
       {{"slope_1_m", &E::bow_1_m, false, -0.3, 0.3, 1e-7}},
       "a track that is not straight but bowed"},
      {"damping_gradient",
       "dynamics",
       Search::shape,
       true,
       {{"b_1_m", &E::gradient_1_m, false, -3.0, 3.0, 1e-6}, {"", &E::gradient_about, false, -5.0, 5.0, 1e-4}},
       "a drag that changes along the track"},
      {"rotational_inertia",
       "dynamics",
       Search::amplitude,
       false,
       {{"mass_kg", &E::wheels_kg, false, 0.0, 0.5, 1e-7, true}},
       "inertia that is not in the weighed mass, such as wheels'"},
      {"tether",
       "dynamics",
       Search::shape,
       false,
       {{"k_n_m", &E::tether_n_m, false, 0.0, 200.0, 1e-5, true}, {"x_t_m", &E::tether_x_m, false, -1e3, 1e3, 1e-4}},
       "a cable or spring that pulls back beyond some place"},
      {"base_vibration",
       "dynamics",
       Search::wave,
       false,
       {{"a_m_s2", &E::shake_m_s2, false, 0.0, 20.0, 1e-5},
        {"f_hz", &E::shake_hz, false, 0.2, 1e4, 1e-5},
        {"phase", &E::shake_phase, true, -1e3, 1e3, 1e-5}},
       "a table or track that shakes"},
      {"late_release",
       "dynamics",
       Search::pushes,
       true,
       {{"t_r_s", &E::release_s, false, 1e-3, 3.0, 1e-4}, {"push", &E::push_m_s2, true, -50.0, 50.0, 1e-5}},
       "a hand that still pushes at the start of the clips"},
      {"frame_rate_error",
       "timing",
       Search::amplitude,
       true,
       {{"e", &E::rate_error, false, -0.3, 0.3, 1e-7}},
       "a frame rate that is not the stated one"},
      {"dropped_frames", "timing", Search::frames, false, {}, "frames that are missing"},
      {"timestamp_jitter", "timing", Search::noise, false, {}, "frames that are not taken at even times"},
      {"scale_error",
       "optics",
       Search::amplitude,
       true,
       {{"e", &E::scale_error, false, -0.3, 0.3, 1e-7}},
       "a length scale that is off"},
      {"perspective_error",
       "optics",
       Search::amplitude,
       true,
       {{"p_1_m", &E::perspective_1_m, false, -0.5, 0.5, 1e-7}},
       "a calibration pattern that was not in the plane of motion"},
      {"lens_distortion",
       "optics",
       Search::shape,
       true,
       {{"k_1_m2", &E::lens_1_m2, false, -0.5, 0.5, 1e-7}, {"x_c_m", &E::lens_x_m, false, -1e3, 1e3, 1e-5}},
       "a lens whose distortion is not corrected"},
      {"camera_motion",
       "optics",
       Search::wave,
       false,
       {{"amplitude_m", &E::camera_m, false, 0.0, 0.05, 1e-8},
        {"f_hz", &E::camera_hz, false, 0.2, 1e4, 1e-5},
        {"", &E::camera_slope_1_m, false, -2.0, 2.0, 1e-4},
        {"", &E::camera_bend_1_m2, false, -2.0, 2.0, 1e-4},
        {"phase", &E::camera_phase, true, -1e3, 1e3, 1e-5}},
       "a camera that sways or shakes"},
      {"rolling_shutter",
       "timing",
       Search::rows,
       true,
       {{"line_s", &E::line_s, false, -3e-4, 3e-4, 1e-7}},
       "rows that are exposed one after the other, other than stated"},
      {"exposure_blur", "sensor", Search::pictures, false, {}, "an exposure that is longer than stated"},
      {"light_flicker", "optics", Search::pictures, false, {}, "light that flickers"},
      {"light_gradient", "optics", Search::pictures, false, {}, "light that is much brighter on one side"},
      {"compression", "sensor", Search::pictures, false, {}, "a codec that loses detail"},
      {"heavy_tailed_noise", "tracking", Search::noise, false, {}, "single positions that lie far off"},
  };
  return list;
}

std::vector<std::string> effect_words() {
  std::vector<std::string> words;
  for (const EffectInfo& effect : effect_list()) words.emplace_back(effect.id);
  words.emplace_back("smoothing_bias");
  return words;
}

std::size_t effect_index(std::string_view id) {
  const auto& list = effect_list();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].id == id) return i;
  }
  throw std::out_of_range("no such effect: " + std::string(id));
}

std::size_t first_alike(std::size_t effect, bool filmed) {
  const std::string_view id = effect_list()[effect].id;
  if (id == "scale_error") return effect_index("frame_rate_error");
  if (id == "camera_motion" && !filmed) return effect_index("base_vibration");
  return effect;
}

ShownValue shown(const EffectParameter& parameter, double member) {
  if (parameter.member == &EffectValues::rolloff_s2_m2) {
    return {1.0 / std::sqrt(member), -0.5 / (member * std::sqrt(member))};
  }
  if (parameter.member == &EffectValues::power || parameter.member == &EffectValues::stribeck)
    return {1.0 + member, 1.0};
  return {member, 1.0};
}

}  // namespace glidelab::diagnose
