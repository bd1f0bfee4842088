// Repeated frames, found from motions whose images are known: x(t) at the camera's times, shown by a file that repeats
// some of them.
#include "core/math/frame_repeats.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

struct Film {
  std::vector<std::size_t> frame, source;  ///< of each frame of the file, that of the camera
  std::vector<double> x;
};

double slowing(double t_s) {
  return 0.3 + 1.2 * t_s - 0.25 * t_s * t_s;
}

/// A converter shows the newest image of the camera; the file has `q` times fewer images than frames.
Film converted(double q, double phase, std::size_t frames, double noise = 0.0, unsigned seed = 1) {
  constexpr double kFile_hz = 60.0;
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Film film;
  for (std::size_t f = 0; f < frames; ++f) {
    const auto source = static_cast<std::size_t>(std::floor(q * static_cast<double>(f) + phase));
    film.frame.push_back(f);
    const bool repeats = f > 0 && film.source.back() == source;
    film.source.push_back(source);
    film.x.push_back(repeats ? film.x.back()
                             : slowing(static_cast<double>(source) / (q * kFile_hz)) + noise * normal(engine));
  }
  return film;
}

/// A recorder repeats the frame before in place of those of `lost`.
Film filled(const std::vector<std::size_t>& lost, std::size_t frames, double noise, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  Film film;
  for (std::size_t f = 0; f < frames; ++f) {
    film.frame.push_back(f);
    const bool repeats = std::ranges::binary_search(lost, f);
    film.source.push_back(repeats ? film.source.back() : f);
    film.x.push_back(repeats ? film.x.back() : slowing(static_cast<double>(f) / 60.0) + noise * normal(engine));
  }
  return film;
}

std::vector<std::size_t> repeats_of(const Film& film) {
  std::vector<std::size_t> repeats;
  for (std::size_t f = 1; f < film.frame.size(); ++f) {
    if (film.source[f] == film.source[f - 1]) repeats.push_back(f);
  }
  return repeats;
}

/// How far the corrected times of frames that repeat nothing are from the camera's, up to a constant, in frames.
double spread_of_times(const Film& film, const core::FrameRepeats& found, double q) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t f = 1; f < film.frame.size(); ++f) {
    if (film.source[f] == film.source[f - 1] || std::ranges::binary_search(found.points, f)) continue;
    const double off =
        static_cast<double>(f) - found.cadence->early_frames(f) - static_cast<double>(film.source[f]) / q;
    least = std::min(least, off);
    most = std::max(most, off);
  }
  return most - least;
}

}  // namespace

TEST_CASE("of a film that a converter brought to a higher rate, the repeats and the camera's times are found") {
  // 24 to 30 and 25 to 30 frames per second, 60 to 75, 30 to 120, 24 to 60.
  const double q = GENERATE(0.8, 5.0 / 6.0, 0.25, 0.4);
  const double phase = GENERATE(0.05, 0.55, 0.95);
  const Film film = converted(q, phase, 110);
  const auto found = core::frame_repeats(film.frame, film.x);
  REQUIRE(found);
  CHECK_FALSE(found->in_place_of_lost);
  REQUIRE(found->cadence);
  CAPTURE(q, phase, found->cadence->rate_ratio);
  CHECK(found->points == repeats_of(film));
  CHECK(found->cadence->rate_ratio == Approx(q).epsilon(1e-12));
  CHECK(spread_of_times(film, *found, q) < 1e-9);
}

TEST_CASE(
    "a cadence holds where the body is too slow for its repeats to be seen, and at ratios that are no simple "
    "fraction") {
  const double q = 0.8137;
  // 1.2 m/s down to 0.2 m/s at 60 frames per second: 20 to 3.3 mm a frame.
  const Film film = converted(q, 0.3, 120, 0.8e-3, 7);
  const auto found = core::frame_repeats(film.frame, film.x);
  REQUIRE(found);
  REQUIRE(found->cadence);
  // 22 repeats in 120 frames place the cadence to a small part of a frame; one at the edge of its image may go either
  // way where the body is slow.
  CHECK(spread_of_times(film, *found, q) < 0.1);
  CHECK(found->points.size() == repeats_of(film).size());
}

TEST_CASE("frames that a recorder repeats in place of lost ones are found one by one, and their times stay") {
  const unsigned seed = GENERATE(range(1U, 9U));
  std::mt19937 engine(seed);
  std::vector<std::size_t> lost;
  for (std::size_t f = 5; f < 100; f += 4 + engine() % 15) lost.push_back(f);
  const Film film = filled(lost, 110, 0.1e-3, seed);
  const auto found = core::frame_repeats(film.frame, film.x);
  REQUIRE(found);
  CHECK(found->in_place_of_lost);
  CHECK_FALSE(found->cadence);
  CHECK(found->points == repeats_of(film));
}

TEST_CASE("frames that are repeated at no even intervals have no cadence") {
  Film film = converted(1.0, 0.0, 120);
  for (const std::size_t at : {12U, 17U, 40U, 44U, 90U, 99U}) {
    film.x.insert(film.x.begin() + at, film.x[at - 1]);
    film.x.pop_back();
  }
  const auto found = core::frame_repeats(film.frame, film.x);
  REQUIRE(found);
  CHECK(found->points == std::vector<std::size_t>{12, 17, 40, 44, 90, 99});
  CHECK_FALSE(found->in_place_of_lost);
  CHECK_FALSE(found->cadence);
}

namespace {

std::vector<std::size_t> numbers(std::size_t n) {
  std::vector<std::size_t> frame(n);
  std::iota(frame.begin(), frame.end(), std::size_t{0});
  return frame;
}

}  // namespace

TEST_CASE("no frame is taken for a repeat of its predecessor where none is") {
  constexpr std::size_t kFrames = 240;
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto none = [](const std::vector<double>& x) { return !core::frame_repeats(numbers(x.size()), x); };

  SECTION("under noise, at speeds from rest to fifty standard deviations a frame and back") {
    std::size_t taken = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
      std::mt19937 engine(seed);
      std::vector<double> x;
      for (std::size_t f = 0; f < kFrames; ++f) {
        const double t = static_cast<double>(f) / 240.0;
        x.push_back(12000.0 * t * (1.0 - t) * 0.25 + normal(engine));
      }
      taken += none(x) ? 0 : 1;
    }
    CHECK(taken == 0);
  }
  SECTION("in positions rounded to a step, at any speed") {
    for (double per_frame = 0.05; per_frame < 6.0; per_frame += 0.0371) {
      std::vector<double> x;
      for (std::size_t f = 0; f < kFrames; ++f) x.push_back(std::round(per_frame * static_cast<double>(f) + 0.31));
      CAPTURE(per_frame);
      CHECK(none(x));
    }
  }
  SECTION("of a body that starts from rest, turns, or stops") {
    for (const double noise : {0.0, 1e-5}) {
      std::mt19937 engine(5);
      std::vector<double> starts, turns, stops;
      for (std::size_t f = 0; f < kFrames; ++f) {
        const double t = static_cast<double>(f) / 60.0;
        starts.push_back(0.4 * std::pow(std::max(0.0, t - 0.5), 2) + noise * normal(engine));
        turns.push_back(0.8 * t - 0.4 * t * t + noise * normal(engine));
        stops.push_back(0.8 * std::min(t, 2.0) - 0.2 * std::pow(std::min(t, 2.0), 2) + noise * normal(engine));
      }
      CHECK(none(starts));
      CHECK(none(turns));
      CHECK(none(stops));
    }
  }
  SECTION("where frames are lost without a trace, or the camera shakes") {
    std::vector<double> lost, shaken;
    for (std::size_t f = 0; f < kFrames; ++f) {
      lost.push_back(static_cast<double>(f + f / 20 + f / 33));
      shaken.push_back(static_cast<double>(f) + 0.45 * std::sin(2.1 * static_cast<double>(f)));
    }
    CHECK(none(lost));
    CHECK(none(shaken));
  }
  SECTION("with two repeats, which chance may make, and without points") {
    std::vector<double> x;
    for (std::size_t f = 0; f < kFrames; ++f) x.push_back(static_cast<double>(f));
    x[50] = x[49];
    x[80] = x[79];
    CHECK(none(x));
    CHECK(none({}));
    CHECK(none({1.0}));
  }
}
