/// A wrong length scale: x becomes (1 + e) x.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double scale_seen(const double* p, const GliderConstants&, double, double, double seen_m) {
  return seen_m * (1.0 + p[0]);
}

void scale_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto e = sizes.of("e");
  if (!e) return;
  camera.focal_factor *= 1.0 + *e;
  camera.focal_by = ids::scale_error;
  camera.notes.emplace_back(
      "the wrong scale is that of a focal length changed after the calibration: it shows in images only");
}

}  // namespace

EffectInfo scale_error() {
  return {
      .id = ids::scale_error,
      .stage = Stage::optics,
      .of_camera = false,
      .words = "a wrong length scale",
      .name = "wrong scale",
      .meaning = "x becomes (1 + e) x",
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
      .law = {.seen_m = scale_seen, .seen_by = SeenBy::scale},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::mount, scale_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {.id = ids::frame_rate_error, .filmed = true},
  };
}

}  // namespace glidelab::diagnose::effects
