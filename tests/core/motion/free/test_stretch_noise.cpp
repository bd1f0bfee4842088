#include "core/motion/free/stretch_noise.h"

#include <random>

#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

constexpr double kStep = 0.005;
constexpr double kNoise = 1e-5;

struct Track {
  std::vector<double> t, x;
  std::vector<double> v;
};

/// A motion that slows down from 2 m/s; its noise has the variance kNoise^2 (1 + growth v^2).
Track track(double growth, unsigned seed) {
  const auto motion = tests::launch({4.0, 0.006, 2.0}, 2.0, 1.5);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Track made;
  for (int i = 0; i < 300; ++i) {
    const double t = kStep * i, v = motion.v(t);
    made.t.push_back(t);
    made.v.push_back(v);
    made.x.push_back(motion.x(t) + kNoise * std::sqrt(1.0 + growth * v * v) * normal(random));
  }
  return made;
}

std::vector<double> factors_of(const Track& of) {
  const LocalCubic cubic(of.t, 0.03);
  const auto factors = speed_factors({{&cubic, of.x}});
  return factors.empty() ? std::vector<double>{} : factors.front();
}

}  // namespace

TEST_CASE("noise that grows with the speed is found with its factor, noise that does not hardly has one") {
  int found = 0;
  double ratio = 0.0, without = 0.0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto growing = factors_of(track(3.0, seed));
    if (!growing.empty()) {
      ++found;
      ratio += growing[20] / growing[280];
    }
    const auto even = factors_of(track(0.0, 1000 + seed));
    without += even.empty() ? 1.0 : even[20] / even[280];
  }
  // At v = 1.65 and 0.37 m/s: sqrt(1 + 3 v^2) is 3.03 and 1.19, 2.55 between them. Every fit is good to some 15 %; its
  // mean over 60 to 2 %, and a ratio of roots is biased by a few percent: 12 % in all.
  CHECK(found == 60);
  CHECK(std::abs(ratio / found / 2.55 - 1.0) < 0.12);
  // Without growth b is some z sd_b with z normal, and what is left of it max(0, z - 1/z) sd_b, 0.09 sd_b on average.
  // From 260 squares sd_b v^2 is 0.3 of s^2 at 1.65 m/s: 0.015 of s, known to 0.01 from 60 of them.
  CHECK(without / 60.0 < 1.05);
}

TEST_CASE("too few residuals and positions without noise have no factors") {
  Track few = track(3.0, 1);
  few.t.resize(60);
  few.x.resize(60);
  CHECK(factors_of(few).empty());
  Track exact = track(0.0, 1);
  std::fill(exact.x.begin(), exact.x.end(), 0.0);
  CHECK(factors_of(exact).empty());
}

TEST_CASE("a recording that is rounded coarsely keeps its ordinary lines, and says why") {
  const auto motion = tests::launch({2.0, 0.003, 0.1}, -0.9, 4.0);
  tests::Filming how;
  how.frame_rate_hz = 100.0;
  how.duration_s = 4.0;
  how.noise_m = 1e-4;
  how.rounding_m = 0.01;
  const auto setup = tests::clip_setup(Launched::up, 2.0);
  const ClipResult rounded = analyze_motion(setup, tests::film(motion, how),
                                            MotionOptions{.bandwidth_s = {}, .lines = LineMethod::generalised});
  REQUIRE(rounded.rounding_m);
  CHECK(std::abs(*rounded.rounding_m - 0.01) < 1e-12);  // a difference of two sums of 1e-16
  CHECK(rounded.segments.size() == 2);                  // the ordinary lines
  const auto* const instead = tests::note_of<CoarseRounding>(rounded.notes);
  REQUIRE(instead != nullptr);
  CHECK(instead->rounding_m == *rounded.rounding_m);
  CHECK(instead->instead_of_generalised);
  const ClipResult plain = analyze_motion(setup, tests::film(motion, how), MotionOptions{});
  CHECK(plain.segments.size() == 2);
  const auto* const said = tests::note_of<CoarseRounding>(plain.notes);
  REQUIRE(said != nullptr);
  CHECK_FALSE(said->instead_of_generalised);
  how.rounding_m = 1e-5;  // a tenth of the noise
  CHECK_FALSE(analyze_motion(setup, tests::film(motion, how), MotionOptions{}).rounding_m);
}
