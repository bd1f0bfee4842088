/// A calibration pattern that was not in the plane of motion: x becomes x / (1 + p x).
///
/// Its twin is a camera turned by atan(downhill p' Z), where p' = p/(1 + p x_f), x_f is the position that the camera
/// faces, and Z is the camera's distance from the plane of motion.
#include "base/math/angles.h"
#include "diagnose/effects/effect.h"

#include <fmt/format.h>
#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostTurn_rad = 30.0 / base::kDegreesPerRad;  // the largest turn that a scenario allows

double perspective_seen(const double* p, const GliderConstants&, double, double, double seen_m) {
  return seen_m / (1.0 + p[0] * seen_m);
}

void perspective_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto p = sizes.of("p_1_m");
  if (!p) return;
  const double before_m = 1.0 + *p * (camera.reference_m + camera.downhill * camera.x_m);
  const double tangent = camera.downhill * *p / before_m * camera.z_m;
  if (!(before_m > 0.0) || std::abs(std::atan(tangent)) > kMostTurn_rad) {
    return camera.lack(ids::perspective_error, "a scenario turns its camera by at most 30 degrees");
  }
  camera.focal_factor /= before_m * before_m * (1.0 + tangent * tangent);
  if (camera.focal_by.empty()) camera.focal_by = ids::perspective_error;
  camera.motions += fmt::format("\n[[mount.motion]]\naxis = \"pan\"\noffset_deg = {:.9g}\n",
                                std::atan(tangent) * base::kDegreesPerRad);
  camera.notes.emplace_back(
      "the perspective error is that of a camera turned after the calibration: it shows in images only");
}

}  // namespace

EffectInfo perspective_error() {
  return {
      .id = ids::perspective_error,
      .stage = Stage::optics,
      .of_camera = true,
      .words = "a calibration pattern that was not in the plane of motion",
      .name = "pattern off the plane",
      .meaning = "x becomes x / (1 + p x)",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "p_1_m", .absent = 0.0, .low = -0.5, .high = 0.5, .step = 1e-7}},
      .law = {.seen_m = perspective_seen, .seen_by = SeenBy::plane},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::mount, perspective_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
