#include "core/result/one_direction.h"

#include <cmath>
#include <variant>

#include "base/math/angles.h"
#include "core/experiment/local_gravity.h"

namespace glidelab::core {
namespace {

constexpr double kVertical_deg = 90.0, kClearOfVertical = 5.0;  // standard deviations

bool has_normal_force(const ConfigurationResult& stated, double sd_deg) {
  return std::abs(stated.incline_deg) + kClearOfVertical * sd_deg < kVertical_deg;
}

template <typename Kind>
void erase_notes(std::vector<Note>& notes) {
  std::erase_if(notes, [](const Note& note) { return std::holds_alternative<Kind>(note); });
}

}  // namespace

std::optional<MuOfOneDirection> mu_of_one_direction(const ConfigurationResult& stated, int direction, double a0_m_s2,
                                                    double gravity_m_s2) {
  if (stated.incline_assumed || !(stated.incline_sd_deg.value_or(0.0) > 0.0)) return std::nullopt;
  if (!has_normal_force(stated, *stated.incline_sd_deg)) return std::nullopt;
  const double alpha = stated.incline_deg * base::kRadPerDegree;
  const double sine = std::sin(alpha), cosine = std::cos(alpha), over_g = a0_m_s2 / gravity_m_s2;
  MuOfOneDirection mu;
  mu.value = direction * (sine - over_g) / cosine;
  mu.by_a0 = -direction / (gravity_m_s2 * cosine);
  mu.of_incline = direction * (1.0 - over_g * sine) / (cosine * cosine) * *stated.incline_sd_deg * base::kRadPerDegree;
  mu.by_gravity = direction * over_g / (gravity_m_s2 * cosine);
  return mu;
}

bool incline_would_do(const ConfigurationResult& configuration) {
  const bool stated = !configuration.incline_assumed && configuration.incline_sd_deg.value_or(0.0) > 0.0;
  return !stated && has_normal_force(configuration, 0.0);
}

void note_mu_from_incline(ConfigurationResult& configuration) {
  erase_notes<MuFromIncline>(configuration.notes);
  if (!configuration.mu.estimate || configuration.alpha_deg.estimate || !configuration.incline_sd_deg) return;
  configuration.notes.emplace_back(MuFromIncline{configuration.incline_deg, *configuration.incline_sd_deg});
}

void note_gravity(AnalysisResults& results) {
  for (ConfigurationResult& configuration : results.configurations) erase_notes<GravityAssumed>(configuration.notes);
  if (results.gravity_sd_m_s2 < kLocalGravity_sd_m_s2) return;  // the place is known
  for (ConfigurationResult& configuration : results.configurations) {
    if (!configuration.mu.estimate && !configuration.alpha_deg.estimate) continue;
    configuration.notes.emplace_back(GravityAssumed{results.gravity_m_s2, results.gravity_sd_m_s2});
    return;
  }
}

}  // namespace glidelab::core
