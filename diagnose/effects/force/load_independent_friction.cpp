/// A dry friction -sign(v) F_0 that does not depend on the load.
///
/// A drag that rolls off, K v / (1 + (v/v_c)²), or grows as v^n with n < 1 is, about the typical speed V of a table's
/// lines, a line with the intercept - s (2 K V³/v_c²)/m or - s (1 - n) K V^n/m: the same column as this force.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void fixed_friction(const double* p, const GliderConstants&, const GliderState&, DryFriction& of) {
  of.force_n += p[0];
}

/// a0 - s F/m.
LineChange fixed_friction_lines(const LineQuantities& line) {
  return {0.0, -line.direction / line.mass_kg};
}

/// More mu for a lighter glider.
void fixed_friction_twin(const double* p, TwinForces& forces) {
  forces.others += scenario_force("coulomb", {{"mu", forces.part * p[0] / forces.normal_n}});
}

/// What falls touches nothing, unless something guides it.
double without_a_track(const Circumstances& of) {
  return of.only_falls ? 0.25 : 1.0;
}

}  // namespace

EffectInfo load_independent_friction() {
  return {
      .id = ids::load_independent_friction,
      .stage = Stage::dynamics,
      .words = "a dry friction that does not depend on the load",
      .name = "load-independent friction",
      .meaning = "the same friction force at every mass",
      .search = Search::amplitude,
      .both_signs = false,
      .odds = without_a_track,
      .parameters =
          {{.key = "force_n", .absent = 0.0, .low = 0.0, .high = 1.0, .step = 1e-7, .reach = Reach::with_mass}},
      .law = {.friction = fixed_friction},
      .shapes = nullptr,
      .lines = {.change = fixed_friction_lines, .key = "force_n", .largest = 1.0},
      .twin = EffectTwin::as_force(fixed_friction_twin),
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
