#include "diagnose/single_frames/missing_frames.h"

#include <algorithm>
#include <random>
#include <set>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr std::size_t kFrames = 300;
constexpr double kRate = 200.0;

struct Losses {
  std::vector<std::set<std::size_t>> of_clip;
};

/// A fiftieth of the frames, none of the first and last ten.
Losses drawn(std::size_t clips, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  Losses losses;
  for (std::size_t c = 0; c < clips; ++c) {
    losses.of_clip.emplace_back();
    for (std::size_t f = 10; f + 10 < kFrames; ++f) {
      if (any(random) < 0.02) losses.of_clip.back().insert(f);
    }
  }
  return losses;
}

tests::MadeExperiment made_with(const Losses& losses, unsigned seed, double noise_m = 2e-5) {
  tests::MadeEffect effect;
  if (!losses.of_clip.empty()) {
    effect.lost = [&](std::size_t clip, std::size_t frame) { return losses.of_clip[clip].contains(frame); };
  }
  return tests::made_experiment(tests::made_launches(), effect, seed, noise_m, kFrames, kRate);
}

diagnose::TrackSet made(const Losses& losses, unsigned seed, double noise_m = 2e-5) {
  const auto experiment = made_with(losses, seed, noise_m);
  return diagnose::track_set(experiment.results, experiment.setups, true);
}

}  // namespace

TEST_CASE("a fiftieth of all frames lost, also beside reversals and each other, is put right") {
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u);
  const double noise_m = GENERATE(2e-5, 1.5e-6);
  Losses losses = drawn(tests::made_launches().size(), seed);
  // Two places with one frame or two between them.
  for (auto& of_clip : losses.of_clip) of_clip.insert({102, 104, 183, 186});
  const diagnose::TrackSet set = made(losses, seed, noise_m);
  const diagnose::MissingFrames found = diagnose::find_missing_frames(set, diagnose::fit_nominal(set));
  std::size_t lost = 0, wrong = 0;
  double points = 0.0;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& gone = losses.of_clip[set.motions[i].clip];
    lost += gone.size();
    points += static_cast<double>(set.motions[i].t_s.size());
    // The true time of the p-th frame that was kept.
    std::size_t frame = 0;
    for (std::size_t p = 0; p < set.motions[i].t_s.size(); ++p, ++frame) {
      while (gone.contains(frame)) ++frame;
      const double is = set.motions[i].t_s[p] + found.fit.late[i][p];
      const double off = (is - static_cast<double>(frame) / kRate) * std::abs(found.fit.motions[i].v_m_s[p]);
      wrong += std::abs(off) > 5.0 * set.motions[i].sd_m ? 1 : 0;  // in time, as far as that moves the glider
    }
  }
  INFO("seed " << seed << ", noise " << noise_m << " m, lost " << lost << ", found " << found.count);
  CHECK(static_cast<double>(wrong) <= 0.005 * points);
  CHECK(found.fit.cost / points < 1.2);
  CHECK(std::abs(static_cast<double>(found.count) - static_cast<double>(lost)) <= 3.0);
}

TEST_CASE("nothing is missing from an experiment that lost nothing, nor from one with a curve that the model lacks") {
  const unsigned seed = GENERATE(1u, 2u, 3u);
  const diagnose::TrackSet set = made({}, seed);
  CHECK(diagnose::find_missing_frames(set, diagnose::fit_nominal(set)).count == 0);
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); };
  const auto experiment = tests::made_experiment(tests::made_launches(), drag, seed, 2e-5, kFrames, kRate);
  const diagnose::TrackSet other = diagnose::track_set(experiment.results, experiment.setups, true);
  CHECK(diagnose::find_missing_frames(other, diagnose::fit_nominal(other)).count == 0);
}

TEST_CASE("lost frames are named, the gap falls to the floor, and no launch is advised against them") {
  const Losses losses = drawn(tests::made_launches().size(), 3);
  const auto made = made_with(losses, 3);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.effects.front().id == "dropped_frames");
  REQUIRE(diagnosis.gap);
  CHECK(diagnosis.gap->before > 10.0);
  CHECK(std::abs(diagnosis.gap->after - 1.0) < 0.1);
  CHECK(std::holds_alternative<diagnose::RecordForEffect>(diagnosis.next));
}

TEST_CASE("frames lost right behind the first ones of several clips, or before the last, are lost frames as well") {
  // Five clips lose one or two behind their first, second or third frame or before their last two, besides a fiftieth.
  const unsigned seed = GENERATE(1u, 2u, 3u, 4u, 5u);
  Losses losses = drawn(tests::made_launches().size(), seed);
  losses.of_clip[0].insert(1);
  losses.of_clip[1].insert(2);
  losses.of_clip[2].insert({2, 3});
  losses.of_clip[3].insert(3);
  losses.of_clip[4].insert(kFrames - 3);
  const auto made = made_with(losses, seed);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  INFO("seed " << seed);
  CHECK(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE_FALSE(diagnosis.effects.empty());
  CHECK(diagnosis.effects.front().id == "dropped_frames");
  REQUIRE(diagnosis.gap);
  CHECK(std::abs(diagnosis.gap->after - 1.0) < 0.1);
}

TEST_CASE(
    "the only frame that is lost, three before a clip's end, is a lost frame and three positions are no outliers") {
  // The last three positions are off by the motion of one frame, 1.1 mm with a noise of 0.02 mm.
  Losses losses;
  losses.of_clip.resize(8);
  losses.of_clip[3].insert(kFrames - 4);
  const tests::MadeExperiment made = made_with(losses, 12);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.effects.size() == 1);
  CHECK(diagnosis.effects.front().id == "dropped_frames");
  CHECK(diagnosis.effects.front().probability > 0.9);  // it is counted: no estimate that may as well be none
}
