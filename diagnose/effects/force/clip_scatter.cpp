/// A dry friction mu + d and a viscous drag K (1 + e), with d and e of each clip its own; a drag of air c v |v| has the
/// factor 1 + e too. Normal priors of standard deviation 0.02 and 0.5 hold them near 0.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void scattered_friction(const double* p, const GliderConstants&, const GliderState&, DryFriction& of) {
  of.mu += p[0];
}

void scattered_drag(const double* p, const GliderConstants&, const GliderState&, Resistance& of) {
  of.own_factor *= 1.0 + p[1];
}

}  // namespace

EffectInfo clip_scatter() {
  return {
      .id = ids::clip_scatter,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "friction and drag that differ from clip to clip",
      .name = "scatter from clip to clip",
      .meaning = "each clip has a µ and a K of its own; sd: how far they differ",
      .search = Search::spread,
      .both_signs = true,
      .drag = Drag::viscous,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = -1.8,
      .parameters = {{.key = "sd_mu",
                      .absent = 0.0,
                      .low = -0.5,
                      .high = 0.5,
                      .step = 1e-6,
                      .shown_as = ShownAs::of_mu,
                      .each = Each::clip,
                      .held_sd = 0.02},
                     {.key = "sd_k_n_s_m",
                      .absent = 0.0,
                      .low = -2.0,
                      .high = 5.0,
                      .step = 1e-5,
                      .shown_as = ShownAs::of_drag,
                      .each = Each::clip,
                      .held_sd = 0.5}},
      .law =
          {.sizes = 2, .resistance = scattered_drag, .friction = scattered_friction, .steady = true, .passing = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("in a scenario all clips of a configuration have the same forces"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
