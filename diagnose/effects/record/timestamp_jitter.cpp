/// Frames that are not evenly spaced in time: the time of each frame has a random error.
#include "diagnose/effects/effect.h"

#include <fmt/format.h>
#include <algorithm>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kJitterReach = 2.0 * 5.9;  // standard deviations that a scenario keeps free between two exposures

void jitter_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto sd_s = sizes.of("sd_s");
  if (!sd_s) return;
  const double room_s = camera.frame_s - kJitterReach * *sd_s;
  if (!camera.exposure_known && room_s > 0.0) camera.exposure_s = std::min(camera.exposure_s, 0.999 * room_s);
  if (camera.exposure_s > room_s) {
    return camera.lack(ids::timestamp_jitter,
                       "a scenario's exposures do not overlap, even 5.9 standard deviations early or late");
  }
  camera.clock += fmt::format("jitter_s = {:.6g}\n", *sd_s);
}

}  // namespace

EffectInfo timestamp_jitter() {
  return {
      .id = ids::timestamp_jitter,
      .stage = Stage::timing,
      .of_camera = false,
      .words = "frames taken at uneven times",
      .name = "uneven frame times",
      .meaning = "sd: standard deviation of a frame's time",
      .search = Search::noise,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {.key = "sd_s", .parameters = 1},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::clock, jitter_twin),
      .in_images = std::nullopt,
      .next =
          "Record the same launch again with the camera's own time stamps, or with a lamp in the image that counts "
          "milliseconds: a wrong time shifts a position by the speed times its error, and only a clock shows the "
          "error itself.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
