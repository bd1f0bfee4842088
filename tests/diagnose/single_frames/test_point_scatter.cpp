/// The scatter of single positions: what is left beside a curve, and the speed that it grows with.
#include "diagnose/single_frames/point_scatter.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kNoise = 3e-5;

/// Mean squares of what is left of the narrow and the wide points of 48 clips, and the largest error of a speed.
struct MeanSquares {
  double narrow = 0.0, wide = 0.0, off_m_s = 0.0;
};

/// Every third point has `wider` times the noise.
MeanSquares mean_squares(const tests::MadeEffect& effect, double wider) {
  MeanSquares mean;
  double narrow = 0.0, wide = 0.0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto made = tests::made_experiment(tests::made_launches({0.3, 0.4, 0.5, 0.6}), effect, seed, kNoise);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    std::mt19937_64 random(seed + 10);
    std::normal_distribution<double> more(0.0, kNoise * std::sqrt(wider * wider - 1.0));
    for (diagnose::TrackedMotion& motion : set.motions) {
      motion.sd_m = kNoise;
      if (wider == 1.0) continue;
      for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
        motion.wider.push_back(p % 3 == 0 ? wider : 1.0);
        if (p % 3 == 0) motion.x_m[p] += more(random);
      }
    }
    const diagnose::MotionFit fit = diagnose::fit_nominal(set);
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const diagnose::Leftover left = diagnose::leftover_of(set, fit, i);
      const diagnose::TrackedMotion& motion = set.motions[i];
      REQUIRE(left.over_sd.size() == motion.x_m.size());
      REQUIRE(left.v_m_s.size() == motion.x_m.size());
      for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
        if (motion.outlier[p] != 0) continue;
        (p % 3 == 0 ? mean.wide : mean.narrow) += left.over_sd[p] * left.over_sd[p];
        (p % 3 == 0 ? wide : narrow) += 1.0;
        if (p < 5 || p + 5 >= motion.x_m.size()) continue;
        const double v = (motion.x_m[p + 5] - motion.x_m[p - 5]) / (motion.t_s[p + 5] - motion.t_s[p - 5]);
        mean.off_m_s = std::max(mean.off_m_s, std::abs(v - left.v_m_s[p]));
      }
    }
  }
  mean.narrow /= narrow;
  mean.wide /= wide;
  return mean;
}

}  // namespace

TEST_CASE("what is left of white noise has a mean square of 1, beside a force that the law lacks too") {
  const tests::MadeEffect drag{.force = [](double, double, double v, double) { return -0.02 * v * std::abs(v); }};
  for (const bool lacking : {false, true}) {
    INFO((lacking ? "beside a drag" : "noise alone"));
    const MeanSquares mean = mean_squares(lacking ? drag : tests::MadeEffect{}, 1.0);
    // 7200 points in all, 150 a clip: the third of them has a standard deviation of sqrt(2 / 2400) = 0.029, and the
    // rest one of 0.020. A curve of 12 bumps on 150 points takes 8 %, which is what is given back.
    CHECK(std::abs(mean.narrow - 1.0) < 3.0 * 0.020);
    CHECK(std::abs(mean.wide - 1.0) < 3.0 * 0.029);
    // The slope over ten frames of 10 ms: a noise of 4e-4 m/s, four of these, and 1/6 of v'' (50 ms)², 0.005 m/s where
    // it is 10 m/s³, which a glider that turns under friction reaches.
    CHECK(mean.off_m_s < 0.02);
  }
}

TEST_CASE("what is left of positions of unequal noise is over the noise of each") {
  const MeanSquares mean = mean_squares({}, 2.0);
  // The curve takes h = 8 % of the mean variance, (4 + 1 + 1) / 3, from both: 1 - 2 h + 2 h and 4 - 8 h + 2 h, over
  // 1 - h; by chance as above.
  constexpr double kTaken = 0.08;
  CHECK(std::abs(mean.narrow - 1.0 / (1.0 - kTaken)) < 3.0 * 0.020 + 0.02);
  CHECK(std::abs(mean.wide - (1.0 - 1.5 * kTaken) / (1.0 - kTaken)) < 3.0 * 0.029 + 0.02);
}

namespace {

/// One motion at each of these rates; only their noise and their rates count.
diagnose::TrackSet at_rates(const std::vector<double>& rates_hz, double sd_m) {
  diagnose::TrackSet set;
  for (const double rate : rates_hz) {
    diagnose::TrackedMotion motion;
    motion.clip = set.clips.size();
    motion.sd_m = sd_m;
    set.motions.push_back(motion);
    set.clips.emplace_back().frame_rate_hz = rate;
  }
  return set;
}

/// Normal residuals of variance sd² + (v tau)², with speeds from 0 to 1 m/s.
diagnose::SpeedScatter scattered(const diagnose::TrackSet& set, double tau_s, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  diagnose::SpeedScatter scatter;
  const diagnose::TrackedMotion& motion = set.motions.front();
  for (std::size_t i = 0; i < count; ++i) {
    const double v = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    scatter.add(motion, i, normal(random) * std::hypot(1.0, tau_s * v / motion.sd_m), i % 2 == 0 ? v : -v);
  }
  return scatter;
}

/// The log likelihood of a jitter of which only the ratio to the noise, tau, counts, with the likeliest noise.
double profile(const diagnose::SpeedScatter& scatter, double tau_s) {
  double squares = 0.0, logs = 0.0;
  const auto n = static_cast<double>(scatter.squares.size());
  for (std::size_t i = 0; i < scatter.squares.size(); ++i) {
    const double variance = 1.0 + tau_s * tau_s * scatter.fast[i];
    squares += scatter.squares[i] / variance / n;
    logs += std::log(variance);
  }
  return -0.5 * (n * std::log(squares) + logs);
}

}  // namespace

TEST_CASE("a jitter is found with its likelihood from normal residuals, at the slowest clip's frame rate too") {
  constexpr double kSd = 1e-3, kTau = 3e-3;  // a third of a frame at 100 Hz, more than one at 400 Hz
  const diagnose::TrackSet set = at_rates({100.0, 400.0}, kSd);
  const diagnose::SpeedScatter scatter = scattered(set, kTau, 3000, 1);
  const diagnose::SpeedNoise found = diagnose::find_speed_noise(set, scatter, 1.0);
  double most = -1e300;
  for (double tau = 1e-4; tau < 2e-2; tau *= 1.001) most = std::max(most, profile(scatter, tau));
  const double gain = most - profile(scatter, 0.0);
  // Steps of 1.3 are at most 14 % from the best; a parameter known to 3 % is then 5 deviations off, 12 in the
  // logarithm.
  CHECK(found.gain <= gain + 1e-6);
  CHECK(found.gain > gain - 12.0);
  CHECK(std::abs(std::log(found.jitter_s / kTau)) < std::log(1.3));
  CHECK(found.sd_s == Approx(found.jitter_s / std::sqrt(2.0 * found.gain)).epsilon(1e-12));
  // Evidence is the mean likelihood over fewer than 30 steps, of which some are near the best.
  CHECK(found.log_evidence < found.gain);
  CHECK(found.log_evidence > found.gain - std::log(30.0));
  // Half the independent residuals, half the log likelihood.
  CHECK(diagnose::find_speed_noise(set, scatter, 0.5).gain == Approx(0.5 * found.gain).epsilon(0.15));
}

TEST_CASE("no jitter is found at rest, in few positions, and in images below what their blur causes") {
  const diagnose::TrackSet set = at_rates({100.0}, 1e-4);
  CHECK(diagnose::find_speed_noise(set, scattered(set, 1e-3, 49, 2), 1.0).gain == 0.0);
  CHECK(diagnose::find_speed_noise(set, scattered(set, 1e-3, 50, 2), 1.0).gain > 0.0);
  diagnose::SpeedScatter still = scattered(set, 1e-3, 3000, 3);
  std::fill(still.fast.begin(), still.fast.end(), 0.0);
  still.top_m_s = 0.0;
  CHECK(diagnose::find_speed_noise(set, still, 1.0).gain == 0.0);
  // 5 µs at up to 1 m/s beside a noise of 1 µm.
  diagnose::TrackSet small = at_rates({100.0}, 1e-6);
  const diagnose::SpeedScatter scatter = scattered(small, 5e-6, 3000, 4);
  CHECK(std::abs(std::log(diagnose::find_speed_noise(small, scatter, 1.0).jitter_s / 5e-6)) < std::log(1.3));
  small.images = true;
  const double filmed_s = diagnose::find_speed_noise(small, scatter, 1.0).jitter_s;
  CHECK((filmed_s == 0.0 || filmed_s >= diagnose::least_filmed_jitter_s(0.0)));
}

TEST_CASE("in images, jitter that moves a marker by less than its place in the pixel does is none") {
  diagnose::TrackSet set = at_rates({100.0}, 5e-6);
  set.images = true;
  const diagnose::SpeedScatter scatter = scattered(set, 15e-6, 3000, 5);  // up to 1 m/s
  set.motions[0].m_per_px = 1e-3;                                         // 0.015 px at 1000 px/s is 15 µs
  CHECK(diagnose::find_speed_noise(set, scatter, 1.0).jitter_s > 12e-6);
  set.motions[0].m_per_px = 2e-3;
  const double coarse_s = diagnose::find_speed_noise(set, scatter, 1.0).jitter_s;
  CHECK((coarse_s == 0.0 || coarse_s >= 0.015 / 500.0));
  set.motions[0].m_per_px = 0.5e-3;
  CHECK(std::abs(std::log(diagnose::find_speed_noise(set, scatter, 1.0).jitter_s / 15e-6)) < std::log(1.3));
}

TEST_CASE("a motion's scatter counts over the noise of its speed, and joins that of others") {
  diagnose::TrackedMotion motion;
  motion.sd_m = 2e-3;
  motion.wider = {1.0, 3.0};
  diagnose::SpeedScatter one, all;
  one.add(motion, 1, 0.5, -0.4);
  one.add(motion, 0, 2.0, 0.1);
  CHECK(one.squares == std::vector<double>{0.5 * 3.0 * (0.5 * 3.0), 4.0});
  REQUIRE(one.fast.size() == 2);
  CHECK(one.fast[0] == Approx(4e4).epsilon(1e-12));
  CHECK(one.fast[1] == Approx(2500.0).epsilon(1e-12));
  CHECK(one.top_m_s == 0.4);
  CHECK(one.widest == 3.0);
  all.add(motion, 0, 1.0, 0.7);
  all.add(one);
  CHECK(all.squares.size() == 3);
  CHECK(all.fast.size() == 3);
  CHECK(all.top_m_s == 0.7);
  CHECK(all.widest == 3.0);
}
