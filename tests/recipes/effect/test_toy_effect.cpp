#include <cmath>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/model/track_model.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("a glider with the toy effect alone swings as x_0 cos(sqrt(k/m) t)") {
  diagnose::TrackModel model;
  model.mass_kg = 0.4;
  model.x0_m = 0.3;
  model.effects[diagnose::slot_of("toy_effect")] = 2.5;
  std::vector<double> times;
  for (int i = 0; i <= 60; ++i) times.push_back(i / 100.0);
  const diagnose::Moved moved = diagnose::move(model, times);
  // Runge and Kutta's steps of 10 ms: (2.5 · 0.01)^4 a step's part.
  for (std::size_t i = 0; i < times.size(); ++i) {
    CHECK(moved.x_m[i] == Approx(0.3 * std::cos(2.5 * times[i])).margin(1e-7));
  }
  CHECK(diagnose::effect_of("toy_effect").words == "a spring along the whole track");
}
