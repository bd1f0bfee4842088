/// A cable or spring that pulls back with the force -k (x - x_t) where x > x_t.
#include "diagnose/effects/effect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/effects/force/touching.h"

namespace glidelab::diagnose::effects {
namespace {

double tether_force(const double* p, const GliderConstants&, const GliderState& at) {
  return at.x > p[1] ? -(p[0] * (at.x - p[1])) : 0.0;
}

double tether_rate(const double* p, double mass_kg) {
  return std::sqrt(std::max(0.0, p[0]) / mass_kg);
}

std::vector<double> tether_places(const ShapeReach& reach) {
  return places_of(reach, 24);
}

}  // namespace

EffectInfo tether() {
  return {
      .id = ids::tether,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a cable or spring that pulls back beyond some point",
      .name = "tightening cable",
      .meaning = "a force −k (x − x_t) beyond x_t",
      .search = Search::shape,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::in_one_place,
      .mirror = {.id = ids::end_stop, .beyond_middle = true},
      .among_clips = {},
      .point_scatter = {},
      .odds = touched,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "k_n_m", .absent = 0.0, .low = 0.0, .high = 200.0, .step = 1e-5, .reach = Reach::with_mass},
           {.key = "x_t_m",
            .absent = std::numeric_limits<double>::infinity(),
            .low = -1e3,
            .high = 1e3,
            .step = 1e-4,
            .reach = Reach::places}},
      .law = {.force_n = tether_force, .rate_1_s = tether_rate, .passing = true},
      .shapes = tether_places,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
