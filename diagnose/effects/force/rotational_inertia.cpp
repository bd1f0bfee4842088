/// Inertia m_w that is not part of the weighed mass, such as that of wheels, or of air or water that moves with the
/// glider: (m + m_w) dv/dt.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

double wheels_kg(const double* p, const GliderConstants&) {
  return p[0];
}

/// ln(K/m) - m_w/m and a0 (1 - m_w/m), to first order in m_w/m.
LineChange wheels_lines(const LineQuantities& line) {
  return {-1.0 / line.mass_kg, -line.a0_m_s2 / line.mass_kg};
}

/// The other forces of the twin carry the factor m/(m + m_w) already. A constant force gives gravity the same factor.
void wheels_twin(const double*, TwinForces& forces) {
  if (forces.part == 1.0) return;
  forces.others += scenario_force("constant", {{"force_n", -(1.0 - forces.part) * forces.along_n}});
}

/// An object that air brakes drags some air along.
double with_air(const Circumstances& of) {
  return of.only_falls ? 2.0 : 1.0;
}

}  // namespace

EffectInfo rotational_inertia() {
  return {
      .id = ids::rotational_inertia,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "added inertia, such as that of wheels, or of air or water that moves with the glider",
      .name = "added inertia",
      .meaning = "m dv/dt becomes (m + mass) dv/dt",
      .search = Search::amplitude,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = with_air,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "mass_kg", .absent = 0.0, .low = 0.0, .high = 0.5, .step = 1e-7, .reach = Reach::inertia}},
      .law = {.inertia_kg = wheels_kg},
      .shapes = nullptr,
      .lines = {.change = wheels_lines, .key = "mass_kg", .largest = 0.3},
      .twin = EffectTwin::as_force(wheels_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
