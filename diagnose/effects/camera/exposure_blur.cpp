/// An exposure that is longer than stated. The image of the marker is smeared by the speed times the exposure.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void blur_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto found = sizes.of("exposure_s");
  if (!found) return;
  if (*found > camera.stated_frame_s) {
    return camera.lack(ids::exposure_blur, "a scenario's exposure ends before the next one begins");
  }
  camera.exposure_s = *found;
}

}  // namespace

EffectInfo exposure_blur() {
  return {
      .id = ids::exposure_blur,
      .stage = Stage::sensor,
      .of_camera = true,
      .words = "an exposure that is longer than stated",
      .name = "exposure longer than stated",
      .meaning = "exposure: inferred from the smear of the marker",
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
      .twin = EffectTwin::as_camera(TwinPart::exposure, blur_twin),
      .in_images = InImages{.over = GapVariable::speed, .what = GapKind::marker_width},
      .next =
          "Record the same launch again with half the exposure and twice the light: the marker's smear is the speed "
          "times the exposure, and halves if the exposure causes it.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
