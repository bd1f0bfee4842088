#include "core/motion/smooth_clip.h"

#include <Eigen/Dense>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;
using tests::Law;

namespace {

const Law kInclined{4.3, 0.0071, 2.77};
const ClipSetup kUp = tests::clip_setup(Launched::up, 4.0);

MotionOptions by(const std::string& smoother) {
  MotionOptions options;
  options.smoother = smoother;
  return options;
}

/// Root mean square error of a in the frames of the lines.
double error_of_a(const ClipResult& clip, const tests::SimulatedMotion& motion) {
  double squares = 0.0, count = 0.0;
  for (const MotionPoint& point : clip.motion) {
    if (point.left_out != LeftOut::used) continue;
    const double v = motion.v(point.t_s);
    squares += std::pow(point.a_m_s2 - (kInclined.a0(v > 0.0 ? 1 : -1) - kInclined.k_1_s * v), 2);
    count += 1.0;
  }
  return std::sqrt(squares / count);
}

}  // namespace

TEST_CASE("smoothers that find their own strength know a better than the local cubic, and tell how they smoothed") {
  const tests::Filming how{200.0, 1.7, 1e-4, 4};
  const auto motion = tests::launch(kInclined, -1.3, how.duration_s);
  const TrackData track = tests::film(motion, how);
  const double local = error_of_a(analyze_motion(kUp, track, MotionOptions{}), motion);
  for (const std::string smoother : {"kalman", "spline"}) {
    CAPTURE(smoother);
    const ClipResult clip = analyze_motion(kUp, track, by(smoother));
    CHECK(error_of_a(clip, motion) < 0.6 * local);  // a third of it on the mean of many clips
    REQUIRE(clip.strength);
    CHECK(clip.strength->smoother == smoother);
    CHECK(clip.strength->time_s > 0.01);
    CHECK(clip.strength->order >= 3);
    CHECK(clip.strength->noise_sd_m == Approx(1e-4).epsilon(0.15));  // 300 points: sd 4 %
    REQUIRE(clip.strength->breaks_s.size() == 1);
    CHECK(std::abs(motion.v(clip.strength->breaks_s[0])) < 5e-3);
    CHECK(clip.strength->simultaneous_a.value() > 1.96);
    CHECK(clip.strength->simultaneous_a.value() < 6.0);
    CHECK(clip.segments.size() == 2);
    for (const MotionPoint& point : clip.motion) CHECK(point.smoothed);
  }
  CHECK_FALSE(analyze_motion(kUp, track, MotionOptions{}).strength);
}

TEST_CASE("95 % intervals of lines by other smoothers hold the truth in 95 % of simulated clips", "[slow]") {
  const std::string smoother = GENERATE("kalman", "spline");
  constexpr unsigned kClips = 150;
  std::map<std::string, int> inside;
  for (unsigned seed = 1; seed <= kClips; ++seed) {
    const tests::Filming how{200.0, 1.7, 1e-4, seed};
    const auto motion = tests::launch(kInclined, -1.3 + 0.0007 * seed, how.duration_s);
    const ClipResult clip = analyze_motion(kUp, tests::film(motion, how), by(smoother));
    const ConfigurationResult found = configurations_of_clips({kUp}, {clip}, tests::kGravity).front();
    const auto count = [&](const std::string& name, const Quantity& quantity, double truth) {
      REQUIRE(quantity.estimate);
      inside[name] += quantity.estimate->low95 <= truth && truth <= quantity.estimate->high95;
    };
    count("K/m", found.k_over_m_1_s, kInclined.k_1_s);
    count("mu", found.mu, kInclined.mu);
    count("alpha", found.alpha_deg, kInclined.alpha_deg);
    count("v_lim", found.v_lim_m_s, kInclined.v_lim());
  }
  for (const auto& [name, count] : inside) {
    CAPTURE(smoother, name);
    // Binomial, 150 of 0.95: fewer than 134 has a probability of 2e-3.
    CHECK(count >= 134);
  }
}

namespace {

ConfigurationResult recovered(const Law& law, const tests::Filming& how, const std::string& smoother) {
  const ClipResult clip = analyze_motion(kUp, tests::film(tests::launch(law, -1.0, how.duration_s), how), by(smoother));
  return configurations_of_clips({kUp}, {clip}, tests::kGravity).front();
}

/// The Cramér-Rao bound of K/m for white noise, by finite differences of the closed form in alpha, mu, K/m, v_0, x_0.
double least_sd_of_k(const Law& law, const tests::Filming& how) {
  const auto positions = [&](const Law& of, double v_m_s) {
    return tests::film(tests::launch(of, v_m_s, how.duration_s), {how.frame_rate_hz, how.duration_s, 0.0, 1}).x_m;
  };
  constexpr double kStep = 1e-4;
  const auto moved = [&](double sign) {
    const double by = sign * kStep;
    return std::vector{positions({law.alpha_deg, law.mu, law.k_1_s + by}, -1.0),
                       positions({law.alpha_deg + by, law.mu, law.k_1_s}, -1.0),
                       positions({law.alpha_deg, law.mu + by, law.k_1_s}, -1.0), positions(law, -1.0 + by)};
  };
  const auto above = moved(1.0), below = moved(-1.0);
  const auto n = static_cast<Eigen::Index>(above[0].size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Ones(n, 5);  // the last column: x_0
  for (Eigen::Index c = 0; c < 4; ++c) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto p = static_cast<std::size_t>(i);
      jacobian(i, c) = (above[static_cast<std::size_t>(c)][p] - below[static_cast<std::size_t>(c)][p]) / (2.0 * kStep);
    }
  }
  return how.noise_m * std::sqrt(Eigen::MatrixXd((jacobian.transpose() * jacobian).inverse())(0, 0));
}

/// Root mean squares of z = (value - truth) / sd over the clips, and the mean sd of K/m.
void check_z(const std::string& smoother, int clips) {
  CAPTURE(smoother, clips);
  std::map<std::string, double> squares;
  double sd_of_k = 0.0;
  for (unsigned seed = 1; seed <= static_cast<unsigned>(clips); ++seed) {
    const ConfigurationResult found = recovered(kInclined, {200.0, 2.0, 5e-5, seed}, smoother);
    const auto add = [&](const std::string& name, const Quantity& quantity, double truth) {
      REQUIRE(quantity.estimate);
      squares[name] += std::pow((quantity.estimate->value - truth) / quantity.estimate->sd, 2) / clips;
    };
    add("K/m", found.k_over_m_1_s, kInclined.k_1_s);
    add("mu", found.mu, kInclined.mu);
    add("alpha", found.alpha_deg, kInclined.alpha_deg);
    add("v_lim", found.v_lim_m_s, kInclined.v_lim());
    sd_of_k += found.k_over_m_1_s.estimate->sd / clips;
  }
  const double band = 3.0 / std::sqrt(2.0 * clips);  // three standard deviations of a root mean square z
  for (const auto& [name, sum] : squares) {
    CAPTURE(name);
    CHECK(std::sqrt(sum) == Approx(1.0).margin(band));
  }
  // The sd goes with the noise, and without noise it is small: smoothing leaves nothing of the law's own motion.
  const double quiet = recovered(kInclined, {200.0, 2.0, 5e-6, 1}, smoother).k_over_m_1_s.estimate->sd;
  CHECK(sd_of_k / quiet == Approx(10.0).epsilon(0.3));
  const Estimate exact = *recovered(kInclined, {200.0, 2.0, 0.0, 1}, smoother).k_over_m_1_s.estimate;
  CHECK(std::abs(exact.value - kInclined.k_1_s) < 1e-3);
  CHECK(exact.sd < 1e-3);
}

/// `least`: the fewest intervals that must hold.
void check_small_rate(const std::string& smoother, double k_1_s, int clips, int least_held) {
  CAPTURE(smoother, k_1_s);
  const Law law{4.3, 0.0071, k_1_s};
  const double least = least_sd_of_k(law, {200.0, 2.0, 5e-5, 1});
  int hold = 0;
  for (unsigned seed = 1; seed <= static_cast<unsigned>(clips); ++seed) {
    const ConfigurationResult found = recovered(law, {200.0, 2.0, 5e-5, seed}, smoother);
    CAPTURE(seed);
    CHECK(found.lines.size() == 2);  // also where each direction has one a, known better where the motion lasts longer
    REQUIRE(found.k_over_m_1_s.estimate);
    const Estimate& k = *found.k_over_m_1_s.estimate;
    hold += k.low95 <= k_1_s && k_1_s <= k.high95;
    CHECK(k.sd > 0.5 * least);
    CHECK(k.sd < 6.0 * least);
    REQUIRE(found.mu.estimate);
    CHECK(found.mu.estimate->sd < 1e-3);
  }
  CHECK(hold >= least_held);
}

}  // namespace

TEST_CASE("standard deviations of K/m, mu and alpha by a Kalman smoother are those of their errors") {
  check_z("kalman", 12);
}

TEST_CASE("standard deviations of K/m, mu and alpha by other smoothers are those of their errors", "[slow]") {
  check_z("kalman", 100);
  check_z("spline", 100);
}

TEST_CASE("a K/m so small that the smoothed motion has no rate has the uncertainty of one with a rate") {
  // Binomial, 6 of 0.95: fewer than 4 has a probability of 2e-3.
  check_small_rate("kalman", GENERATE(0.0, 0.001), 6, 4);
}

TEST_CASE("K/m so small that motions have no rate has the uncertainty of one with a rate by every smoother", "[slow]") {
  // Binomial, 40 of 0.95: fewer than 33 has a probability of 2e-3.
  check_small_rate(GENERATE("kalman", "spline"), GENERATE(0.0, 0.0005, 0.001, 0.002), 40, 33);
}

TEST_CASE("both directions have a line where a is constant in each, however long they last", "[slow]") {
  const std::string smoother = GENERATE("kalman", "spline");
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CAPTURE(smoother, seed);
    CHECK(recovered({4.3, 0.0071, 0.0}, {200.0, 2.0, 5e-5, 700 + seed}, smoother).lines.size() == 2);
  }
}

TEST_CASE("a fall at its terminal speed gives no K/m that is tight by chance") {
  // Quadratic drag from rest, x = v^2/g log cosh(g t/v): a(v) has the slope 2 g/v = 15 1/s at the end.
  constexpr double kLimit_m_s = 1.3;
  const std::string smoother = GENERATE("kalman", "spline");
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 5e-4);
    TrackData track;
    track.frame_rate_hz = 60.0;
    for (std::size_t i = 0; i < 73; ++i) {
      const double t = static_cast<double>(i) / 60.0;
      track.t_s.push_back(t);
      track.x_m.push_back(kLimit_m_s * kLimit_m_s / tests::kGravity *
                              std::log(std::cosh(tests::kGravity * t / kLimit_m_s)) +
                          noise(random));
      track.frame.push_back(i);
    }
    track.frame_t_s = track.t_s;
    ClipSetup fall = tests::clip_setup(Launched::unknown, 90.0, 0.002);
    fall.start_s = 0.43;  // 99.5 % of the terminal speed
    const ClipResult clip = analyze_motion(fall, track, by(smoother));
    const Quantity k = configurations_of_clips({fall}, {clip}, tests::kGravity).front().k_over_m_1_s;
    CAPTURE(smoother, seed);
    if (k.estimate) CHECK(k.estimate->high95 - k.estimate->low95 > 3.0);
  }
}

TEST_CASE("a motion at one speed gives no line, because the speed hardly changes") {
  TrackData track;
  track.frame_rate_hz = 200.0;
  for (std::size_t i = 0; i < 400; ++i) {
    track.t_s.push_back(static_cast<double>(i) / 200.0);
    track.x_m.push_back(0.3 * track.t_s.back());
    track.frame.push_back(i);
  }
  track.frame_t_s = track.t_s;
  const ClipSetup down = tests::clip_setup(Launched::down, 4.0);
  for (const std::string smoother : {"local-polynomial", "kalman", "spline"}) {
    CAPTURE(smoother);
    const ClipResult clip = analyze_motion(down, track, by(smoother));
    const ConfigurationResult found = configurations_of_clips({down}, {clip}, tests::kGravity).front();
    for (const Quantity* quantity : {&found.k_over_m_1_s, &found.mu, &found.alpha_deg, &found.v_lim_m_s}) {
      CHECK(tests::reason_of<unknown::SpeedHardlyChanges>(*quantity) != nullptr);
    }
  }
}

TEST_CASE("a smoother without a bandwidth refuses a bandwidth, a rule and generalised lines") {
  MotionOptions options = by("kalman");
  CHECK_NOTHROW(check_smoothing(options));
  options.bandwidth_rule = "rsc";
  CHECK_THROWS_AS(check_smoothing(options), base::InputError);
  options = by("spline");
  options.bandwidth_s = 0.03;
  CHECK_THROWS_AS(check_smoothing(options), base::InputError);
  options = by("kalman");
  options.lines = LineMethod::generalised;
  CHECK_THROWS_AS(check_smoothing(options), base::InputError);
  CHECK_THROWS_AS(check_smoothing(by("lowess")), base::InputError);
}
