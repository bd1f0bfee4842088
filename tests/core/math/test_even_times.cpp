#include "core/math/even_times.h"

#include <cmath>
#include <random>

#include "tests/catch.h"

using namespace glidelab::core;

namespace {

struct Stamping {
  double rate_hz, tick_s;
  double phase_s = 0.0;
  double jitter_s = 0.0;
  double drift = 0.0;  ///< of the rate, over the clip
  std::size_t frames = 480;
  std::vector<std::size_t> missing = {};
  bool cut_off = false;  ///< rounded down
};

struct Stamped {
  std::vector<double> true_s, stamps_s;
};

Stamped stamp(const Stamping& how) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Stamped made;
  double first = 0.0;
  for (std::size_t k = 0; k < how.frames; ++k) {
    const double jitter = how.jitter_s * normal(random);
    if (std::find(how.missing.begin(), how.missing.end(), k) != how.missing.end()) continue;
    const double part = static_cast<double>(k) / static_cast<double>(how.frames);
    const double t = how.phase_s + static_cast<double>(k) / how.rate_hz * (1.0 + how.drift * part) + jitter;
    const double ticks = how.cut_off ? std::floor(t / how.tick_s) : std::round(t / how.tick_s);
    if (made.true_s.empty()) first = ticks * how.tick_s;
    made.true_s.push_back(t);
    made.stamps_s.push_back(ticks * how.tick_s - first);
  }
  return made;
}

/// Largest difference of the times between frames: only those count.
double largest_error(const std::vector<double>& t_s, const std::vector<double>& true_s) {
  double mean = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) mean += (t_s[i] - true_s[i]) / static_cast<double>(t_s.size());
  for (std::size_t i = 0; i < t_s.size(); ++i) worst = std::max(worst, std::abs(t_s[i] - true_s[i] - mean));
  return worst;
}

}  // namespace

TEST_CASE(
    "rounded stamps of an even camera give its times to a fraction of the tick, its step in the interval stated") {
  const Stamping how =
      GENERATE(Stamping{240.0, 1.0 / 600.0, 0.0003}, Stamping{239.7, 1.0 / 600.0, 0.0011}, Stamping{30.0, 1e-3, 0.0004},
               Stamping{29.97, 1.0 / 600.0, 0.0007, 0.0, 0.0, 300}, Stamping{120.0, 1e-3, 0.0002, 2e-6},
               Stamping{240.0, 1.0 / 600.0, 0.0002, 0.0, 0.0, 480, {0, 17, 18, 200, 333}},
               Stamping{59.94, 1e-3, 0.0, 0.0, 0.0, 200, {50}, true});
  const Stamped made = stamp(how);
  const auto even = even_times(made.stamps_s);
  REQUIRE(even);
  CHECK(even->t_s.front() == 0.0);
  REQUIRE(even->t_s.size() == made.true_s.size());
  CHECK(even->tick_s == Approx(how.tick_s).epsilon(1e-6));
  CHECK(largest_error(even->t_s, made.true_s) < 0.4 * largest_error(made.stamps_s, made.true_s));
  // The true step is one of those that explain the stamps, but for what the jitter (six deviations) does at the ends.
  const double slack_s = 12.0 * how.jitter_s / static_cast<double>(how.frames) + 1e-12;
  CHECK(std::abs(even->step_s - 1.0 / how.rate_hz) <= even->half_width_s + slack_s);
  // Two ends that are off by half a tick each.
  CHECK(even->half_width_s <= how.tick_s / static_cast<double>(how.frames - how.missing.size()));
}

TEST_CASE(
    "stamps that jitter or drift by more than a part of their tick are taken at their word, and so are even ones") {
  CHECK_FALSE(even_times(stamp({240.0, 1.0 / 600.0, 0.0003, 1e-3}).stamps_s));
  CHECK_FALSE(even_times(stamp({60.0, 1e-3, 0.0003, 5e-4}).stamps_s));
  CHECK_FALSE(even_times(stamp({60.0, 1e-6, 0.0003, 5e-5}).stamps_s));
  // The rate falls by 1 % over the clip: 2 s / 4 * 1 % = 5 ms off a line in the middle.
  CHECK_FALSE(even_times(stamp({240.0, 1e-3, 0.0003, 0.0, 0.01}).stamps_s));
  CHECK_FALSE(even_times(stamp({200.0, 1e-3}).stamps_s));  // 5 ms: steps of one length
  CHECK_FALSE(even_times(stamp({240.0, 1.0 / 600.0, 0.0, 0.0, 0.0, 19}).stamps_s));
}

namespace {

/// n frames `interval` apart, as a table with so many places after the point has them.
std::vector<double> written(std::size_t n, double interval, int places, double start = 0.0) {
  std::vector<double> t;
  const double per_digit = std::pow(10.0, places);
  for (std::size_t i = 0; i < n; ++i) {
    t.push_back(std::round((start + interval * static_cast<double>(i)) * per_digit) / per_digit);
  }
  return t;
}

/// With so many significant digits.
double significant(double t, int digits) {
  if (t == 0.0) return 0.0;
  const double digit = std::pow(10.0, std::floor(std::log10(t)) - digits + 1);
  return std::round(t / digit) * digit;
}

}  // namespace

TEST_CASE("times that a table writes with few places are even to a fraction of the last one") {
  for (const double rate : {24.0, 29.97, 60.0, 119.88, 240.0}) {
    for (const int places : {4, 6}) {
      CAPTURE(rate, places);
      const std::vector<double> t = written(150, 1.0 / rate, places, 0.2);
      const std::optional<EvenTimes> even = even_times(t, StampSource::table);
      std::vector<double> exact;
      for (int i = 0; i < 150; ++i) exact.push_back(0.2 + i / rate);
      CHECK(largest_error(even ? even->t_s : t, exact) < 0.35 * std::pow(10.0, -places));
    }
  }
}

TEST_CASE("significant digits are understood, which are coarser from one second on") {
  std::vector<double> t, exact;
  for (int i = 0; i < 90; ++i) {
    exact.push_back(i / 30.0);
    t.push_back(significant(exact.back(), 4));
  }
  CHECK(largest_error(t, exact) > 2.5e-4);
  const std::optional<EvenTimes> even = even_times(t, StampSource::table);
  REQUIRE(even);
  CHECK(even->tick_s == Approx(1e-3));
  CHECK(largest_error(even->t_s, exact) < 1.5e-4);
}

TEST_CASE("significant digits of times below 0 are those of the same times above") {
  std::vector<double> t, exact;
  for (int i = 0; i < 75; ++i) {
    exact.push_back(-12.0 + i / 30.0);  // two digits before the point, then one
    t.push_back(-significant(-exact.back(), 4));
  }
  CHECK(largest_error(t, exact) > 2.5e-3);
  const std::optional<EvenTimes> even = even_times(t, StampSource::table);
  REQUIRE(even);
  CHECK(even->tick_s == Approx(1e-2));
  CHECK(largest_error(even->t_s, exact) < 1.5e-3);
}

TEST_CASE("uneven times, exact ones and whole frame numbers of a table stay as they are") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> uneven = written(100, 0.02, 4), exact, numbers;
  for (double& t : uneven) t = std::round((t + 3e-4 * normal(random)) * 1e4) / 1e4;  // by three digits
  for (int i = 0; i < 100; ++i) {
    exact.push_back(i / 60.0);
    numbers.push_back(i);
  }
  for (const std::vector<double>& t : {uneven, exact, numbers, written(100, 0.02, 3), written(100, 1.0 / 240.0, 2)}) {
    CHECK_FALSE(even_times(t, StampSource::table));
  }
}
