/// A bowed track: sin(alpha) becomes sin(alpha) + slope (x - x_mid), x_mid the middle of the set-up's positions.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void bow_resistance(const double* p, const GliderConstants& glider, const GliderState& at, Resistance& of) {
  of.slope += p[0] * (at.x - glider.x_mid_m);
}

/// A falling object has no track.
double bows(const Circumstances& of) {
  return of.only_falls ? 0.0 : 1.0;
}

}  // namespace

EffectInfo track_bow() {
  return {
      .id = ids::track_bow,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a track that is not straight but bowed",
      .name = "bowed track",
      .meaning = "sin α becomes sin α + slope (x − x_mid), x_mid the middle of the data",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = bows,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "slope_1_m",
                      .absent = 0.0,
                      .low = -0.3,
                      .high = 0.3,
                      .step = 1e-7,
                      .shown_as = ShownAs::itself_and_middle}},
      .law = {.resistance = bow_resistance},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
