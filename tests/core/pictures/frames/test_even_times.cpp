#include "core/pictures/frames/even_times.h"

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
