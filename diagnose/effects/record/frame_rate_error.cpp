/// A frame rate that differs from the stated one: the true time from frame to frame is (1 + e) times the stated one.
#include "diagnose/effects/effect.h"

#include <fmt/format.h>
#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostClockError_ppm = 1e5;  // the largest that a scenario allows

double rate_stretch(const double* p) {
  return 1.0 + p[0];
}

void rate_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto e = sizes.of("e");
  if (!e) return;
  // If e > 0, the camera runs slower than stated.
  const double ppm = 1e6 * (1.0 / (1.0 + *e) - 1.0);
  const double step_s = camera.stated_frame_s * (1.0 + *e);
  if (std::abs(ppm) > kMostClockError_ppm || step_s < camera.exposure_s) {
    return camera.lack(ids::frame_rate_error,
                       "a scenario's clock is off by at most a tenth, and its exposures do not overlap");
  }
  camera.clock += fmt::format("rate_error_ppm = {:.9g}\n", ppm);
  camera.frame_s = step_s;
}

}  // namespace

EffectInfo frame_rate_error() {
  return {
      .id = ids::frame_rate_error,
      .stage = Stage::timing,
      .of_camera = false,
      .words = "a frame rate that differs from the stated one",
      .name = "wrong frame rate",
      .meaning = "the time from frame to frame is (1 + e) times the stated one",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "e", .absent = 0.0, .low = -0.3, .high = 0.3, .step = 1e-7, .usual = 0.1}},
      .law = {.stretch = rate_stretch},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::clock, rate_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
