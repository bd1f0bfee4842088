#include "diagnose/unnamed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "catch.h"
#include "diagnose/diagnose.h"
#include "diagnose/unnamed_shape.h"
#include "made_motions.h"

using namespace glidelab;

namespace {

diagnose::Diagnosis diagnosed(const tests::MadeEffect& effect, unsigned seed) {
  const auto made = tests::made_experiment(tests::made_launches(), effect, seed, 2e-5, 150, 150.0);
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

/// The most that is said for one name.
double surest(const diagnose::Diagnosis& diagnosis) {
  double most = 0.0;
  for (const auto& named : diagnosis.effects) most = std::max(most, named.probability);
  return most;
}

}  // namespace

TEST_CASE("a picture that creeps in each clip by its own way is no hand that pushes") {
  for (const unsigned seed : {1u, 2u}) {
    std::size_t clip = 0;
    double last = -1.0;
    const tests::MadeEffect creep{.seen = [&](double x, double t) {
      constexpr std::array<double, 8> kWay = {2e-4, -3e-4, 1e-4, 4e-4, -2e-4, 3e-4, -1e-4, -4e-4};
      if (t < last) ++clip;
      last = t;
      return x + kWay[clip] * std::log1p(t / 0.05);
    }};
    const diagnose::Diagnosis diagnosis = diagnosed(creep, seed);
    CHECK(diagnosis.verdict == "unknown");
    CHECK(surest(diagnosis) < 0.5);
    REQUIRE(diagnosis.regions.size() > 0);
    CHECK(diagnosis.regions.front().what == "displacement");
    CHECK_FALSE(diagnosis.regions.front().clip.empty());
    std::set<std::string> clips;
    for (const diagnose::GapRegion& region : diagnosis.regions) {
      if (!region.clip.empty()) CHECK(clips.insert(region.clip).second);
    }
  }
}

TEST_CASE("a tracker that lags behind by half a frame, from the first one on, has no name") {
  for (const unsigned seed : {1u, 2u}) {
    double followed = 0.0;
    const tests::MadeEffect lag{.seen = [&](double x, double t) {
      followed = t == 0.0 ? x : followed + (1.0 - std::exp(-1.0 / (150.0 * 0.003))) * (x - followed);
      return followed;
    }};
    const diagnose::Diagnosis diagnosis = diagnosed(lag, seed);
    CHECK(diagnosis.verdict == "unknown");
    CHECK(surest(diagnosis) < 0.5);
    // What settles does so from each clip's start on, and the diagnosis says that it is there.
    REQUIRE(diagnosis.regions.size() > 0);
    CHECK(diagnosis.regions.front().variable == "t_s");
    CHECK(diagnosis.regions.front().from < 0.02);
  }
}

TEST_CASE("a hand that pushes until a moment keeps its name") {
  for (const unsigned seed : {1u, 2u}) {
    const tests::MadeEffect push{
        .force = [](double m, double, double v, double t) { return t < 0.15 ? (v < 0.0 ? -0.6 : 0.4) * m : 0.0; }};
    const diagnose::Diagnosis diagnosis = diagnosed(push, seed);
    REQUIRE(diagnosis.verdict == "effect");
    CHECK(diagnosis.effects.front().id == "late_release");
  }
}

TEST_CASE("places beside each other are one region, clips beside each other are not") {
  diagnose::UnnamedFamily family;
  family.at = {0.0, 1.0, 2.0, 3.0};
  family.size = {5.0, -9.0, 1.0, 4.0};
  family.sd = {1.0, 1.0, 1.0, 1.0};
  diagnose::UnnamedFamily clips = family;
  clips.names = {"a", "b", "c", "d"};
  diagnose::name_regions(family);
  REQUIRE(family.regions.size() == 2);
  CHECK(family.regions[0].from == 0.0);
  CHECK(family.regions[0].to == 1.0);
  CHECK(family.regions[0].size == -9.0);
  diagnose::name_regions(clips);
  REQUIRE(clips.regions.size() == 3);
  CHECK(clips.regions[1].from == 1.0);
  CHECK(clips.regions[1].to == 1.0);
}

TEST_CASE("unnamed evidence: a variable is as likely beforehand as another, however many shapes it has") {
  diagnose::UnnamedFamily none, strong;
  none.variable = "x_m";
  strong.variable = "mass_kg";
  strong.log_evidence = 20.0;
  const double few = diagnose::log_unnamed_evidence({none, strong});
  CHECK(few == Approx(20.0 - std::log(2.0)).margin(1e-6));
  CHECK(diagnose::log_unnamed_evidence({none, none, none, none, strong}) == Approx(few).margin(1e-6));
}
