#include "diagnose/gap/gap_sizes.h"

#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;
using diagnose::ClipSquares;

namespace {

constexpr double kT2 = 4.302652729749464;  // Student's t, 0.975, 2 degrees

}  // namespace

TEST_CASE("interval over clips: of n clips of which one is unlike the others, the jackknife in closed form") {
  // T without the odd one is B, without any other A: se = (n - 1)/n |A - B|.
  const std::vector<ClipSquares> clips = {{100.0, 100.0}, {100.0, 100.0}, {1200.0, 300.0}};
  const double a = 0.5 * std::log(1300.0 / 400.0), all = 0.5 * std::log(1400.0 / 500.0);
  const auto interval = diagnose::rms_interval(clips);
  REQUIRE(interval);
  CHECK(interval->low == Approx(std::exp(all - kT2 * 2.0 / 3.0 * a)).epsilon(1e-12));
  CHECK(interval->high == Approx(std::exp(all + kT2 * 2.0 / 3.0 * a)).epsilon(1e-12));

  const std::vector<ClipSquares> before = {{900.0, 100.0}, {900.0, 100.0}, {2500.0, 100.0}};
  const std::vector<ClipSquares> after = {{121.0, 100.0}, {121.0, 100.0}, {121.0, 100.0}};
  const auto shrink = [](double was, double is) { return (was - is) / (was - 1.0); };
  const double without_odd = shrink(3.0, 1.1), without_other = shrink(std::sqrt(17.0), 1.1);
  const double half = kT2 * 2.0 / 3.0 * (without_other - without_odd);
  const auto shrinks = diagnose::shrink_interval(before, after);
  REQUIRE(shrinks);
  CHECK(shrinks->low == Approx(shrink(std::sqrt(43.0 / 3.0), 1.1) - half).epsilon(1e-12));
  CHECK(shrinks->high == Approx(shrink(std::sqrt(43.0 / 3.0), 1.1) + half).epsilon(1e-12));
}

TEST_CASE("interval over clips: clips that are alike leave nothing open, and a clip without points is none") {
  const std::vector<ClipSquares> alike = {{50.0, 100.0}, {0.0, 0.0}, {100.0, 200.0}, {25.0, 50.0}};
  const auto interval = diagnose::rms_interval(alike);
  REQUIRE(interval);
  CHECK(interval->low == Approx(std::sqrt(0.5)).epsilon(1e-12));
  CHECK(interval->high == Approx(std::sqrt(0.5)).epsilon(1e-12));
}

TEST_CASE("interval over clips: two clips have none, being too few, nor has a gap that rests on one clip") {
  const std::vector<ClipSquares> three = {{100.0, 100.0}, {90.0, 100.0}, {900.0, 100.0}};
  for (const std::size_t n : {0u, 1u, 2u}) {
    const std::vector<ClipSquares> few(three.end() - static_cast<std::ptrdiff_t>(n), three.end());
    CHECK_FALSE(diagnose::rms_interval(few));
    CHECK_FALSE(diagnose::shrink_interval(few, few));
    CHECK(diagnose::too_few_clips(n) == n);
  }
  CHECK_FALSE(diagnose::too_few_clips(3));
  CHECK(diagnose::rms_interval(three));
  CHECK_FALSE(diagnose::shrink_interval(three, three));  // without the third, the gap is below the floor
}

TEST_CASE("interval over clips: of eight clips that differ it holds the true gap 95 times in a hundred") {
  // Mean squares exp(0.4 z), mean exp(0.08). 4000 sets: 0.95 +- 0.0034 by chance, and the intervals of so few lopsided
  // numbers miss by one or two in a hundred.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  int held = 0;
  constexpr int kSets = 4000;
  for (int set = 0; set < kSets; ++set) {
    std::vector<ClipSquares> clips;
    for (int c = 0; c < 8; ++c) clips.push_back({100.0 * std::exp(0.4 * normal(random)), 100.0});
    const auto interval = diagnose::rms_interval(clips);
    REQUIRE(interval);
    held += interval->low < std::exp(0.04) && std::exp(0.04) < interval->high ? 1 : 0;
  }
  CHECK(std::abs(static_cast<double>(held) / kSets - 0.95) < 0.03);
}

TEST_CASE("the interval of a share is the jackknife of its own definition") {
  const std::vector<diagnose::ClipSquares> first = {{400, 100}, {500, 100}, {450, 100}, {380, 100}};
  const std::vector<diagnose::ClipSquares> before = {{300, 100}, {350, 100}, {320, 100}, {310, 100}};
  const std::vector<diagnose::ClipSquares> after = {{120, 100}, {140, 100}, {125, 100}, {150, 100}};
  const auto of = [&](std::size_t left_out) {
    double f = 0.0, b = 0.0, a = 0.0, n = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      if (c == left_out) continue;
      f += first[c].sum;
      b += before[c].sum;
      a += after[c].sum;
      n += 100.0;
    }
    return (b - a) / n / (f / n - 1.0);
  };
  double mean = 0.0, square = 0.0;
  for (std::size_t c = 0; c < 4; ++c) mean += of(c) / 4.0;
  for (std::size_t c = 0; c < 4; ++c) square += std::pow(of(c) - mean, 2);
  const double half = 3.182446 * std::sqrt(square * 3.0 / 4.0);  // t of three degrees of freedom
  const auto interval = diagnose::share_interval(first, before, after);
  REQUIRE(interval);
  CHECK(0.5 * (interval->low + interval->high) == Approx(of(4)).margin(1e-12));
  CHECK(0.5 * (interval->high - interval->low) ==
        Approx(half).epsilon(0.02));  // student_t975() is exact to 1 % at 3 degrees of freedom; twice that
  CHECK(!diagnose::share_interval(std::span(first).first(2), std::span(before).first(2), std::span(after).first(2)));
}

TEST_CASE("shares and shrinkage of an excess over a floor below 1 are those over 1 of gaps scaled by the floor") {
  constexpr double kFloor = 0.6;
  std::vector<diagnose::ClipSquares> first = {{900.0, 100.0}, {700.0, 100.0}, {1000.0, 100.0}, {800.0, 100.0}},
                                     before = {{500.0, 100.0}, {300.0, 100.0}, {450.0, 100.0}, {410.0, 100.0}},
                                     after = {{120.0, 100.0}, {150.0, 100.0}, {110.0, 100.0}, {130.0, 100.0}};
  const auto share = diagnose::share_interval(first, before, after), shrink = diagnose::shrink_interval(first, after);
  for (auto* of : {&first, &before, &after}) {
    for (diagnose::ClipSquares& clip : *of) clip.sum *= kFloor * kFloor;
  }
  const auto scaled = diagnose::share_interval(first, before, after, kFloor),
             scaled_shrink = diagnose::shrink_interval(first, after, kFloor);
  REQUIRE(share);
  REQUIRE(shrink);
  REQUIRE(scaled);
  REQUIRE(scaled_shrink);
  CHECK(scaled->low == Approx(share->low));
  CHECK(scaled->high == Approx(share->high));
  CHECK(scaled_shrink->low == Approx(shrink->low));
  CHECK(scaled_shrink->high == Approx(shrink->high));
}
