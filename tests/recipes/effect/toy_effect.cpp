/// A spring along the whole track, a force -k x: the example of docs/extending.md.
#include <algorithm>
#include <cmath>

#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double spring_force(const double* p, const GliderConstants&, const GliderState& at) {
  return -p[0] * at.x;
}

double spring_rate(const double* p, double mass_kg) {
  return std::sqrt(std::max(0.0, p[0]) / mass_kg);
}

}  // namespace

EffectInfo toy_effect() {
  return {
      .id = ids::toy_effect,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a spring along the whole track",
      .name = "spring",
      .meaning = "a force −k x",
      .search = Search::amplitude,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "k_n_m", .absent = 0.0, .low = 0.0, .high = 20.0, .step = 1e-5, .reach = Reach::with_mass}},
      .law = {.force_n = spring_force, .rate_1_s = spring_rate},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
