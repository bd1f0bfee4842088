/// Light that flickers: its brightness varies periodically in time.
#include "diagnose/effects/effect.h"

#include <fmt/format.h>

namespace glidelab::diagnose::effects {
namespace {

void flicker_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto depth = sizes.of("depth"), f_hz = sizes.of("f_hz");
  if (!depth || !f_hz) return;
  if (*depth > 1.0) return camera.lack(ids::light_flicker, "a scenario's light flickers by at most its own brightness");
  camera.light += fmt::format("flicker_depth = {:.6g}\nflicker_hz = {:.9g}\n", *depth, *f_hz);
}

}  // namespace

EffectInfo light_flicker() {
  return {
      .id = ids::light_flicker,
      .stage = Stage::optics,
      .of_camera = true,
      .words = "light that flickers",
      .name = "flickering light",
      .meaning = "brightness changes by this depth, with frequency f",
      .search = Search::images,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::light, flicker_twin),
      .in_images = InImages{.over = GapVariable::time, .what = GapKind::brightness},
      .next =
          "Record the same launch again with an exposure of one whole period of the flicker (lamps flicker at twice "
          "the mains frequency: 10 ms at 50 Hz, 8.3 ms at 60 Hz), or under lamps on direct current: then every frame "
          "collects the same light.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
