/// A viscous drag K (1 + b (x - x_mid)) that changes along the track.
///
/// The second parameter moves x_mid from the middle of the set-up's own positions (0) to the middle of all positions
/// (1: one K(x) for the track).
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void gradient_resistance(const double* p, const GliderConstants& glider, const GliderState& at, Resistance& of) {
  const double off = at.x - glider.x_mid_m;
  of.drag_along *= 1.0 + p[0] * (off - p[1] * (glider.x_mid_all_m - glider.x_mid_m));
}

std::vector<double> gradient_middles(const ShapeReach& reach) {
  return reach.several_setups ? std::vector<double>{0.0, 1.0} : std::vector<double>{0.0};
}

}  // namespace

EffectInfo damping_gradient() {
  return {
      .id = ids::damping_gradient,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a drag that changes along the track",
      .name = "drag that varies along x",
      .meaning = "K becomes K (1 + b (x − x_mid)), x_mid the middle of the data",
      .search = Search::shape,
      .both_signs = true,
      .drag = Drag::viscous,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "b_1_m", .absent = 0.0, .low = -3.0, .high = 3.0, .step = 1e-6},
           {.key = {}, .absent = 0.0, .low = -5.0, .high = 5.0, .step = 1e-4, .shown_as = ShownAs::place_of_middle}},
      .law = {.resistance = gradient_resistance},
      .shapes = gradient_middles,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
