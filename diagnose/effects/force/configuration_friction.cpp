/// A dry friction mu + d, with d of each configuration (one mass on one set-up) its own. A normal prior of standard
/// deviation 0.02 holds d near 0.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void own_friction(const double* p, const GliderConstants&, const GliderState&, DryFriction& of) {
  of.mu += p[0];
}

void own_friction_twin(const double* p, TwinForces& forces) {
  forces.mu += forces.part * p[0];
}

}  // namespace

EffectInfo configuration_friction() {
  return {
      .id = ids::configuration_friction,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that differs between configurations",
      .name = "friction by configuration",
      .meaning = "each mass on each set-up has a µ of its own; sd: how far they differ",
      .search = Search::spread,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {.of = AmongClips::Of::friction},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "sd",
                      .absent = 0.0,
                      .low = -0.5,
                      .high = 0.5,
                      .step = 1e-6,
                      .shown_as = ShownAs::of_mu,
                      .each = Each::configuration,
                      .each_key = "mu",
                      .held_sd = 0.02}},
      .law = {.friction = own_friction, .steady = true},
      .shapes = nullptr,
      .lines = {.own = OwnOfLines::mu},
      .twin = EffectTwin::as_force(own_friction_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
