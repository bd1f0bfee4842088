/// Lost frames. The frames after a loss move up, so that their stated times are too early.
#include "diagnose/effects/effect.h"

#include <fmt/format.h>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostDropped = 0.9;  // the largest fraction that a scenario allows

void dropped_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto fraction = sizes.of("fraction");
  if (!fraction) return;
  if (*fraction > kMostDropped) return camera.lack(ids::dropped_frames, "a scenario loses at most nine frames in ten");
  camera.clock += fmt::format("dropped_fraction = {:.6g}\n", *fraction);
}

}  // namespace

EffectInfo dropped_frames() {
  return {
      .id = ids::dropped_frames,
      .stage = Stage::timing,
      .of_camera = false,
      .words = "frames that are missing",
      .name = "lost frames",
      .meaning = "this fraction of the frames is missing",
      .search = Search::frames,
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
      .twin = EffectTwin::as_camera(TwinPart::clock, dropped_twin),
      .in_images = std::nullopt,
      .next =
          "Record the same launch again at half the frame rate or with a smaller image, and keep the camera's own "
          "time stamps: frames are lost when writing cannot keep up, and only a time stamp shows the gap.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
