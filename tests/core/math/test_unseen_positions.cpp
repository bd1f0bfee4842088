#include "core/math/false_positions.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kStep_s = 0.05;

struct Series {
  std::vector<double> t_s, x;
};

/// Positions at even times, in whole steps of `digit_m` if that is above 0.
Series series(std::size_t many, const std::function<double(double)>& x, double digit_m = 0.0) {
  Series made;
  for (std::size_t i = 0; i < many; ++i) {
    made.t_s.push_back(kStep_s * static_cast<double>(i));
    const double at = x(made.t_s.back());
    made.x.push_back(digit_m > 0.0 ? digit_m * std::round(at / digit_m) : at);
  }
  return made;
}

/// Indices of the unseen ones.
std::vector<std::size_t> unseen_in(const Series& of) {
  const auto found = core::unseen_positions(of.t_s, of.x);
  std::vector<std::size_t> at;
  for (std::size_t i = 0; found && i < of.x.size(); ++i) {
    if (found->is_unseen[i]) at.push_back(i);
  }
  if (found) CHECK(found->count == at.size());
  return at;
}

Series with(Series of, const std::vector<std::size_t>& at, double value) {
  for (const std::size_t i : at) of.x[i] = value;
  return of;
}

using Places = std::vector<std::size_t>;

}  // namespace

TEST_CASE("a value to which the body would have to jump is not seen, at a start, within and at an end") {
  // 0.3 m/s from 0.5 m on: 15 mm a step, and half a metre or more to 0.
  const Series run = series(60, [](double t) { return 0.5 + 0.3 * t; });
  CHECK(unseen_in(run).empty());
  CHECK(unseen_in(with(run, {0, 1, 2, 3}, 0.0)) == Places{0, 1, 2, 3});
  CHECK(unseen_in(with(run, {20, 21, 22, 23, 24}, 9.99)) == Places{20, 21, 22, 23, 24});
  CHECK(unseen_in(with(run, {56, 57, 58, 59}, 0.0)) == Places{56, 57, 58, 59});
  CHECK(unseen_in(with(run, {57, 58, 59}, 0.0)).empty());  // three may be chance
  // Single ones of the value may be more than a tenth of all positions, as of a tracker that loses its marker.
  Places often{0, 1, 2, 3, 4};
  for (std::size_t i = 8; i < 60; i += 4) often.push_back(i);
  CHECK(unseen_in(with(run, often, 0.0)) == often);
  // Two values, and single ones of a value that is known.
  const Series two = with(with(run, {0, 1, 2, 3, 30}, 0.0), {55, 56, 57, 58, 59}, -1.0);
  CHECK(unseen_in(two) == Places{0, 1, 2, 3, 30, 55, 56, 57, 58, 59});
  CHECK(core::unseen_positions(two.t_s, two.x)->value == 0.0);
  CHECK(core::without_flagged(two.x, core::unseen_positions(two.t_s, two.x)->is_unseen).size() == 50);
}

TEST_CASE("zeros before a body comes into view near 0 are not seen if zeros far from it say so") {
  // From 6 mm on at 0.3 m/s, 15 mm a step: no jump leads from the zeros at the start to it.
  const Series run = series(60, [](double t) { return 0.3 * std::max(0.0, t - 0.2) + 0.006; });
  const Series before = with(run, {0, 1, 2, 3, 4}, 0.0);
  CHECK(unseen_in(before).empty());
  CHECK(unseen_in(with(before, {40, 41}, 0.0)) == Places{0, 1, 2, 3, 4, 40, 41});
  CHECK(unseen_in(with(run, {40, 41}, 0.0)).empty());  // nothing shows that 0 says so
}

TEST_CASE(
    "the zeros of a sensor that counts from its first sighting are those that it writes when it has lost a bead") {
  Series bead = series(80, [](double t) { return 0.075 * std::max(0.0, t - 0.5); });
  CHECK(unseen_in(bead).empty());  // no jump anywhere: it may have been at rest
  for (std::size_t i = 70; i < 80; ++i) bead.x[i] = 0.0;
  Places expected;
  for (std::size_t i = 0; i <= 10; ++i) expected.push_back(i);
  for (std::size_t i = 70; i < 80; ++i) expected.push_back(i);
  CHECK(unseen_in(bead) == expected);
}

TEST_CASE("rests are places, exact or rounded, before a launch, at an end stop and between two motions") {
  const auto launched = [](double t) { return t < 1.0 ? 0.2 : 0.2 + 1.5 * (t - 1.0); };  // by a blow
  const auto released = [](double t) { return t < 1.0 ? 0.2 : 0.2 + 0.8 * (t - 1.0) * (t - 1.0); };
  const auto stopped = [](double t) { return 1.5 * std::min(t, 1.52); };
  const auto bounced = [](double t) { return t < 1.5 ? 2.0 * t : 3.0 - 1.2 * (t - 1.5); };
  const auto twice = [](double t) { return t < 1.0 ? 1.2 * t : t < 2.0 ? 1.2 : 1.2 - 1.2 * (t - 2.0); };
  // A short blow after a long rest whose last digit flickers: nearly all steps are of one digit.
  const auto flickers = [](double t) {
    const double flicker = std::fmod(std::round(t / kStep_s), 7.0) == 3.0 ? 0.001 : 0.0;
    return t < 2.0 ? flicker : std::min(1.2 * (t - 2.0), 0.5);
  };
  const auto creeps = [](double t) { return t < 1.0 ? 0.8 * t : 0.8 + 0.02 * (t - 1.0); };
  for (const double digit_m : {0.0, 0.001, 0.01}) {
    CAPTURE(digit_m);
    for (const auto& motion :
         std::vector<std::function<double(double)>>{launched, released, stopped, bounced, twice, flickers, creeps}) {
      CHECK(unseen_in(series(70, motion, digit_m)).empty());
    }
  }
}

TEST_CASE("positions of which all but a few are equal say nothing") {
  CHECK(unseen_in(series(40, [](double) { return 0.3; })).empty());
  CHECK(unseen_in(series(40, [](double t) { return t < 1.0 ? 0.3 : 0.9; })).empty());
  CHECK_FALSE(core::unseen_positions({}, {}).has_value());
}

TEST_CASE("after a pause a body may be far away") {
  // 0.3 m/s, 2 s without a record, then at rest where it got to.
  Series of = series(40, [](double t) { return 0.3 * t; });
  for (std::size_t k = 0; k < 6; ++k) {
    of.t_s.push_back(3.95 + kStep_s * static_cast<double>(k));
    of.x.push_back(1.185);
  }
  CHECK(unseen_in(of).empty());
}
