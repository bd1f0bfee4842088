/// Outliers: single positions that lie far off.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
EffectInfo heavy_tailed_noise() {
  return {
      .id = ids::heavy_tailed_noise,
      .stage = Stage::tracking,
      .words = "single positions that lie far off",
      .name = "outliers",
      .meaning = "this fraction of the positions are outliers",
      .search = Search::noise,
      .both_signs = false,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("a scenario has no outliers of its own"),
      .next =
          "Record the same launch again with a larger marker of more contrast and nothing else that is round in the "
          "image: single outlying positions come from frames in which something else was taken for part of it.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
