#include "core/motion/smoothing/noise.h"

#include <cmath>
#include <random>

#include "tests/catch.h"

using namespace glidelab::core;

namespace {

std::vector<double> times(std::size_t count, double step) {
  std::vector<double> t(count);
  for (std::size_t i = 0; i < count; ++i) t[i] = static_cast<double>(i) * step;
  return t;
}

/// A smooth motion like the paper's, so that nothing but noise is left by smoothing it.
double place(double t) {
  return 0.24 * t - 0.4 * std::exp(-2.8 * t);
}

PositionNoise noise_of(const std::vector<double>& t, const std::vector<double>& x, double bandwidth_s) {
  const LocalCubic cubic(t, bandwidth_s);
  return estimate_noise({{&cubic, x}}, 1e-9);
}

}  // namespace

TEST_CASE("white noise on a smooth motion is found, and found to be white") {
  const auto t = times(2000, 0.005);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 2e-5);
  std::vector<double> x;
  for (const double time : t) x.push_back(place(time) + normal(random));
  // The standard deviation of a standard deviation of 2000 numbers is 1.6 %; the pilot uses the smaller half of
  // correlated fourth differences, four times less efficient.
  CHECK(pilot_noise(t, x) == Approx(2e-5).epsilon(0.13));
  for (const double h : {0.01, 0.02, 0.04}) {
    const PositionNoise noise = noise_of(t, x, h);
    CHECK(noise.sd_m == Approx(2e-5).epsilon(0.07));
    CHECK(noise.autocovariance.size() == 1);
  }
}

TEST_CASE("noise is rarely taken for correlated when it is white") {
  const auto t = times(400, 0.005);
  int correlated = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 2e-5);
    std::vector<double> x;
    for (const double time : t) x.push_back(place(time) + normal(random));
    correlated += noise_of(t, x, 0.02).autocovariance.size() > 1;
  }
  // At most 5 %; four standard deviations of a count of 15 in 300 above that are 30.
  CHECK(correlated <= 30);
}

TEST_CASE("correlated noise is found with its correlation, in spite of what the smoothing takes away") {
  const auto t = times(4000, 0.005);
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double rho = 0.6, white = 1e-5, part = 2e-5;
  std::vector<double> x;
  double state = normal(random);
  for (const double time : t) {
    x.push_back(place(time) + white * normal(random) + part * state);
    state = rho * state + std::sqrt(1.0 - rho * rho) * normal(random);
  }
  const PositionNoise noise = noise_of(t, x, 0.04);
  // 4000 numbers of correlation 0.6 are worth some 2000; variance and correlation within four of their sd of 3 %, and
  // the grid of rho.
  CHECK(noise.sd_m == Approx(std::hypot(white, part)).epsilon(0.06));
  REQUIRE(noise.autocovariance.size() > 3);
  CHECK(noise.autocovariance[1] / noise.autocovariance[0] == Approx(0.8 * rho).margin(0.12));
  CHECK(noise.autocovariance[2] / noise.autocovariance[0] == Approx(0.8 * rho * rho).margin(0.12));
}

TEST_CASE("rounded positions have at least the noise of their rounding, also where they rest") {
  const auto t = times(500, 0.01);
  const std::vector<double> resting(500, 0.42);
  CHECK(pilot_noise(t, resting) < 1e-15);  // a constant: nothing is known of its step, and rounding is all there is
  std::vector<double> flickering = resting;
  flickering[100] = flickering[101] = flickering[300] = 0.43;
  CHECK(pilot_noise(t, flickering) == Approx(0.01 / std::sqrt(12.0)).epsilon(1e-9));  // the step's uniform distribution
  std::vector<double> moving;
  for (const double time : t) moving.push_back(0.01 * std::round(100.0 * (0.4 * time + 0.05 * time * time)));
  const LocalCubic cubic(t, 0.1);
  const PositionNoise noise = estimate_noise({{&cubic, moving}}, pilot_noise(t, moving));
  // Rounding of a motion that crosses a step every few frames is uniform within the step; slower parts less so.
  CHECK(noise.sd_m == Approx(0.01 / std::sqrt(12.0)).epsilon(0.15));
}

TEST_CASE("marks at even distances, passed at measured times, are no rounded positions") {
  // A fall past light gates 0.25 m apart: t = sqrt(2 x / g).
  std::vector<double> t, x;
  for (int i = 0; i <= 12; ++i) {
    x.push_back(0.25 * i);
    t.push_back(std::sqrt(2.0 * x.back() / 9.81));
  }
  CHECK(rounding_step(x) == 0.0);
  CHECK(pilot_noise(t, x) < 0.01);  // rounding to 0.25 m would be 0.072 m
  x[5] = x[4];                      // one mark twice: rounded
  CHECK(rounding_step(x) == Approx(0.25));
}

TEST_CASE("counts of an encoder are rounded positions, with however few decimals their length was written") {
  constexpr double kCount_m = 5.47777e-4;
  std::vector<double> x;
  for (int i = 0; i < 214; ++i) {
    const double t = 0.005 * i, at = 0.1358 * (t - (1.0 - std::exp(-7.2 * t)) / 7.2);  // a motor that starts
    x.push_back(std::round(1e6 * kCount_m * std::floor(at / kCount_m)) / 1e6);
  }
  CHECK(rounding_step(x) == Approx(kCount_m).epsilon(1e-4));
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = std::round(1e6 * (x[i] + 1e-4 * static_cast<double>(i * i % 7))) / 1e6;
  CHECK(rounding_step(x) < 2e-6);  // micrometres, and no counts
}

TEST_CASE("outliers and impacts do not inflate the first figure of the noise") {
  const auto t = times(1000, 0.005);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 2e-5);
  std::vector<double> x;
  for (const double time : t) x.push_back(std::abs(0.5 * std::sin(3.0 * time)) + normal(random));
  for (std::size_t i = 50; i < 1000; i += 50) x[i] += 0.01;  // 2 % of the points, each seen by five neighbourhoods
  CHECK(pilot_noise(t, x) == Approx(2e-5).epsilon(0.3));     // the median of 90 % clean ones: 12 % up, and its own 10 %
}

TEST_CASE("the noise of a series with a long gap costs what its points cost, not what the gap would hold") {
  // 300 points of 1 ms each, 90 s apart from 300 more: the bandwidth of the gap's size is 10⁴ steps and more, and the
  // filter on a grid of such steps would have 10⁵ lags, whose products of all with all no test would wait for.
  std::vector<double> t, x;
  for (int i = 0; i < 600; ++i) {
    t.push_back(0.001 * i + (i < 300 ? 0.0 : 90.0));
    x.push_back(1e-4 * std::sin(12.9898 * i * i));
  }
  const PositionNoise noise = noise_of(t, x, 12.0);
  CHECK(std::isfinite(noise.sd_m));
  CHECK(noise.sd_m > 0.0);
}

namespace {

/// Four digits below 0.1 and three decimals above, as Tracker writes numbers by default.
double as_tracker_writes(double x) {
  if (std::abs(x) >= 0.1) return std::round(1e3 * x) / 1e3;
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(x))) - 3.0);
  return digit * std::round(x / digit);
}

}  // namespace

TEST_CASE("where the last digit grows with the number, each position has the step with which it is written") {
  const auto t = times(200, 0.02);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 5e-5);
  std::vector<double> x, reversed, in_mm, fixed, full;
  for (const double time : t) {
    const double at = 0.031 + 0.02 * time + 0.05 * time * time + normal(random);
    full.push_back(at);
    x.push_back(as_tracker_writes(at));
    reversed.push_back(-x.back());
    in_mm.push_back(0.1 * (10.0 * x.back()));  // a unit of decimetres
    fixed.push_back(std::round(1e4 * at) / 1e4);
  }
  for (const auto& of : {x, reversed, in_mm}) {
    const std::vector<double> steps = written_steps(of);
    REQUIRE(steps.size() == of.size());
    for (std::size_t i = 0; i < of.size(); ++i) {
      CHECK(steps[i] == Approx(std::abs(of[i]) < 0.0999999 ? 1e-5 : 1e-3).epsilon(1e-12));
    }
    CHECK(coarsest_step(of) == Approx(1e-3).epsilon(1e-12));
    CHECK(pilot_noise(t, of) >= 1e-3 / std::sqrt(12.0) * (1.0 - 1e-12));
  }
  for (const auto& of : {full, fixed}) {
    CHECK(written_steps(of).empty());
    CHECK(coarsest_step(of) == 0.0);
  }
  CHECK(pilot_noise(t, full) < 1e-4);
}

TEST_CASE("a few round numbers are not written more coarsely") {
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(0.903 + 0.001 * i);  // up to 1.002, and 1.000 among them
  CHECK(written_steps(x).empty());
  std::vector<double> rest = x;
  rest.insert(rest.end(), 50, 1.0);
  CHECK(written_steps(rest).empty());
  CHECK(written_steps(std::vector<double>{}).empty());
  CHECK(written_steps(std::vector<double>(40, 0.0)).empty());
}
