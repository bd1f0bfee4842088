/// Light that is brighter on one side of the marker and pulls its centre to that side.
#include "diagnose/effects/effect.h"

#include <fmt/format.h>
#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostGradient_1_m = 2.0;  // the steepest that a scenario allows

void side_light_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto gradient = sizes.of("gradient");
  if (!gradient) return;
  if (std::abs(*gradient) > kMostGradient_1_m) {
    return camera.lack(ids::light_gradient, "a scenario's light changes by at most a factor of exp(2) per metre");
  }
  camera.light += fmt::format("gradient_per_m = [{:.6g}, 0.0]\n", *gradient);
}

}  // namespace

EffectInfo light_gradient() {
  return {
      .id = ids::light_gradient,
      .stage = Stage::optics,
      .of_camera = true,
      .words = "light that is much brighter on one side",
      .name = "light from one side",
      .meaning = "how much brighter it is on one side of the marker",
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
      .twin = EffectTwin::as_camera(TwinPart::light, side_light_twin),
      .in_images = InImages{.over = GapVariable::column, .what = GapKind::brightness, .along_track = true},
      .next =
          "Record the same launch again with a second lamp from the other side, or through a diffuser: where the "
          "light is even, nothing pulls the marker's centre to the brighter side.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
