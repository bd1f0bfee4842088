/// Outliers: single positions that lie far off the motion.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
EffectInfo heavy_tailed_noise() {
  return {
      .id = ids::heavy_tailed_noise,
      .stage = Stage::tracking,
      .of_camera = false,
      .words = "single positions that lie far off the motion",
      .name = "outliers",
      .meaning = "this fraction of the positions are outliers",
      .search = Search::noise,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {.key = "fraction", .parameters = 2},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("a scenario has no outliers of its own"),
      .in_images = std::nullopt,
      .next =
          "Record the same launch again with a larger, higher-contrast marker and no other round object in the image, "
          "or with nothing else in the beam of a motion sensor: single outlying positions come from moments in which "
          "something else was mistaken for the glider.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
