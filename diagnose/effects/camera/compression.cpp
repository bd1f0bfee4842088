/// A codec that loses detail. It leaves block edges in the image, and errors that persist over several frames.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void codec_twin(const TwinSizes&, TwinCamera& camera) {
  camera.lossy = true;
}

}  // namespace

EffectInfo compression() {
  return {
      .id = ids::compression,
      .stage = Stage::sensor,
      .of_camera = true,
      .words = "a codec that loses detail",
      .name = "lossy compression",
      .meaning = {},
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
      .twin = EffectTwin::as_camera(TwinPart::codec, codec_twin),
      .in_images = InImages{.over = GapVariable::column, .what = GapKind::block_steps},
      .next =
          "Record the same launch again without loss (FFV1 or single images; at least MJPEG in place of H.264): block "
          "edges and errors that persist over frames come from the codec and disappear with it.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
