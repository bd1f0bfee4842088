#include "validate/study/sweep/design/sweep.h"

#include <cmath>
#include <map>
#include <set>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab;
using validate::AxisSource;
using Kind = validate::AxisSource::Kind;

namespace {

validate::Axis axis(AxisSource source, const std::string& name) {
  return {name, {name}, std::move(source)};
}

AxisSource range(Kind kind, double from, double to, std::size_t count = 0) {
  AxisSource source;
  source.kind = kind;
  source.from = from;
  source.to = to;
  source.count = count;
  return source;
}

double number(const base::TomlScalar& value) {
  return std::get<double>(value);
}

}  // namespace

TEST_CASE("A factorial design has every combination once, ends included, the last axis fastest") {
  validate::Sweep sweep;
  AxisSource words;
  words.values = {std::string("a"), std::string("b")};
  sweep.axes = {axis(words, "w"), axis(range(Kind::logarithmic, 1.0, 1000.0, 4), "l")};
  sweep.replicates = 3;
  REQUIRE(validate::run_count(sweep) == 24);
  std::set<std::pair<std::string, double>> seen;
  for (std::uint64_t run = 0; run < 24; ++run) {
    const auto values = validate::values_of(sweep, run);
    seen.emplace(std::get<std::string>(values[0]), number(values[1]));
    CHECK(values == validate::values_of(sweep, run / 3 * 3));  // replicates share their point
  }
  CHECK(seen.size() == 8);
  CHECK(number(validate::values_of(sweep, 0)[1]) == 1.0);
  CHECK(std::abs(number(validate::values_of(sweep, 3)[1]) - 10.0) < 1e-13);  // a few roundings of pow
  CHECK(number(validate::values_of(sweep, 9)[1]) == 1000.0);
}

TEST_CASE("A Latin hypercube visits each of n strata of each axis once") {
  validate::Sweep sweep;
  sweep.design = validate::Design::latin_hypercube;
  sweep.samples = 77;
  sweep.seed = 5;
  sweep.axes = {axis(range(Kind::linear, 0.0, 77.0), "x"), axis(range(Kind::linear, 0.0, 77.0), "y")};
  std::set<int> x, y;
  double product = 0.0;
  for (std::uint64_t point = 0; point < 77; ++point) {
    const auto values = validate::values_of(sweep, point);
    x.insert(static_cast<int>(number(values[0])));
    y.insert(static_cast<int>(number(values[1])));
    product += (number(values[0]) - 38.5) * (number(values[1]) - 38.5);
  }
  CHECK(x.size() == 77);
  CHECK(y.size() == 77);
  // Independent permutations: correlation has the standard deviation 1/sqrt(76); four of it.
  CHECK(std::abs(product / 77.0 / (77.0 * 77.0 / 12.0)) < 4.0 / std::sqrt(76.0));
}

TEST_CASE("The first 64 points of a shifted Sobol sequence are a net: one in each of 8 x 8 boxes, whatever the seed") {
  for (const std::uint64_t seed : {1u, 2u}) {
    validate::Sweep sweep;
    sweep.design = validate::Design::sobol;
    sweep.samples = 64;
    sweep.seed = seed;
    sweep.axes = {axis(range(Kind::linear, 0.0, 8.0), "x"), axis(range(Kind::linear, 0.0, 8.0), "y")};
    std::set<std::pair<int, int>> boxes;
    for (std::uint64_t point = 0; point < 64; ++point) {
      const auto values = validate::values_of(sweep, point);
      boxes.emplace(static_cast<int>(number(values[0])), static_cast<int>(number(values[1])));
    }
    CHECK(boxes.size() == 64);
  }
}

TEST_CASE("Whole numbers of a range with equal steps come equally often, the ends too") {
  validate::Sweep sweep;
  sweep.design = validate::Design::latin_hypercube;
  sweep.samples = 400;
  AxisSource source = range(Kind::linear, 3.0, 6.0);
  source.whole = true;
  sweep.axes = {axis(source, "n")};
  std::map<double, int> times;
  for (std::uint64_t point = 0; point < 400; ++point) ++times[number(validate::values_of(sweep, point)[0])];
  CHECK(times == std::map<double, int>{{3.0, 100}, {4.0, 100}, {5.0, 100}, {6.0, 100}});  // 100 strata each
}

TEST_CASE("Draws have the moments of their distribution and differ between runs of one point") {
  validate::Sweep sweep;
  AxisSource normal;
  normal.kind = Kind::normal;
  normal.mean = 3.0;
  normal.sd = 0.5;
  AxisSource log_normal = normal;
  log_normal.kind = Kind::log_normal;
  sweep.axes = {axis(normal, "n"), axis(range(Kind::uniform, -1.0, 1.0), "u"), axis(log_normal, "l")};
  sweep.replicates = 20000;
  REQUIRE(validate::run_count(sweep) == 20000);
  double sum = 0.0, square = 0.0, uniform = 0.0, logs = 0.0;
  for (std::uint64_t run = 0; run < sweep.replicates; ++run) {
    const auto values = validate::values_of(sweep, run);
    const double z = (number(values[0]) - 3.0) / 0.5;
    sum += z;
    square += z * z;
    uniform += number(values[1]);
    logs += std::log(number(values[2]) / 3.0) / 0.5;
  }
  const double n = 20000.0, four_sd = 4.0 / std::sqrt(n);  // fixed seed; four standard errors
  CHECK(std::abs(sum / n) < four_sd);
  CHECK(std::abs(square / n - 1.0) < four_sd * std::sqrt(2.0));
  CHECK(std::abs(uniform / n) < four_sd / std::sqrt(3.0));
  CHECK(std::abs(logs / n) < four_sd);
}

TEST_CASE("Quantiles of the normal distribution are those of the error function") {
  AxisSource normal;
  normal.kind = Kind::normal;
  normal.mean = 0.0;
  normal.sd = 1.0;
  for (const double z : {-6.0, -2.0, -0.3, 0.0, 0.7, 1.959963984540054, 4.0}) {
    const double p = 0.5 * std::erfc(-z / std::sqrt(2.0));
    // dz = dp / density: the rounding of p, 2^-53, at 4 standard deviations makes 1e-12
    CHECK(std::abs(number(validate::value_at(normal, p)) - z) < 1e-11);
  }
}

TEST_CASE("Seeds are those of the run and the sweep's seed, and do not repeat") {
  validate::Sweep sweep;
  std::set<std::uint64_t> seeds;
  for (std::uint64_t run = 0; run < 10000; ++run) seeds.insert(validate::seed_of(sweep, run));
  CHECK(seeds.size() == 10000);
  validate::Sweep other = sweep;
  other.seed = 2;
  CHECK(validate::seed_of(other, 7) != validate::seed_of(sweep, 7));
  CHECK(validate::seed_of(sweep, 7) == validate::seed_of(sweep, 7));
}

TEST_CASE("1e18 combinations are refused with their number") {
  validate::Sweep sweep;
  for (const char* name : {"a", "b", "c"}) sweep.axes.push_back(axis(range(Kind::linear, 0.0, 1.0, 1000000), name));
  CHECK_THROWS_AS(validate::run_count(sweep), base::InputError);
}

TEST_CASE("Permutations of any length hit every number once") {
  for (const std::uint64_t count : {1u, 2u, 3u, 64u, 65u, 1000u}) {
    std::set<std::uint64_t> hit;
    for (std::uint64_t i = 0; i < count; ++i) hit.insert(validate::permuted(i, count, 42));
    CHECK(hit.size() == count);
    CHECK(*hit.rbegin() == count - 1);
  }
}
