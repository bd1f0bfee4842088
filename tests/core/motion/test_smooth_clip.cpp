#include "core/motion/smooth_clip.h"

#include <cmath>
#include <map>
#include <string>

#include "base/errors.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/join_configurations.h"
#include "tests/catch.h"
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
    const ConfigurationResult found = join_configurations({kUp}, {clip}, tests::kGravity).front();
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
