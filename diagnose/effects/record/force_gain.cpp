/// A recorded force F that acts as (1 + e) F.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double gain_factor(const double* p) {
  return 1.0 + p[0];
}

}  // namespace

EffectInfo force_gain() {
  return {
      .id = ids::force_gain,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a recorded force that is too small or too large by a constant factor",
      .name = "wrong scale of the force",
      .meaning = "the force is (1 + e) times the recorded one",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "e", .absent = 0.0, .low = -0.9, .high = 5.0, .step = 1e-6}},
      .law = {.known_factor = gain_factor},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on time"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
