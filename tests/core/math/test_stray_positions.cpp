#include "core/math/false_positions.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kStep_s = 0.02;
using Places = std::vector<std::size_t>;

struct Series {
  std::vector<double> t_s, x;
};

Series series(std::size_t many, const std::function<double(double)>& x) {
  Series made;
  for (std::size_t i = 0; i < many; ++i) {
    made.t_s.push_back(kStep_s * static_cast<double>(i));
    made.x.push_back(x(made.t_s.back()));
  }
  return made;
}

/// 100 positions of a body that is launched uphill at 1.2 m/s, slows down at 1 m/s² and returns.
Series up_and_down() {
  return series(100, [](double t) { return 1.2 * t - 0.5 * t * t; });
}

Series moved(Series of, std::size_t from, std::size_t to, double by) {
  for (std::size_t i = from; i < to; ++i) of.x[i] += by;
  return of;
}

Places range(std::size_t from, std::size_t to) {
  Places all;
  for (std::size_t i = from; i < to; ++i) all.push_back(i);
  return all;
}

Places stray_in(const Series& of) {
  const auto found = core::stray_positions(of.t_s, of.x);
  Places at;
  for (std::size_t i = 0; found && i < of.x.size(); ++i) {
    if (found->is_stray[i]) at.push_back(i);
  }
  if (found) CHECK(found->count == at.size());
  return at;
}

}  // namespace

TEST_CASE("a sensor that hears another object for a moment is left out while it does") {
  const Series run = up_and_down();
  CHECK(stray_in(run).empty());
  CHECK(stray_in(moved(run, 40, 45, 0.4)) == range(40, 45));
  CHECK(stray_in(moved(run, 40, 50, -0.4)) == range(40, 50));
  CHECK(stray_in(moved(moved(run, 20, 23, -0.2), 60, 66, 0.3)).size() == 9);
  Series wall = run;
  for (std::size_t i = 70; i < 75; ++i) wall.x[i] = 2.5;  // something at rest
  CHECK(stray_in(wall) == range(70, 75));
  const auto found = core::stray_positions(wall.t_s, wall.x);
  CHECK(found->from_s == Approx(70 * kStep_s));
  CHECK(found->off == Approx(2.5 - 0.5 * (wall.x[69] + wall.x[75])).epsilon(0.05));
}

TEST_CASE("single positions, pairs and scattered outliers are not runs") {
  const Series run = up_and_down();
  CHECK(stray_in(moved(run, 40, 41, 0.4)).empty());
  CHECK(stray_in(moved(run, 40, 42, 0.4)).empty());
  Series scattered = run;
  for (std::size_t i = 40; i < 44; ++i) scattered.x[i] += i % 2 == 0 ? 0.4 : -0.5;
  CHECK(stray_in(scattered).empty());
}

TEST_CASE("a shift for good leaves every position: nothing shows which part is right") {
  CHECK(stray_in(moved(up_and_down(), 50, 100, 0.15)).empty());
  CHECK(stray_in(moved(up_and_down(), 40, 55, 0.4)).empty());  // more than a tenth of the recording
  // The path does not go on where it ended: it is 0.2 m farther afterwards.
  CHECK(stray_in(moved(moved(up_and_down(), 40, 45, 0.4), 45, 100, 0.2)).empty());
}

TEST_CASE("at an end a short run behind a jump that no lost frames make is left out") {
  const Series run = up_and_down();
  CHECK(stray_in(moved(run, 0, 3, 0.5)) == range(0, 3));
  CHECK(stray_in(moved(run, 97, 100, -0.5)) == range(97, 100));
  CHECK(stray_in(moved(run, 99, 100, 0.5)) == range(99, 100));
  CHECK(stray_in(moved(run, 0, 10, 0.5)) == range(0, 10));  // far the shorter way
  // Eight lost frames at 1.2 m/s, the times being those of a file that numbers its frames.
  CHECK(stray_in(moved(run, 3, 100, 8 * 1.2 * kStep_s)).empty());
}

TEST_CASE("launches, impacts, rests, coarse digits and noise are no jumps") {
  const auto launched = [](double t) { return t < 1.7 ? 0.2 : 0.2 + 1.5 * (t - 1.7); };
  const auto hits = [](double t) { return t < 1.0 ? 1.5 * t : 1.5 - 0.6 * (t - 1.0); };
  const auto touched = [](double t) { return t < 1.0 || t > 1.1 ? 0.0 : 0.1; };
  for (const std::function<double(double)>& x : {std::function<double(double)>(launched), {hits}}) {
    CHECK(stray_in(series(100, x)).empty());
  }
  CHECK(stray_in(series(100, touched)).empty());  // too few steps to know a speed
  CHECK(stray_in(series(100, [](double t) { return 0.01 * std::round(5.0 * t); })).empty());
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    CHECK(
        stray_in(series(100, [&](double t) { return (k % 2 == 0 ? 1e-3 : 0.1) * noise(random) + 0.05 * t; })).empty());
  }
}

TEST_CASE("too short a series shows no strays") {
  CHECK(stray_in({}).empty());
  CHECK(stray_in(series(1, [](double t) { return t; })).empty());
  CHECK(stray_in(moved(series(8, [](double t) { return t; }), 3, 6, 1.0)).empty());
}

TEST_CASE("an echo behind which something else lies ends the motion, however long that is") {
  // A fall onto a motion sensor below it, in whole centimetres: 40 positions, an echo, and a hand for 20 more.
  const auto with_echo = [](double echo_m, std::size_t hand) {
    Series made = series(41 + hand, [&](double t) {
      const double fallen = t < 0.1 ? 0.0 : 0.5 * 5.0 * (t - 0.1) * (t - 0.1);
      return 0.01 * std::round(100.0 * (1.1 - fallen));
    });
    made.x[40] = echo_m;
    for (std::size_t i = 41; i < made.x.size(); ++i) made.x[i] = 1.07 + (i % 3 == 0 ? 0.01 : 0.0);
    return made;
  };
  CHECK(stray_in(with_echo(3.06, 20)) == range(40, 61));
  CHECK(stray_in(with_echo(10.0, 20)) == range(40, 61));
  CHECK(stray_in(with_echo(1.07, 20)) == range(40, 61));  // no echo in between
  CHECK(stray_in(with_echo(3.06, 60)) == range(40, 101));
  CHECK(core::stray_positions(with_echo(3.06, 20).t_s, with_echo(3.06, 20).x)->from_s == Approx(40 * kStep_s));
  // Before the motion as well.
  Series before = up_and_down();
  for (std::size_t i = 0; i < 10; ++i) before.x[i] = 3.0;
  CHECK(stray_in(before) == range(0, 10));
}

TEST_CASE("a single echo in the motion, a launch after a long rest and two motions end nothing") {
  Series single = up_and_down();
  single.x[40] = 3.0;
  CHECK(stray_in(single).empty());
  single.x[90] = 3.0;  // with nine positions behind it
  CHECK(stray_in(single).empty());
  const auto kicked = [](double t) { return t < 18.5 ? 1e-4 * std::sin(900.0 * t) : 2.0 * (t - 18.5); };
  CHECK(stray_in(series(1000, kicked)).empty());
  CHECK(stray_in(moved(up_and_down(), 30, 100, 3.0)).empty());  // ranges of 0.5 m and 0.3 m
  // A hand takes it 0.5 m away within a tenth of a second: 5 g.
  Series by_hand;
  for (int i = 0; i < 60; ++i) {
    by_hand.t_s.push_back(0.1 * i);
    by_hand.x.push_back(0.02 * i + (i >= 45 ? 0.5 : 0.0));
  }
  CHECK(stray_in(by_hand).empty());
}

TEST_CASE("positions that lie anywhere before the body is found and after it is lost are counted, and no others") {
  // x = 0.4 t² with noise of 0.5 mm; anywhere in a metre where it is not seen.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 5e-4);
  for (const auto& [before, after] : {std::pair{30, 25}, std::pair{12, 0}, std::pair{0, 40}}) {
    CAPTURE(before, after);
    std::vector<double> t_s, x;
    for (int i = -before; i < 140 + after; ++i) {
      t_s.push_back(i / 60.0);
      x.push_back(i < 0 || i >= 140 ? anywhere(random) : 0.2 + 0.4 * t_s.back() * t_s.back() / 4.0 + noise(random));
    }
    const auto ends = core::scattered_ends(t_s, x);
    REQUIRE(ends);
    CHECK(std::abs(static_cast<int>(ends->at_start) - before) <= 1);  // the last may lie near the body by chance
    CHECK(std::abs(static_cast<int>(ends->at_end) - after) <= 1);
  }
}

TEST_CASE("a coarse rounding, a bounce, outliers, a vibration and noise throughout scatter no end") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto ends_of = [](double rate_hz, const std::function<double(int, double)>& place) {
    std::vector<double> t_s, x;
    for (int i = 0; i < 400; ++i) {
      t_s.push_back(i / rate_hz);
      x.push_back(place(i, t_s.back()));
    }
    return core::scattered_ends(t_s, x);
  };
  // Fast at first, so that a step of the rounding comes at every third position, and slow later.
  CHECK_FALSE(
      ends_of(1000.0, [](int, double t) { return 1e-3 * std::round(1e3 * (1.0 - std::exp(-4.0 * t)) / 12.0); }));
  CHECK_FALSE(ends_of(500.0, [](int, double t) { return std::abs(t - 0.02); }));
  CHECK_FALSE(ends_of(60.0, [](int i, double t) { return 0.1 * t + (i == 2 ? 0.5 : 0.0); }));
  CHECK_FALSE(ends_of(1000.0, [](int, double t) { return 0.1 * t + (t < 0.1 ? 1e-3 * std::sin(600.0 * t) : 0.0); }));
  CHECK_FALSE(ends_of(60.0, [&](int, double t) { return 0.1 * t + 0.3 * noise(random); }));
  // A rest for most of the recording, then a motion in coarse steps.
  CHECK_FALSE(ends_of(240.0, [](int, double t) { return 6e-3 * std::round(std::max(0.0, t - 1.0) / 6e-3); }));
}
