#include "validate/blind/blind_left_out.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace glidelab::validate {

std::string verdict_without(const BlindOutcome& outcome) {
  if (!outcome.left_out) throw std::logic_error("a case that was not diagnosed without its effect");
  const BlindVerdict& without = *outcome.left_out;
  if (without.verdict != "effect") return without.verdict;
  // Equals of the truth on these data, as the full diagnosis says it, may take its place.
  const std::set<std::string> named = named_by(outcome);
  const bool truth_named = named.contains(true_class(outcome));
  if (truth_named && named.contains(blind_class(without.effects.front().id, outcome.filmed))) return "equivalent";
  const bool sure = std::any_of(without.effects.begin(), without.effects.end(),
                                [](const BlindNamed& effect) { return effect.probability > kSureName; });
  return sure ? "another name, probability over 0.8" : "another name";
}

std::vector<std::string> variables_of(const std::string& effect) {
  const std::vector<std::string> speed = {"v_m_s"}, place = {"x_m"}, time = {"t_s", "clip"};
  static const std::map<std::string, std::vector<std::string>> seen = {
      {"quadratic_drag", speed},
      {"eddy_rolloff", speed},
      {"power_law_drag", speed},
      {"stribeck", speed},
      {"load_independent_friction", {"mass_kg", "direction", "v_m_s"}},  // -sign(v) F0, by mass
      {"direction_asymmetry", {"direction", "v_m_s"}},
      {"track_bow", place},
      {"damping_gradient", {"x_m", "v_m_s"}},  // a drag by place
      {"rotational_inertia", {"mass_kg", "a_m_s2"}},
      {"tether", place},
      {"base_vibration", time},
      {"late_release", time},
      {"camera_motion", time},
      {"dropped_frames", time},
      {"perspective_error", place},
      {"lens_distortion", place},
      {"rolling_shutter", {"v_m_s", "x_m"}}};
  const auto found = seen.find(effect);
  return found == seen.end() ? std::vector<std::string>{} : found->second;
}

}  // namespace glidelab::validate
