#include "diagnose/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace glidelab::diagnose {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kField = 1.6;  // m that the default camera sees from 2.4 m

std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
  return plain.empty() ? "clip" : plain;
}

bool expressible(std::string_view id) {
  static const std::set<std::string_view> ids = {
      "quadratic_drag",      "eddy_rolloff",     "power_law_drag", "stribeck",        "load_independent_friction",
      "direction_asymmetry", "frame_rate_error", "dropped_frames", "timestamp_jitter"};
  return ids.contains(id);
}

std::string force(const std::string& law, const std::map<std::string, double>& keys) {
  std::string text = fmt::format("[[configuration.force]]\nlaw = \"{}\"\n", law);
  for (const auto& [key, value] : keys) text += fmt::format("{} = {:.12g}\n", key, value);
  return text;
}

std::string forces_of(const TrackModel& model) {
  const EffectValues& e = model.effects;
  const double normal = model.mass_kg * model.gravity_m_s2 * std::cos(model.alpha_rad);
  std::string text;
  if (e.power != 0.0) {
    text += force("power_law", {{"k_n_s_m", model.k_n_s_m}, {"n", 1.0 + e.power}});
  } else if (e.rolloff_s2_m2 > 0.0) {
    text += force("eddy_rolloff", {{"k_n_s_m", model.k_n_s_m}, {"v_c_m_s", 1.0 / std::sqrt(e.rolloff_s2_m2)}});
  } else {
    text += force("viscous", {{"k_n_s_m", model.k_n_s_m}});
  }
  if (e.c_kg_m != 0.0) text += force("quadratic", {{"c_kg_m", e.c_kg_m}});
  if (e.stribeck != 0.0) {
    text += force("stribeck", {{"mu", model.mu}, {"s", 1.0 + e.stribeck}, {"v_s_m_s", e.stribeck_m_s}});
  } else {
    text += force("coulomb", {{"mu", model.mu}});
  }
  if (e.force_n != 0.0) text += force("coulomb", {{"mu", e.force_n / normal}});
  if (e.asymmetry != 0.0) text += force("constant", {{"force_n", -e.asymmetry * model.mu * normal}});
  return text;
}

std::string clock_of(const MotionFit& fit, const std::vector<std::size_t>& effects, const Comparison& comparison,
                     const EffectValues& e) {
  std::string keys;
  // The true step is (1 + e) times the stated one: the camera runs slower than stated.
  if (e.rate_error != 0.0) keys += fmt::format("rate_error_ppm = {:.9g}\n", 1e6 * (1.0 / (1.0 + e.rate_error) - 1.0));
  for (const std::size_t effect : effects) {
    if (effect_list()[effect].id == "dropped_frames" && !fit.late.empty()) {
      keys += fmt::format("dropped_fraction = {:.6g}\n", comparison.missing.effect.value);
    }
    for (const FrameEffect& frame : comparison.frames) {
      if (frame.effect == effect && effect_list()[effect].id == "timestamp_jitter") {
        keys += fmt::format("jitter_s = {:.6g}\n", frame.value);
      }
    }
  }
  return keys.empty() ? "" : "\n[clock]\n" + keys;
}

/// What one configuration needs besides its motions.
struct Place {
  std::size_t group = 0, mass = 0;
  bool operator<(const Place& other) const { return std::pair(group, mass) < std::pair(other.group, other.mass); }
};

}  // namespace

Twin twin_of(const TrackSet& set, const MotionFit& fit, const std::vector<std::size_t>& effects,
             const Comparison& comparison) {
  Twin twin;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::map<Place, std::vector<std::size_t>> places;
  std::set<std::size_t> clips;  // one motion of each: a scenario's clip begins with its motion
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    for (const double x : motion.x_m) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (clips.insert(motion.clip).second) places[{motion.group, motion.mass}].push_back(i);
  }
  std::set<std::string_view> named;
  for (const std::size_t e : effects) {
    named.insert(effect_list()[e].id);
    if (!expressible(effect_list()[e].id)) twin.lacks.emplace_back(effect_list()[e].id);
  }
  const bool forced = std::any_of(set.motions.begin(), set.motions.end(),
                                  [](const TrackedMotion& motion) { return !motion.known.t_s.empty(); });
  if (forced) twin.lacks.emplace_back("the recorded force");
  if (named.contains("power_law_drag") && named.contains("eddy_rolloff")) twin.lacks.emplace_back("eddy_rolloff");

  const double middle = 0.5 * (low + high), range = high - low;
  const double distance = 2.4 * std::max(1.0, 1.2 * range / kField);
  twin.toml = fmt::format(
      "# Made by glidelab diagnose --twin: the motions as they were fitted. x counts from {:.6g} m of the data.\n",
      middle);
  for (const std::string& id : twin.lacks) twin.toml += fmt::format("# Not in it: {}.\n", id);
  twin.toml += fmt::format(
      "format = 1\nname = \"twin\"\ngravity_m_s2 = {:.9g}\n\n[camera]\nframe_rate_hz = {:.9g}\n"
      "position_m = [0.0, 0.1, {:.4g}]\n",
      set.gravity_m_s2, set.clips[set.motions.front().clip].frame_rate_hz, distance);
  twin.toml += clock_of(fit, effects, comparison, model_of(set, *fit.layout, fit.at, 0).effects);
  for (const auto& [place, motions] : places) {
    const TrackGroup& group = set.groups[place.group];
    const TrackModel model = model_of(set, *fit.layout, fit.at, motions.front());
    twin.toml += fmt::format(
        "\n[[configuration]]\nname = \"g{}-m{}\"\nmass_kg = {:.9g}\nincline_deg = {:.12g}\nstated_incline_deg = "
        "{:.9g}\n"
        "group = \"{}\"\n",
        place.group + 1, place.mass + 1, model.mass_kg, model.alpha_rad * kDegrees, group.stated_rad * kDegrees,
        plain_name(group.name));
    for (const InclineStatement& statement : group.statements) {
      if (statement.against == "stated")
        twin.toml += fmt::format("stated_incline_sd_deg = {:.9g}\n", statement.sd_rad * kDegrees);
    }
    twin.toml += forces_of(model);
    for (const std::size_t i : motions) {
      const TrackedMotion& motion = set.motions[i];
      const Eigen::VectorXd& own = fit.at.own[i];
      const double frame = 1.0 / set.clips[motion.clip].frame_rate_hz;
      twin.toml += fmt::format(
          "[[configuration.clip]]\nname = \"{}\"\nlaunched = \"{}\"\nx0_m = {:.12g}\nv0_m_s = {:.12g}\nduration_s = "
          "{:.9g}\n",
          plain_name(set.clips[motion.clip].name),
          own[1] < 0.0   ? "up"
          : own[1] > 0.0 ? "down"
                         : "released",
          own[0] - middle, own[1], motion.t_s.back() - motion.t_s.front() + frame);
    }
  }
  return twin;
}

}  // namespace glidelab::diagnose
