#include "diagnose/unnamed/unnamed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/unnamed/unnamed_family.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

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

TEST_CASE("an image that creeps by a distance of its own in each clip is no hand that pushes") {
  // Half as large, a friction that steps at some speed gains nearly as much with one size instead of eight, by chance.
  for (const unsigned seed : {1u, 2u}) {
    std::size_t clip = 0;
    double last = -1.0;
    const tests::MadeEffect creep{.seen = [&](double x, double t) {
      constexpr std::array<double, 8> kCreep_m = {4e-4, -6e-4, 2e-4, 8e-4, -4e-4, 6e-4, -2e-4, -8e-4};
      if (t < last) ++clip;
      last = t;
      return x + kCreep_m[clip] * std::log1p(t / 0.05);
    }};
    const diagnose::Diagnosis diagnosis = diagnosed(creep, seed);
    CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
    CHECK(surest(diagnosis) < 0.5);
    REQUIRE(diagnosis.regions.size() > 0);
    CHECK(diagnosis.regions.front().what == diagnose::GapKind::displacement);
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
    CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
    CHECK(surest(diagnosis) < 0.5);
    // What settles does so from each clip's start on, and the diagnosis says that it is there.
    REQUIRE(diagnosis.regions.size() > 0);
    CHECK(diagnosis.regions.front().variable == diagnose::GapVariable::time);
    CHECK(diagnosis.regions.front().from < 0.02);
  }
}

TEST_CASE("a hand that pushes until a moment keeps its name") {
  for (const unsigned seed : {1u, 2u}) {
    const tests::MadeEffect push{
        .force = [](double m, double, double v, double t) { return t < 0.15 ? (v < 0.0 ? -0.6 : 0.4) * m : 0.0; }};
    const diagnose::Diagnosis diagnosis = diagnosed(push, seed);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    CHECK(diagnosis.effects.front().id == "late_release");
  }
}

TEST_CASE("a long motion has the most bumps, also one that lasts for more of them than a whole number can count") {
  CHECK(diagnose::bumps_over(1.0, 0.5, 3, 5) == 3);
  CHECK(diagnose::bumps_over(2.4, 0.5, 3, 5) == 4);
  CHECK(diagnose::bumps_over(60.0, 0.5, 3, 5) == 5);
  CHECK(diagnose::bumps_over(6e11, 0.5, 3, 5) == 5);
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

TEST_CASE(
    "a region's size is the largest of its curve with that place's own deviation, not the one where it is surest") {
  diagnose::UnnamedFamily bump;
  bump.at = {0.0, 1.0, 2.0, 3.0, 4.0};
  bump.size = {1e-6, 0.5, 2.0, 0.5, 7.0};
  bump.sd = {1e-7, 0.05, 0.2, 0.05, 2.0};  // ten of them everywhere, but at the end 3.5
  diagnose::name_regions(bump);
  REQUIRE(bump.regions.size() == 1);
  CHECK(bump.regions[0].from == 0.0);
  CHECK(bump.regions[0].to == 4.0);
  CHECK(bump.regions[0].size == 7.0);
  CHECK(bump.regions[0].sd == 2.0);
  CHECK(bump.regions[0].at == 4.0);
  CHECK(bump.regions[0].excess == Approx(10.0));
}

TEST_CASE("a lateness that settles is drawn as it settles, until a tenth is left, and sure from the start on") {
  // 4 ms late at the start, half of it after 60 ms, all clips alike: x at t - l is x - v l + a l²/2, of which the last
  // is 0.02 mm at most.
  const double size_s = 4e-3, half_s = 0.06;
  constexpr double kRate = 150.0;
  std::vector<std::vector<double>> still;  // the motions on time, for their speeds
  for (const auto& launch : tests::made_launches()) still.push_back(tests::made_motion({}, launch, {}, 152, kRate));
  std::size_t clip = 0, frame = 0;
  const tests::MadeEffect late{.seen = [&](double x, double t) {
    if (t == 0.0 && frame > 0) ++clip;
    frame = t == 0.0 ? 0 : frame + 1;
    const auto& on_time = still[clip];
    const double v = kRate * (frame > 0 ? 0.5 * (on_time[frame + 1] - on_time[frame - 1])
                                        : 2.0 * on_time[1] - 1.5 * on_time[0] - 0.5 * on_time[2]);
    return x - v * size_s / (1.0 + t / half_s);
  }};
  const auto made = tests::made_experiment(tests::made_launches(), late, 4, 2e-5, 150, kRate);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto families = diagnose::unnamed_families(diagnose::ScoreSpace(set, nominal));
  // Of the latenesses over time the one without bumps comes last.
  const auto settling = std::find_if(families.rbegin(), families.rend(),
                                     [](const auto& family) { return family.what == diagnose::GapKind::lateness; });
  REQUIRE(settling != families.rend());
  CHECK(settling->at.front() == 0.0);
  for (std::size_t i = 0; i < settling->at.size(); ++i) {
    CHECK(settling->size[i] / settling->size.front() == Approx(settling->sd[i] / settling->sd.front()).epsilon(1e-9));
  }
  CHECK(settling->size.front() == Approx(-size_s).epsilon(0.35));  // paces are tried by factors of 1.7
  REQUIRE(settling->regions.size() == 1);
  CHECK(settling->regions.front().from == 0.0);
  CHECK(settling->regions.front().to == settling->at.back());
  CHECK(settling->regions.front().excess ==
        Approx(std::abs(settling->size.front()) / settling->sd.front()).epsilon(1e-9));
}

TEST_CASE("unnamed evidence: a variable is as likely beforehand as another, however many shapes it has") {
  diagnose::UnnamedFamily none, strong;
  none.variable = diagnose::GapVariable::position;
  strong.variable = diagnose::GapVariable::mass;
  strong.log_evidence = 20.0;
  const double few = diagnose::log_unnamed_evidence({none, strong});
  CHECK(few == Approx(20.0 - std::log(2.0)).margin(1e-6));
  CHECK(diagnose::log_unnamed_evidence({none, none, none, none, strong}) == Approx(few).margin(1e-6));
}

TEST_CASE("pixels that pull the marker are seen, also where it crosses several of them from frame to frame") {
  // 1.2 m a second at 100 Hz: 12 mm a frame. 25 µm of noise; of 20 µm beyond that the log likelihood of 8 clips of 150
  // frames is 1200 * (20/25)^2 / 4 = 190 better.
  const double period_m = GENERATE(0.03, 0.009, 0.0013);
  const tests::MadeEffect pixels = {
      {}, [&](double x, double) { return x + 2e-5 * std::sin(2.0 * std::numbers::pi * x / period_m + 1.0); }};
  const auto made = tests::made_experiment(tests::made_launches(), pixels, 7, 2.5e-5);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  INFO("period " << period_m << " m");
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE_FALSE(diagnosis.regions.empty());
  CHECK(diagnosis.regions.front().variable == diagnose::GapVariable::position);
  CHECK(diagnosis.regions.front().what == diagnose::GapKind::displacement);
  CHECK(diagnosis.regions.front().to - diagnosis.regions.front().from > 1.0);  // m: all of the track
  // 20 µm, of which a 24th part is unsure; the largest of all periods that were tried is larger by some such.
  CHECK(std::abs(std::abs(diagnosis.regions.front().size) - 2e-5) < 4e-6);
}

TEST_CASE("friction that sets in above some speed is no hand that pushes against every start") {
  // Three motions, each fastest at its start: half as much friction again acts above 0.8 m/s, the first 0.1 to 0.3 s.
  const std::vector<tests::MadeLaunch> launches = {
      {0.335, 0.0, 0.5, -1.2}, {0.335, 0.0, -0.5, 1.1}, {0.335, 4.0, 0.3, -1.1}};
  const tests::MadeEffect cushion = {[](double mass_kg, double, double v, double) {
    const double part = 0.5 + 0.5 * std::tanh((std::abs(v) - 0.8) / 0.03);
    return -(v > 0.0 ? 1.0 : -1.0) * 0.5 * 0.006 * mass_kg * 9.80665 * part;
  }};
  const auto made = tests::made_experiment(launches, cushion, 4, 2e-5, 150, 150.0);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  // Friction that falls with the speed comes near to it: three clips do not tell for sure.
  CHECK(surest(diagnosis) < 0.8);
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) CHECK(effect.id != "late_release");
}

TEST_CASE("friction over how fast it moves: in proportion to the load or not, as it is") {
  const bool with_load = GENERATE(true, false);
  const tests::MadeEffect more = {[&](double mass_kg, double, double v, double) {
    const double part = 0.5 + 0.5 * std::tanh((std::abs(v) - 0.6) / 0.03);
    return -(v > 0.0 ? 1.0 : -1.0) * 0.02 * part * (with_load ? mass_kg : 0.4);
  }};
  const auto made = tests::made_experiment(tests::made_launches(), more, 4, 2e-5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto families = diagnose::unnamed_families(diagnose::ScoreSpace(set, nominal));
  const auto best = std::max_element(families.begin(), families.end(),
                                     [](const auto& a, const auto& b) { return a.log_evidence < b.log_evidence; });
  CHECK(best->variable == diagnose::GapVariable::speed);
  CHECK(best->what == diagnose::GapKind::friction);
  CHECK(best->unit == (with_load ? "m/s²" : "N"));
}

TEST_CASE("a magnet at one place pulls every glider by the same force, whatever its mass") {
  // The weak one comes near to a bow with a place of more friction: a name may be as likely as not, and no more.
  const double pull_n = GENERATE(0.01, 0.03);
  const tests::MadeEffect magnet = {
      [&](double, double x, double, double) { return pull_n * std::exp(-std::pow((x - 0.1) / 0.08, 2)); }};
  const diagnose::Diagnosis diagnosis = diagnosed(magnet, 5);
  INFO(pull_n << " N");
  CHECK(diagnosis.unknown > 0.4);
  if (pull_n > 0.02) CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  if (pull_n > 0.02) CHECK(diagnosis.unknown > 0.8);
  REQUIRE_FALSE(diagnosis.regions.empty());
  const diagnose::GapRegion& region = diagnosis.regions.front();
  CHECK(region.variable == diagnose::GapVariable::position);
  CHECK(region.what == diagnose::GapKind::force);
  CHECK(region.unit == "N");
  CHECK(region.from < 0.1);
  CHECK(region.to > 0.1);
  CHECK(std::abs(region.size) == Approx(pull_n).epsilon(0.25));  // a constant is an inclination
}

TEST_CASE("a brake that weakens in each clip is a drag over the time") {
  const tests::MadeEffect warm = {[](double, double, double v, double t) { return 0.08 * v * t; }};
  const diagnose::Diagnosis diagnosis = diagnosed(warm, 5);
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE_FALSE(diagnosis.regions.empty());
  CHECK(diagnosis.regions.front().variable == diagnose::GapVariable::time);
  CHECK(diagnosis.regions.front().what == diagnose::GapKind::viscous_drag);
}

TEST_CASE("a drag of each mass is told as its difference from the others: what they share is the drag that is fitted") {
  const tests::MadeEffect unlike = {
      [](double mass_kg, double, double v, double) { return (mass_kg < 0.4 ? 0.02 : -0.02) * v; }};
  const auto made = tests::made_experiment(tests::made_launches(), unlike, 6, 2e-5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto families = diagnose::unnamed_families(diagnose::ScoreSpace(set, nominal));
  const auto drag = std::find_if(families.begin(), families.end(), [](const auto& family) {
    return family.variable == diagnose::GapVariable::mass && family.what == diagnose::GapKind::viscous_drag;
  });
  REQUIRE(drag != families.end());
  REQUIRE(drag->size.size() == 2);
  CHECK(drag->size[0] + drag->size[1] == Approx(0.0).margin(1e-9));
  CHECK(std::abs(drag->size[1] - drag->size[0]) == Approx(0.04).epsilon(0.05));
}

TEST_CASE("magnets in a row: a force that swings with the place, too fine for smooth curves, has no name") {
  // 0.3 m/s² with a period of 6 cm, over 1.4 m. At 1 m/s it moves the glider by 0.3 (0.06 / 2 pi)² = 27 µm.
  const tests::MadeEffect cogs = {[](double mass_kg, double x, double, double) {
    return 0.3 * mass_kg * std::sin(2.0 * std::numbers::pi * x / 0.06);
  }};
  const diagnose::Diagnosis diagnosis = diagnosed(cogs, 3);
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE_FALSE(diagnosis.regions.empty());
  const diagnose::GapRegion& region = diagnosis.regions.front();
  CHECK(region.variable == diagnose::GapVariable::position);
  CHECK(region.what == diagnose::GapKind::acceleration);
  CHECK(region.to - region.from > 1.0);
  CHECK(std::abs(region.size) == Approx(0.3).epsilon(0.2));  // periods are tried in steps of a fiftieth
}

TEST_CASE("a camera that is moved between the clips shows each at a scale of its own") {
  constexpr std::array<double, 8> kMore = {0.006, -0.004, 0.002, -0.008, 0.004, -0.006, 0.008, -0.002};
  std::size_t clip = 0;
  double last = -1.0;
  const tests::MadeEffect moved{.seen = [&](double x, double t) {
    if (t < last) ++clip;
    last = t;
    return (1.0 + kMore[clip]) * x;
  }};
  const auto made = tests::made_experiment(tests::made_launches(), moved, 6, 2e-5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto families = diagnose::unnamed_families(diagnose::ScoreSpace(set, nominal));
  const auto scale = std::find_if(families.begin(), families.end(),
                                  [](const auto& family) { return family.what == diagnose::GapKind::scale; });
  REQUIRE(scale != families.end());
  REQUIRE(scale->size.size() == kMore.size());
  for (const auto& family : families) CHECK(family.log_evidence <= scale->log_evidence);
  // On a level track a motion at another scale is nearly one that began at another speed, and the data say so.
  for (std::size_t c = 0; c < kMore.size(); ++c) {
    CHECK(std::abs(scale->size[c] - kMore[c]) < 3.0 * scale->sd[c]);
    CHECK(scale->sd[c] < (c % 4 < 2 ? 0.006 : 0.003));
  }
}
