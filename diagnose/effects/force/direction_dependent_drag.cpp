/// A viscous drag K (1 + d sign(v)), as seals, lips and screws have.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void directed_resistance(const double* p, const GliderConstants&, const GliderState& at, Resistance& of) {
  of.drag_factor *= at.v < 0.0 ? 1.0 - p[0] : 1.0 + p[0];
}

/// ln K + d s to first order, s the direction.
LineChange directed_lines(const LineQuantities& line) {
  return {line.direction, 0.0};
}

}  // namespace

EffectInfo direction_dependent_drag() {
  return {
      .id = ids::direction_dependent_drag,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a drag that is larger in one direction than in the other",
      .name = "direction-dependent drag",
      .meaning = "K becomes K (1 + d sign(v))",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::viscous,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "d",
                      .absent = 0.0,
                      .low = -0.99,
                      .high = 0.99,
                      .step = 1e-5,
                      .shown_as = ShownAs::itself_and_directions}},
      .law = {.resistance = directed_resistance, .steady = true},
      .shapes = nullptr,
      .lines = {.change = directed_lines, .key = "d", .largest = 0.5},
      .twin = EffectTwin::none("no drag in a scenario depends on the direction"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
