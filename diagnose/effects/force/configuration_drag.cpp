/// A viscous drag K (1 + d), with d of each configuration (one mass on one set-up) its own; a drag of air c v |v| has
/// the same factor. A normal prior of standard deviation 0.5 holds d near 0.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void own_drag(const double* p, const GliderConstants&, const GliderState&, Resistance& of) {
  of.own_factor *= 1.0 + p[0];
}

void own_drag_twin(const double* p, TwinForces& forces) {
  forces.k_n_s_m *= 1.0 + p[0];
  forces.own_factor *= 1.0 + p[0];
}

}  // namespace

EffectInfo configuration_drag() {
  return {
      .id = ids::configuration_drag,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a drag that differs between configurations",
      .name = "drag by configuration",
      .meaning = "each mass on each set-up has a K of its own; sd: how far they differ",
      .search = Search::spread,
      .both_signs = true,
      .drag = Drag::viscous,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {.of = AmongClips::Of::drag},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "sd_n_s_m",
                      .absent = 0.0,
                      .low = -2.0,
                      .high = 5.0,
                      .step = 1e-5,
                      .shown_as = ShownAs::of_drag,
                      .each = Each::configuration,
                      .each_key = "k_n_s_m",
                      .held_sd = 0.5}},
      .law = {.resistance = own_drag, .steady = true},
      .shapes = nullptr,
      .lines = {.own = OwnOfLines::drag},
      .twin = EffectTwin::as_force(own_drag_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
