/// A drag K v |v/v_1|^(n - 1) with v_1 = 1 m/s. Fitted: n - 1.
#include "diagnose/effects/effect.h"

#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

void power_resistance(const double* p, const GliderConstants&, const GliderState& at, Resistance& of) {
  of.drag_factor *= at.v == 0.0 ? 0.0 : std::pow(std::abs(at.v), p[0]);
}

void power_twin(const double* p, TwinForces& forces) {
  forces.replace_drag(ids::power_law_drag,
                      scenario_force("power_law", {{"k_n_s_m", forces.k_n_s_m}, {"n", 1.0 + p[0]}}));
}

/// An arbitrary power of the speed is less likely than a law with a physical reason. In a fall too fast for a viscous
/// drag the power is 2.
double of_any_power(const Circumstances& of) {
  return of.through_air ? 0.05 : 0.4;
}

}  // namespace

EffectInfo power_law_drag() {
  return {
      .id = ids::power_law_drag,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a drag that grows as some other power of the speed",
      .name = "power-law drag",
      .meaning = "K v becomes K v |v|^(n − 1), v in m/s",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::of_air,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = of_any_power,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "n", .absent = 0.0, .low = -0.9, .high = 2.0, .step = 1e-6, .shown_as = ShownAs::one_more}},
      .law = {.resistance = power_resistance},
      .shapes = nullptr,
      .lines = {.same_as = ids::load_independent_friction},
      .twin = EffectTwin::as_force(power_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
