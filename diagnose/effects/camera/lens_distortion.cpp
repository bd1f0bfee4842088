/// A lens whose distortion is not corrected: x becomes x (1 + k (x - x_c)²), with the optical axis at x_c.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double lens_seen(const double* p, const GliderConstants&, double, double, double seen_m) {
  return seen_m * (1.0 + p[0] * (seen_m - p[1]) * (seen_m - p[1]));
}

std::vector<double> lens_places(const ShapeReach& reach) {
  return places_of(reach, 9);
}

}  // namespace

EffectInfo lens_distortion() {
  return {
      .id = ids::lens_distortion,
      .stage = Stage::optics,
      .of_camera = true,
      .words = "a lens whose distortion is not corrected",
      .name = "lens distortion",
      .meaning = "x becomes x (1 + k (x − x_c)²)",
      .search = Search::shape,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      // The axis is in the middle of the images, which show the motion in their middle.
      .parameters = {{.key = "k_1_m2", .absent = 0.0, .low = -0.5, .high = 0.5, .step = 1e-7, .reach = Reach::bulge},
                     {.key = "x_c_m",
                      .absent = 0.0,
                      .low = -1e3,
                      .high = 1e3,
                      .step = 1e-5,
                      .reach = Reach::places,
                      .usual = 0.25}},
      .law = {.seen_m = lens_seen, .seen_by = SeenBy::lens},
      .shapes = lens_places,
      .lines = {},
      .twin = EffectTwin::none("a scenario's clips are seen through the lens that it calibrates"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
