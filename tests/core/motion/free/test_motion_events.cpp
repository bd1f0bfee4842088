#include "core/motion/free/motion_events.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using core::EventKind;
using tests::Law;

namespace {

struct Scatter {
  double bias = 0.0, rms = 0.0, stated = 0.0;
  int found = 0, covered = 0;
};

Scatter scatter_of(const tests::SimulatedMotion& motion, double duration_s, double true_s, EventKind kind,
                   double near_s, int seeds, double noise_m = 5e-5) {
  Scatter sum;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto track = tests::film(motion, {200.0, duration_s, noise_m, static_cast<unsigned>(seed)});
    const auto event = core::estimate_event(track.t_s, track.x_m, kind, near_s, 0.12, {noise_m * noise_m});
    if (!event) continue;
    const double off = event->t_s - true_s;
    ++sum.found;
    sum.bias += off / seeds;
    sum.rms += off * off / seeds;
    sum.stated += event->sd_s / seeds;
    sum.covered += std::abs(off) < 1.96 * event->sd_s;
  }
  sum.rms = std::sqrt(sum.rms);
  return sum;
}

}  // namespace

TEST_CASE(
    "the time of a reversal is found from a start that is off by several frames, with a standard deviation that "
    "covers") {
  const Law law{4.3, 0.0071, 2.77};
  const double true_s = std::log(1.0 + 1.3 * law.k_1_s / law.a0(-1)) / law.k_1_s;  // where v = 0
  const auto motion = tests::launch(law, -1.3, 1.7);
  for (const double off_s : {-0.03, 0.0, 0.03}) {
    const Scatter found = scatter_of(motion, 1.7, true_s, EventKind::turns, true_s + off_s, 200);
    INFO("start off by " << off_s << " s: rms " << found.rms << " stated " << found.stated);
    CHECK(found.found == 200);
    // Binomial: 190 +- 3.1; three standard deviations, and one more for what the cubic leaves out.
    CHECK(found.covered >= 177);
    CHECK(std::abs(found.bias) < 0.5 * found.stated);
    CHECK(found.stated < 0.002);  // less than half a frame
  }
}

TEST_CASE("without noise the event's time, place and both accelerations are those of the closed form") {
  const Law law{4.3, 0.05, 0.0};  // no drag: parabolas, which the model holds exactly
  const auto motion = tests::launch(law, -1.3, 4.0);
  const double true_s = 1.3 / law.a0(-1);
  const auto track = tests::film(motion, {200.0, 4.0, 0.0, 1});
  const auto event = core::estimate_event(track.t_s, track.x_m, EventKind::turns, true_s + 0.017, 0.15, {0.0});
  REQUIRE(event);
  CHECK(std::abs(event->t_s - true_s) < 1e-9);  // rounding of x (1e-16) over a dt, with room for the conditioning
  CHECK(event->x_m == Approx(-0.5 * 1.3 * 1.3 / law.a0(-1)).epsilon(1e-9));
  CHECK(event->before_m_s2 == Approx(law.a0(-1)).epsilon(1e-6));
  CHECK(event->after_m_s2 == Approx(law.a0(1)).epsilon(1e-6));
}

TEST_CASE("the time at which a motion comes to rest is found") {
  const Law law{0.0, 0.0075, 2.88};
  const double v0 = 0.6, true_s = std::log(1.0 + v0 * law.k_1_s / law.friction()) / law.k_1_s;
  const auto motion = tests::launch(law, v0, 2.0);
  const Scatter found = scatter_of(motion, 2.0, true_s, EventKind::stops, true_s - 0.04, 200, 1e-5);
  INFO("rms " << found.rms << " stated " << found.stated << " bias " << found.bias);
  CHECK(found.found >= 190);
  CHECK(found.covered >= 170);
  CHECK(found.stated < 0.02);
}

TEST_CASE("where nothing turns there is no event") {
  const auto motion = tests::launch(Law{0.0, 0.005, 1.0}, 1.0, 1.0);
  const auto track = tests::film(motion, {200.0, 1.0, 1e-5, 1});
  CHECK_FALSE(core::estimate_event(track.t_s, track.x_m, EventKind::turns, 0.5, 0.12, {1e-10}));
  CHECK_FALSE(core::estimate_event(track.t_s, track.x_m, EventKind::turns, 0.001, 0.1, {1e-10}));  // no side before
}
