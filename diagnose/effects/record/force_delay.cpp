/// The force that acts at t is F(t - tau), F being the recorded one.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double delay_s(const double* p) {
  return p[0];
}

}  // namespace

EffectInfo force_delay() {
  return {
      .id = ids::force_delay,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a force that acts later or earlier than recorded",
      .name = "delay of the force",
      .meaning = "the force acts τ later than recorded",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "tau_s", .absent = 0.0, .low = -0.5, .high = 0.5, .step = 1e-5}},
      .law = {.known_late_s = delay_s},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on time"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
