/// A dry friction -sign(v) F_0 that does not depend on the load.
///
/// In a table of lines, a drag that rolls off, K v / (1 + (v/v_c)²), or one that grows as K v^n with n < 1, has the
/// same effect. About a typical speed V its a(v) is a line whose intercept is shifted by -s (2 K V³/v_c²)/m or by -s (1
/// - n) K V^n/m, just as by this force.
#include "diagnose/effects/effect.h"
#include "diagnose/effects/force/touching.h"

namespace glidelab::diagnose::effects {
namespace {

void fixed_friction(const double* p, const GliderConstants&, const GliderState&, DryFriction& of) {
  of.force_n += p[0];
}

/// Under one load it is a part of mu. With loads that differ by the factor q, F_0 is known to sd(mu N) q/(q - 1).
double of_several_loads(const Circumstances& of) {
  constexpr double kLeastRatio = 1.05;
  return of.loads < kLeastRatio ? 0.0 : touched(of);
}

/// a0 - s F_0/m, s the direction.
LineChange fixed_friction_lines(const LineQuantities& line) {
  return {0.0, -line.direction / line.mass_kg};
}

/// A coefficient of friction that is larger for a lighter glider.
void fixed_friction_twin(const double* p, TwinForces& forces) {
  forces.others += scenario_force("coulomb", {{"mu", forces.part * p[0] / forces.normal_n}});
}

}  // namespace

EffectInfo load_independent_friction() {
  return {
      .id = ids::load_independent_friction,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that does not depend on the load",
      .name = "load-independent friction",
      .meaning = "the same friction force at every mass",
      .search = Search::amplitude,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = of_several_loads,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "force_n", .absent = 0.0, .low = 0.0, .high = 1.0, .step = 1e-7, .reach = Reach::with_mass}},
      .law = {.friction = fixed_friction, .steady = true},
      .shapes = nullptr,
      .lines = {.change = fixed_friction_lines, .key = "force_n", .largest = 1.0},
      .twin = EffectTwin::as_force(fixed_friction_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
