/// Positions that are rounded to whole multiples of a step. The positions themselves show it
/// (diagnose/tracks/rounded_positions.h).
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
EffectInfo position_rounding() {
  return {
      .id = ids::position_rounding,
      .stage = Stage::tracking,
      .of_camera = false,
      .words = "positions that are rounded to a step",
      .name = "rounded positions",
      .meaning = "every position is a whole multiple of this step",
      .search = Search::noise,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {.key = "step_m", .parameters = 1},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("the positions of a scenario are not rounded"),
      .in_images = std::nullopt,
      .next =
          "Export the positions again with more decimals, or with the sensor nearer to the glider: repetition cannot "
          "recover what rounding has removed.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
