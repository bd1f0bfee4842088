/// The list of effects, which names each one once. Everything else about an effect is in its file ID.cpp: in force/ if
/// it acts on the glider, in camera/ if it acts on the image, in record/ if it lies in what the record states or in how
/// it is smoothed. A new effect is a line here and such a file. The order gives the indices by which the searches know
/// an effect. Effects that only a table of lines shows come last.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace glidelab::diagnose {

// clang-format off
#define GLIDELAB_EFFECTS(EFFECT)     \
  EFFECT(quadratic_drag)             \
  EFFECT(eddy_rolloff)               \
  EFFECT(power_law_drag)             \
  EFFECT(direction_dependent_drag)   \
  EFFECT(stribeck)                   \
  EFFECT(load_independent_friction)  \
  EFFECT(direction_asymmetry)        \
  EFFECT(place_friction)             \
  EFFECT(friction_drift)             \
  EFFECT(configuration_friction)     \
  EFFECT(configuration_drag)         \
  EFFECT(clip_scatter)               \
  EFFECT(track_bow)                  \
  EFFECT(damping_gradient)           \
  EFFECT(rotational_inertia)         \
  EFFECT(tether)                     \
  EFFECT(end_stop)                   \
  EFFECT(base_vibration)             \
  EFFECT(late_release)               \
  EFFECT(force_gain)                 \
  EFFECT(force_delay)                \
  EFFECT(frame_rate_error)           \
  EFFECT(dropped_frames)             \
  EFFECT(timestamp_jitter)           \
  EFFECT(scale_error)                \
  EFFECT(mass_error)                 \
  EFFECT(perspective_error)          \
  EFFECT(lens_distortion)            \
  EFFECT(camera_motion)              \
  EFFECT(rolling_shutter)            \
  EFFECT(exposure_blur)              \
  EFFECT(light_flicker)              \
  EFFECT(light_gradient)             \
  EFFECT(compression)                \
  EFFECT(heavy_tailed_noise)         \
  EFFECT(position_rounding)          \
  EFFECT(smoothing_bias)
// clang-format on

/// The id of each effect, for code that means a particular one: ids::tether is "tether".
namespace ids {
#define GLIDELAB_ID(id) inline constexpr const char* id = #id;
GLIDELAB_EFFECTS(GLIDELAB_ID)
#undef GLIDELAB_ID
}  // namespace ids

#define GLIDELAB_ID(id) std::string_view(#id),
inline constexpr std::array kEffectIds = {GLIDELAB_EFFECTS(GLIDELAB_ID)};
#undef GLIDELAB_ID
inline constexpr std::size_t kEffects = kEffectIds.size();

/// Index of an effect in the list. std::out_of_range for any other word.
constexpr std::size_t effect_index(std::string_view id) {
  for (std::size_t i = 0; i < kEffects; ++i) {
    if (kEffectIds[i] == id) return i;
  }
  throw std::out_of_range("no such effect: " + std::string(id));
}

inline constexpr std::size_t kMostParameters = 6;  ///< of one effect

/// Where the value of one parameter is stored.
struct EffectSlot {
  std::size_t effect = kEffects, parameter = 0;
  bool operator==(const EffectSlot&) const = default;
};

/// The slot of an effect's parameter; parameters count in the order of the effect's file.
constexpr EffectSlot slot_of(std::string_view id, std::size_t parameter = 0) {
  return {effect_index(id), parameter};
}

}  // namespace glidelab::diagnose
