/// A hand that still pushes until the time t_r after the first frame, with a constant acceleration of its own in each
/// motion.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double release_force(const double* p, const GliderConstants& glider, const GliderState& at) {
  return at.pushed ? glider.mass_kg * p[1] : 0.0;
}

}  // namespace

EffectInfo late_release() {
  return {
      .id = ids::late_release,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a hand that still pushes at the start of the clips",
      .name = "late release",
      .meaning = "the hand pushes until t_r",
      .search = Search::pushes,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::hand,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = -3.2,
      // A push that lasts for half a second follows whatever else is missing there.
      .parameters = {{.key = "t_r_s",
                      .absent = 0.0,
                      .low = 1e-3,
                      .high = 0.5,
                      .step = 1e-4,
                      .reach = Reach::release,
                      .usual = 0.2},
                     {.key = "push", .absent = 0.0, .low = -50.0, .high = 50.0, .step = 1e-5, .each = Each::motion}},
      .law = {.size = 1, .force_n = release_force, .steady = true, .passing = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on time"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
