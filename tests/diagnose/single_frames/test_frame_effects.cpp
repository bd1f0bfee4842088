#include "diagnose/single_frames/frame_effects.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Errors of 1 mm in about one frame of fifty, each lasting `frames`; the noise is 20 µm.
tests::MadeExperiment spoilt(std::size_t frames, unsigned seed) {
  std::mt19937_64 random(seed + 40);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::size_t left = 0;
  double error = 0.0;
  const tests::MadeEffect effect{.seen = [&](double x, double) {
    if (left == 0 && any(random) < 0.02 / static_cast<double>(frames)) {
      left = frames;
      error = any(random) < 0.5 ? -1e-3 : 1e-3;
    }
    if (left == 0) return x;
    --left;
    return x + error;
  }};
  return tests::made_experiment(tests::made_launches(), effect, seed, 2e-5, 250, 150.0);
}

diagnose::FrameEffect tails_of(const tests::MadeExperiment& made) {
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  return diagnose::scan_tails(set, diagnose::fit_nominal(set));
}

/// Errors of 1 mm in the listed frames of every clip whose number is listed with them; the noise is 20 µm.
struct SpoiltFrames {
  std::vector<std::size_t> clips, frames;
};

diagnose::FrameEffect tails_of(const std::vector<SpoiltFrames>& spoilt_frames, unsigned seed) {
  std::size_t clip = 0, frame = 0;
  const tests::MadeEffect effect{.seen = [&](double x, double t) {
    if (t == 0.0) {
      ++clip;
      frame = 0;
    }
    const auto is_in = [](const std::vector<std::size_t>& all, std::size_t one) {
      return std::find(all.begin(), all.end(), one) != all.end();
    };
    double error = 0.0;
    for (const SpoiltFrames& some : spoilt_frames) {
      if (is_in(some.clips, clip - 1) && is_in(some.frames, frame)) error = frame / 10 % 2 == 0 ? 1e-3 : -1e-3;
    }
    ++frame;
    return x + error;
  }};
  return tails_of(tests::made_experiment(tests::made_launches(), effect, seed, 2e-5, 250, 150.0));
}

}  // namespace

TEST_CASE("a dozen positions show no scatter of single ones at any size, so none is weighed") {
  const auto made = tests::made_experiment({{0.3, 90.0, 0.0, 0.2}}, {}, 5, 1e-4, 12, 60.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  CHECK_FALSE(diagnose::scan_tails(set, diagnose::fit_nominal(set)).visible);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  for (const auto& ranked : diagnosis.ranking) {
    CHECK_FALSE(ranked.explanation.holds("heavy_tailed_noise"));
    CHECK_FALSE(ranked.explanation.holds("timestamp_jitter"));
  }
  const auto many = tests::made_experiment({{0.3, 4.0, 0.3, -1.1}}, {}, 5, 1e-4, 120, 60.0);
  const diagnose::TrackSet shows = diagnose::track_set(many.results, many.setups, true);
  CHECK(diagnose::scan_tails(shows, diagnose::fit_nominal(shows)).visible);
}

TEST_CASE("errors of single frames are heavy tails, errors that last are none and have no name") {
  for (const unsigned seed : {1u, 2u}) {
    const auto single = spoilt(1, seed), lasting = spoilt(3, seed);
    CHECK(tails_of(single).log_evidence > 10.0);
    CHECK(tails_of(single).in_runs <= 0.0);
    CHECK_FALSE(tails_of(single).run);
    const diagnose::FrameEffect tails = tails_of(lasting);
    CHECK(tails.in_runs > 20.0);
    REQUIRE(tails.run);
    CHECK(tails.run->clip);
    // Three frames from the first to the last are two steps; another error may follow at once, on the same side.
    CHECK(tails.run->to_s - tails.run->from_s > 1.5 / 150.0);
    CHECK(tails.run->to_s - tails.run->from_s < 5.5 / 150.0);
    // 1 mm, of which the smooth curve under such errors takes a part, and the noise is a fiftieth.
    CHECK(tails.run->size_m > 6e-4);
    CHECK(tails.run->size_m < 1.1e-3);
    CHECK(tails.run->excess > 10.0);
    const auto named = diagnose::diagnose_results(single.results, single.setups, {.without = {}, .jobs = 2});
    REQUIRE(named.verdict == diagnose::Verdict::effect);
    CHECK(named.effects.front().id == "heavy_tailed_noise");
    const auto other = diagnose::diagnose_results(lasting.results, lasting.setups, {.without = {}, .jobs = 2});
    CHECK(other.verdict == diagnose::Verdict::unknown);
  }
}

TEST_CASE("a tracker that has to find its marker at each clip's start makes no heavy tails") {
  const tests::MadeEffect effect{.seen = [](double x, double t) { return t < 0.005 ? x + 4e-4 : x; }};
  const auto made = tests::made_experiment(tests::made_launches(), effect, 3, 2e-5, 250, 150.0);
  const diagnose::FrameEffect tails = tails_of(made);
  CHECK(tails.in_runs > 10.0);
  REQUIRE(tails.run);
  CHECK_FALSE(tails.run->clip);  // of all clips
  CHECK(tails.run->from_s == 0.0);
  CHECK(tails.run->to_s < 0.02);  // three frames at 150 Hz
  CHECK(tails.run->size_m > 2.5e-4);
  CHECK(tails.run->size_m < 4.8e-4);  // 0.4 mm and four times the noise
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  for (const auto& named : diagnosis.effects) CHECK(named.probability < 0.5);
}

TEST_CASE("what the law lacks by a hundred deviations, and smoothly, is no error of the first frames") {
  // A drag that falls along the track by a fifth a metre, at 60 frames a second: millimetres of the nominal fit.
  const tests::MadeEffect gradient{.force = [](double, double x, double v, double) { return 0.2 * 0.93 * x * v; }};
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto made = tests::made_experiment(tests::made_launches(), gradient, seed, 3e-5, 100, 60.0);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    CHECK(diagnose::scan_tails(set, nominal).log_evidence < 3.0);
    CHECK(diagnose::set_tails_aside(set, nominal) == 0);
  }
}

TEST_CASE(
    "errors in a row are a pattern where they are four steps and a quarter of all errors, and no accident below") {
  const std::vector<std::size_t> all_clips{0, 1, 2, 3, 4, 5, 6, 7};
  // Six errors, of which three follow each other: one error that lasted beside three of single frames.
  const std::vector<SpoiltFrames> one_run{{{1}, {61, 62, 63}}, {{3}, {81}}, {{5}, {121}}, {{6}, {161}}};
  CHECK(tails_of(one_run, 7).log_evidence > 5.0);
  CHECK(tails_of(one_run, 7).in_runs == 0.0);
  // Four such runs and nothing else.
  CHECK(tails_of({{{1, 2, 4, 6}, {61, 62, 63}}}, 8).in_runs > 10.0);
  // Four runs among forty errors of single frames: chance makes no such runs, but most errors have another cause.
  CHECK(tails_of({{{1, 2, 4, 6}, {61, 62, 63}}, {all_clips, {33, 85, 113, 146, 187}}}, 9).in_runs == 0.0);
}

TEST_CASE("the first three frames of a clip are its start, the seventh is not") {
  const std::vector<std::size_t> all_clips{0, 1, 2, 3, 4, 5, 6, 7};
  CHECK(tails_of({{all_clips, {2}}}, 10).in_runs > 10.0);
  CHECK(tails_of({{all_clips, {6}}}, 10).in_runs == 0.0);
  // Of errors at any place a single one at a start is no pattern.
  CHECK(tails_of({{{2}, {1}}, {{4, 5}, {101}}, {{6}, {151}}}, 11).in_runs == 0.0);
}
