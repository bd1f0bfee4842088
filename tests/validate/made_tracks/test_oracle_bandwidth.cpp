#include "validate/made_tracks/oracle_bandwidth.h"

#include <cmath>

#include "core/motion/analyze_motion.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;

TEST_CASE("the best bandwidth for a motion with one x'''' everywhere is the asymptotic one") {
  // x = t^4 / 4!, x'''' = 1: bias h^2/2 and variance 0.2116 s^2 dt / h^5 are exact inside, and kernels are complete
  // there: six bandwidths are less than a tenth of the stretch.
  std::vector<double> t, x, a;
  for (int i = 0; i <= 2000; ++i) {
    t.push_back(0.005 * i);
    x.push_back(std::pow(t.back() - 5.0, 4) / 24.0);
    a.push_back(std::pow(t.back() - 5.0, 2) / 2.0);
  }
  const double variance = 1e-8;
  const double expected = std::pow(core::kGaussianA.best_h9() * variance * 0.005, 1.0 / 9.0);
  REQUIRE(6.0 * expected < 1.0);
  const auto best = validate::best_bandwidth({{t, x, a}}, {variance});
  REQUIRE(best);
  CHECK(best->bandwidth_s == Approx(expected).epsilon(2e-3));  // the search's last ratio is 1.001
  const double square = 0.25 * std::pow(expected, 4) + 0.2115711 * variance * 0.005 / std::pow(expected, 5);
  CHECK(best->mean_square_m2_s4 == Approx(square).epsilon(1e-4));  // the kernel's cut at 6 h, see local_polynomial.h
  CHECK(*validate::true_error({{t, x, a}}, {variance}, 1.2 * expected) > best->mean_square_m2_s4);
}

TEST_CASE("a stretch without points inside has no best bandwidth") {
  const std::vector<double> t{0.0, 0.1}, x{0.0, 0.0};
  CHECK_FALSE(validate::best_bandwidth({{t, x, x}}, {1.0}));
}

TEST_CASE("an acceleration's error is that of the points that count alone") {
  core::ClipResult clip;
  validate::TrueClip truth;
  for (int k = 0; k < 6; ++k) {
    core::MotionPoint point;
    point.a_m_s2 = 1.0 + (k % 2 == 0 ? 0.3 : -0.4);
    point.smoothed = k != 4;
    point.left_out = k == 5 ? core::LeftOut::kernel_end : core::LeftOut::used;
    if (k >= 4) point.a_m_s2 = 100.0;
    clip.motion.push_back(point);
    truth.a_m_s2.push_back(1.0);
  }
  // Twice 0.3 and twice 0.4: the root of (0.09 + 0.16) / 2, to rounding.
  CHECK(*validate::acceleration_error_m_s2(clip, truth) == Approx(std::sqrt(0.125)).epsilon(1e-13));
  for (core::MotionPoint& point : clip.motion) point.smoothed = false;
  CHECK_FALSE(validate::acceleration_error_m_s2(clip, truth));
}

TEST_CASE("with the best bandwidth a(t) is nearer the truth than with half or twice of it, over many noises") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", tests::kSweptScenario);
  const validate::MadeTracks clean = validate::make_tracks(render::read_scenario(dir / "s.toml"), 1);
  double best = 0.0, half = 0.0, twice = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const validate::MadeTracks made = validate::with_noise(clean, 1e-4, seed);
    const core::ClipResult clip = validate::with_best_bandwidths(made).clips.front();
    const auto square = [&](double factor) {
      const core::MotionOptions how{.bandwidth_s = factor * clip.bandwidth_s};
      return std::pow(*validate::acceleration_error_m_s2(core::analyze_motion(made.setups[0], made.tracks[0], how),
                                                         clean.truth.clips[0]),
                      2);
    };
    best += square(1.0);
    half += square(0.5);
    twice += square(2.0);
  }
  // At h* bias² : variance = 5 : 4 (the minimum of b h^4 + c / h^5). Half of it: variance 32-fold, so 14 times the sum;
  // twice: bias² 16-fold, 8.9 times. Ends and the estimated noise take from that; a third of it is left at least.
  CHECK(half > 14.0 / 3.0 * best);
  CHECK(twice > 8.9 / 3.0 * best);
}
