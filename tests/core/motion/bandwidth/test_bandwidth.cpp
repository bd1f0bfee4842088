#include "core/motion/bandwidth/rule_lines.h"

#include <cmath>

#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using tests::Law;

namespace {

const Law kInclined{4.3, 0.0071, 2.77};

core::ClipResult analyze(double noise_m, double rate_hz, unsigned seed, std::optional<double> bandwidth_s = {}) {
  const auto track = tests::film(tests::launch(kInclined, -1.3, 1.7), {rate_hz, 1.7, noise_m, seed});
  return core::analyze_motion(tests::clip_setup(core::Launched::up, 4.0), track,
                              core::MotionOptions{.bandwidth_s = bandwidth_s});
}

/// Mean square over 0 <= v <= 1.1 m/s of the error of both lines, over some clips: what the rule wants to be least.
double true_error(double noise_m, double rate_hz, std::optional<double> bandwidth_s) {
  double sum = 0.0;
  constexpr unsigned kClips = 30;
  for (unsigned seed = 1; seed <= kClips; ++seed) {
    for (const core::LineFit& line : analyze(noise_m, rate_hz, seed, bandwidth_s).segments) {
      const double k = line.k_over_m_1_s.value - kInclined.k_1_s;
      const double a0 = line.a0_m_s2.value - kInclined.a0(line.direction);
      const double top = line.direction < 0 ? -1.1 : 0.22;
      sum += a0 * a0 - top * a0 * k + top * top / 3.0 * k * k;
    }
  }
  return sum / kClips;
}

}  // namespace

TEST_CASE("a given bandwidth is used as it is") {
  const auto clip = analyze(1e-5, 200.0, 1, 0.043);
  CHECK(clip.bandwidth_s == 0.043);
  CHECK(std::holds_alternative<core::chosen_by::User>(clip.bandwidth_method));
}

TEST_CASE("where noise rules, the bandwidth found is nearly as good as the best one that knows the truth") {
  for (const auto& [noise_m, rate_hz] : {std::pair{5e-4, 240.0}, std::pair{2e-3, 60.0}}) {
    const double found = true_error(noise_m, rate_hz, {});
    double best = std::numeric_limits<double>::infinity();
    for (const double h : {0.02, 0.027, 0.036, 0.048, 0.064, 0.085}) {
      if (h > 1.2 / rate_hz) best = std::min(best, true_error(noise_m, rate_hz, h));
    }
    INFO("noise " << noise_m << " found " << found << " best " << best);
    // A mean of 30 squares of some 3 degrees of freedom each has a standard deviation of 15 %, and the minimum over h
    // is flat: 1.6 is 1.1 in theory and four standard deviations.
    CHECK(found < 1.6 * best);
  }
}

TEST_CASE("where noise is low, points become quiet at the price of a bias below half a percent") {
  for (const double noise_m : {5e-6, 1e-5}) {
    const auto clip = analyze(noise_m, 200.0, 3);
    REQUIRE(clip.segments.size() == 2);
    const auto& rule = std::get<core::chosen_by::LinesRule>(clip.bandwidth_method);
    CHECK(rule.line_s < clip.bandwidth_s);
    REQUIRE(rule.raised);
    CHECK(rule.raised->noise_share > 0.0);
    CHECK(rule.raised->bias_share <= 0.0035);  // as far as it is raised (rule_lines.h)
    for (const core::LineFit& line : clip.segments) {
      INFO("noise " << noise_m << " h " << clip.bandwidth_s << " R2 " << line.r2);
      CHECK(std::abs(line.k_over_m_1_s.value / kInclined.k_1_s - 1.0) < 0.005);
      CHECK(line.r2 >= 0.9996);  // the paper's own lines
    }
  }
}

TEST_CASE("more noise and fewer frames make the bandwidth wider, a faster law makes it narrower") {
  CHECK(analyze(1e-3, 200.0, 1).bandwidth_s > analyze(1e-4, 200.0, 1).bandwidth_s);
  CHECK(analyze(5e-4, 60.0, 1).bandwidth_s > analyze(5e-4, 1000.0, 1).bandwidth_s);
  const auto of_law = [](double k_1_s) {
    const auto track = tests::film(tests::launch({0.0, 0.004, k_1_s}, 0.8, 1.0), {500.0, 1.0, 1e-4, 5});
    const auto setup = tests::clip_setup(core::Launched::down, 0.0);
    return core::analyze_motion(setup, track, core::MotionOptions{}).bandwidth_s;
  };
  CHECK(of_law(6.0) < of_law(1.5));
}

namespace {

/// A glider that is launched near its terminal velocity: v changes by a tenth.
core::ClipResult analyze_slow(const Law& law, double v0_m_s, unsigned seed) {
  const auto track = tests::film(tests::launch(law, v0_m_s, 1.7), {200.0, 1.7, 2.6e-6, seed});
  return core::analyze_motion(tests::clip_setup(core::Launched::down, law.alpha_deg), track, core::MotionOptions{});
}

}  // namespace

TEST_CASE(
    "a glider launched near its terminal velocity gets a bandwidth whose bias its law allows, and lies on its line") {
  const Law slow{4.3, 0.004, 1.73};  // v_lim = 0.402 m/s
  for (const double ratio : {0.94, 1.04, 1.12}) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const auto clip = analyze_slow(slow, ratio * slow.v_lim(), seed);
      INFO(ratio << " v_lim, seed " << seed << ", h " << clip.bandwidth_s << " s");
      REQUIRE(clip.segments.size() == 1);
      const core::LineFit& line = clip.segments.front();
      // (k h)^2 / 2, the kernel's bias of a and so of K/m, is 2.4 % at the widest bandwidth that the clip allows.
      CHECK(0.5 * std::pow(slow.k_1_s * clip.bandwidth_s, 2) < 0.01);
      // chi^2 of some ten independent residuals: 2 standard deviations of noise are left by one clip in 1e6.
      CHECK(line.parts.scatter < 2.0);
    }
  }
}

TEST_CASE("where the slope of the law cannot be told from zero, the bandwidth is as wide as for a constant force") {
  const Law constant{0.05, 0.0, 0.0};
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const auto clip = analyze_slow(constant, 0.4, seed);
    // 2.5 bandwidths at either end: the clip has room for 0.34 s.
    CHECK(clip.bandwidth_s > 0.1);
  }
}
