/// A magnetic drag K v / (1 + (v/v_c)²): it grows more slowly than the speed, is largest at v_c and falls beyond.
/// Fitted: 1/v_c².
#include "diagnose/effects/effect.h"

#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

void eddy_resistance(const double* p, const GliderConstants&, const GliderState& at, Resistance& of) {
  of.drag_divisor *= 1.0 + p[0] * at.v * at.v;
}

void eddy_twin(const double* p, TwinForces& forces) {
  if (!(p[0] > 0.0)) return;
  forces.replace_drag(ids::eddy_rolloff, scenario_force("eddy_rolloff", {{"k_n_s_m", forces.k_n_s_m},
                                                                         {"v_c_m_s", 1.0 / std::sqrt(p[0])}}));
}

}  // namespace

EffectInfo eddy_rolloff() {
  return {
      .id = ids::eddy_rolloff,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a magnetic drag that grows less than in proportion to the speed, and falls off beyond v_c",
      .name = "magnetic drag that falls off",
      .meaning = "K v becomes K v / (1 + (v / v_c)²)",
      .search = Search::amplitude,
      .both_signs = false,
      .drag = Drag::viscous,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "v_c_m_s",
                      .absent = 0.0,
                      .low = 0.0,
                      .high = 100.0,
                      .step = 1e-6,
                      .shown_as = ShownAs::inverse_root}},
      .law = {.resistance = eddy_resistance},
      .shapes = nullptr,
      .lines = {.same_as = ids::load_independent_friction},
      .twin = EffectTwin::as_force(eddy_twin),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
