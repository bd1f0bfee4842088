/// Stribeck friction: a dry friction mu (1 + (s - 1) exp(-(v/v_s)²)) that is larger at low speeds. Fitted: s - 1 and
/// v_s.
#include "diagnose/effects/effect.h"

#include <algorithm>
#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

void stribeck_friction(const double* p, const GliderConstants&, const GliderState& at, DryFriction& of) {
  of.mu *= 1.0 + p[0] * std::exp(-(at.v * at.v) / (p[1] * p[1]));
}

std::vector<double> stribeck_speeds(const ShapeReach& reach) {
  std::vector<double> speeds;
  for (double v = std::max(0.008, reach.held_m_s); v < 0.7; v *= 1.5) speeds.push_back(v);
  return speeds;
}

void stribeck_twin(const double* p, TwinForces& forces) {
  forces.friction = scenario_force("stribeck", {{"mu", forces.mu}, {"s", 1.0 + p[0]}, {"v_s_m_s", p[1]}});
}

}  // namespace

EffectInfo stribeck() {
  return {
      .id = ids::stribeck,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that is larger at low speeds",
      .name = "more friction at low speed",
      .meaning = "µ becomes µ (1 + (s − 1) exp(−(v / v_s)²))",
      .search = Search::shape,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "s", .absent = 0.0, .low = 0.0, .high = 50.0, .step = 1e-5, .shown_as = ShownAs::one_more},
           {.key = "v_s_m_s", .absent = 0.05, .low = 0.003, .high = 1.0, .step = 1e-5, .reach = Reach::held_speed}},
      .law = {.friction = stribeck_friction},
      .shapes = stribeck_speeds,
      .lines = {},
      .twin = EffectTwin::as_force(stribeck_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
