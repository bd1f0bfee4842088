/// A drag -c v |v|, such as that of air.
#include "diagnose/effects/effect.h"

#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

void quadratic_resistance(const double* p, const GliderConstants&, const GliderState& at, Resistance& of) {
  of.of_air_n += p[0] * at.v * std::abs(at.v);
}

void quadratic_twin(const double* p, TwinForces& forces) {
  forces.more_drag += scenario_force("quadratic", {{"c_kg_m", forces.part * forces.own_factor * p[0]}});
}

/// The Reynolds number of a cup of 0.1 m in air is 700 at 0.1 m/s already. A free fall whose braking shows is therefore
/// braked by such a drag.
double against_air(const Circumstances& of) {
  return of.only_falls ? 4.0 : 1.0;
}

}  // namespace

EffectInfo quadratic_drag() {
  return {
      .id = ids::quadratic_drag,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a drag that grows with the square of the speed, such as that of air",
      .name = "quadratic drag",
      .meaning = "a force −c v |v|",
      .search = Search::amplitude,
      .both_signs = false,
      .drag = Drag::of_air,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = against_air,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "c_kg_m", .absent = 0.0, .low = 0.0, .high = 1.0, .step = 1e-6, .reach = Reach::with_mass}},
      .law = {.resistance = quadratic_resistance},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_force(quadratic_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
