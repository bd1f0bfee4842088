/// A camera that sways or shakes: the fixed scene moves in the image by A sin(2 pi f t + phase), with a phase of its
/// own in each motion.
///
/// A camera that turns moves the sides of the image by more: the amplitude is then A (1 + slope (x - x_mid) + bend (x -
/// x_mid)²), with x_mid the middle of the positions of all set-ups. The camera of imported tracks is unknown; there
/// the amplitude is the same everywhere.
#include "base/math/angles.h"
#include "diagnose/effects/effect.h"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostSway_rad = 30.0 / base::kDegreesPerRad;  // the largest turn that a scenario allows

double sway_seen(const double* p, const GliderConstants& glider, double x_m, double t_s, double seen_m) {
  const double off = x_m - glider.x_mid_all_m;
  const double size = p[0] * (1.0 + p[2] * off + p[3] * off * off);
  return seen_m + size * std::sin(2.0 * std::numbers::pi * p[1] * t_s + p[4]);
}

/// The acceleration w² A of a table that moves by as much.
double as_vibration(double amplitude_m, double f_hz) {
  return amplitude_m * std::pow(2.0 * std::numbers::pi * f_hz, 2);
}

void sway_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto f_hz = sizes.of("f_hz"), along_m = sizes.of("amplitude_m"), in_px = sizes.of("amplitude_px");
  if (!f_hz || !(along_m || in_px)) {
    return camera.lack(ids::camera_motion, "the direction in which the camera drifts is not measured");
  }
  const double pan = along_m ? std::atan(*along_m / camera.distance_m) : std::atan(*in_px / camera.focal_px);
  if (std::abs(pan) > kMostSway_rad) {
    return camera.lack(ids::camera_motion, "a scenario turns its camera by at most 30 degrees");
  }
  camera.notes.emplace_back("the camera's motion is a pan, with one phase for all clips: it shows in images only");
  camera.motions += fmt::format("\n[[mount.motion]]\naxis = \"pan\"\namplitude_deg = {:.9g}\nfrequency_hz = {:.9g}\n",
                                pan * base::kDegreesPerRad, *f_hz);
}

}  // namespace

EffectInfo camera_motion() {
  return {
      .id = ids::camera_motion,
      .stage = Stage::optics,
      .of_camera = true,
      .words = "a camera that sways or shakes",
      .name = "moving camera",
      .meaning = "the fixed scene moves by this amplitude, with frequency f",
      .search = Search::wave,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {.id = ids::base_vibration, .size = as_vibration, .phase_rad = std::numbers::pi},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "amplitude_m", .absent = 0.0, .low = 0.0, .high = 0.05, .step = 1e-8},
                     {.key = "f_hz", .absent = 0.0, .low = 0.2, .high = 1e4, .step = 1e-5, .reach = Reach::waves},
                     {.key = {}, .absent = 0.0, .low = -2.0, .high = 2.0, .step = 1e-4, .only_filmed = true},
                     {.key = {}, .absent = 0.0, .low = -2.0, .high = 2.0, .step = 1e-4, .only_filmed = true},
                     {.key = "phase", .absent = 0.0, .low = -1e3, .high = 1e3, .step = 1e-5, .each = Each::motion}},
      .law = {.seen_m = sway_seen, .seen_by = SeenBy::mount},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::mount, sway_twin),
      .in_images = InImages{.over = GapVariable::time, .what = GapKind::scene_place},
      .next =
          "Put the camera on a stand that does not touch the table, with a mark fixed to the wall in view, and record "
          "the same launch again: a swaying camera moves the mark and the glider alike.",
      .alike = {.id = ids::base_vibration, .filmed = false},
  };
}

}  // namespace glidelab::diagnose::effects
