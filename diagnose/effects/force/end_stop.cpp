/// A soft bumper at one end of the track, which pushes back with the force -k (x - x_b) beyond x_b. If x_b lies above
/// the middle of all positions, beyond means x > x_b; otherwise it means x < x_b.
#include "diagnose/effects/effect.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/effects/force/touching.h"

namespace glidelab::diagnose::effects {
namespace {

constexpr int kParts = 32;  // of the range of positions; x_b is tried in the middle of each

bool touches(double x_m, double stop_m, double middle_m) {
  return stop_m > middle_m ? x_m > stop_m : x_m < stop_m;
}

double stop_force(const double* p, const GliderConstants& glider, const GliderState& at) {
  return touches(at.x, p[1], glider.x_mid_all_m) ? -(p[0] * (at.x - p[1])) : 0.0;
}

double stop_rate(const double* p, double mass_kg) {
  return std::sqrt(std::max(0.0, p[0]) / mass_kg);
}

/// The outer quarter at either end: a bumper is short.
std::vector<double> stop_places(const ShapeReach& reach) {
  std::vector<double> places = places_of(reach, kParts);
  places.erase(places.begin() + kParts / 4, places.end() - kParts / 4);
  return places;
}

}  // namespace

EffectInfo end_stop() {
  return {
      .id = ids::end_stop,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a soft bumper at an end of the track",
      .name = "soft bumper",
      .meaning = "a force −k (x − x_b) beyond x_b",
      .search = Search::shape,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::in_one_place,
      .mirror = {.id = ids::tether, .beyond_middle = true},
      .among_clips = {},
      .point_scatter = {},
      .odds = touched,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "k_n_m",
                      .absent = 0.0,
                      .low = 0.0,
                      .high = 2000.0,
                      .step = 1e-5,
                      .reach = Reach::with_mass,
                      .open_ended = true},
                     {.key = "x_b_m",
                      .absent = std::numeric_limits<double>::infinity(),
                      .low = -1e3,
                      .high = 1e3,
                      .step = 1e-4,
                      .reach = Reach::places}},
      .law = {.force_n = stop_force, .rate_1_s = stop_rate, .passing = true},
      .shapes = stop_places,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
