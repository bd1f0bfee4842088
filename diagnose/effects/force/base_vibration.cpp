/// A table or track that shakes: a force m A sin(2 pi f t + phase), with a phase of its own in each motion.
#include "diagnose/effects/effect.h"

#include <cmath>
#include <numbers>

namespace glidelab::diagnose::effects {
namespace {

constexpr double kMostShaking_m_s2 = 4.0;  // 0.4 g: no table that holds a track shakes more

// A step is 0.3 of the inverse rate, but it may cover 0.9 rad of the wave: Simpson's rule errs by (omega h)^4/2880 of
// it.
constexpr double kTurnOfWave = 0.3 / 0.9;

double vibration_force(const double* p, const GliderConstants& glider, const GliderState& at) {
  return glider.mass_kg * p[0] * at.wave;
}

double vibration_rate(const double* p, double) {
  return kTurnOfWave * (2.0 * std::numbers::pi * p[1]);
}

/// The displacement a/w² of the table.
double as_sway(double a_m_s2, double f_hz) {
  return a_m_s2 / std::pow(2.0 * std::numbers::pi * f_hz, 2);
}

}  // namespace

EffectInfo base_vibration() {
  return {
      .id = ids::base_vibration,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a table or track that shakes",
      .name = "shaking table",
      .meaning = "an acceleration of amplitude a and frequency f",
      .search = Search::wave,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {.id = ids::camera_motion, .size = as_sway, .phase_rad = std::numbers::pi},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "a_m_s2", .absent = 0.0, .low = 0.0, .high = kMostShaking_m_s2, .step = 1e-5},
                     {.key = "f_hz", .absent = 0.0, .low = 0.2, .high = 1e4, .step = 1e-5, .reach = Reach::waves},
                     {.key = "phase", .absent = 0.0, .low = -1e3, .high = 1e3, .step = 1e-5, .each = Each::motion}},
      .law = {.force_n = vibration_force, .rate_1_s = vibration_rate, .passing = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on time"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
