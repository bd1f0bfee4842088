/// A dry friction mu (1 + d sign(v)). The part with d is the constant force -d mu m g cos(alpha).
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void asymmetry_resistance(const double* p, const GliderConstants& glider, const GliderState&, Resistance& of) {
  of.against_n += p[0] * glider.mu * glider.weight_n * glider.cos_alpha;
}

void asymmetry_twin(const double* p, TwinForces& forces) {
  forces.others += scenario_force("constant", {{"force_n", -p[0] * forces.mu * forces.normal_n}});
}

}  // namespace

EffectInfo direction_asymmetry() {
  return {
      .id = ids::direction_asymmetry,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that is larger in one direction than in the other",
      .name = "direction-dependent friction",
      .meaning = "µ becomes µ (1 + d sign(v))",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "d", .absent = 0.0, .low = -1.0, .high = 1.0, .step = 1e-5}},
      .law = {.resistance = asymmetry_resistance, .steady = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_force(asymmetry_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
