/// Stated masses that are wrong by a common factor: a glider of stated mass m that a recorded force drives has the
/// inertia (1 + e) m. Without such a force the error cannot be told from K and mu.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double wrong_mass_kg(const double* p, const GliderConstants& glider) {
  return glider.driven ? p[0] * glider.mass_kg : 0.0;
}

}  // namespace

EffectInfo mass_error() {
  return {
      .id = ids::mass_error,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "stated masses that are wrong by a common factor",
      .name = "wrong mass",
      .meaning = "the inertia is (1 + e) times the stated mass",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "e", .absent = 0.0, .low = -0.9, .high = 5.0, .step = 1e-6}},
      .law = {.inertia_kg = wrong_mass_kg},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("a scenario has no recorded force, and without one a wrong mass does not show"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {.id = ids::frame_rate_error, .filmed = true},
  };
}

}  // namespace glidelab::diagnose::effects
