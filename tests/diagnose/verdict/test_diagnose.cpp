#include "diagnose/verdict/diagnose.h"

#include <algorithm>
#include <random>
#include <string_view>

#include "base/errors.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/weigh/hypotheses.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

namespace {

diagnose::Diagnosis diagnosed(const tests::MadeExperiment& made, const std::vector<std::string>& without = {}) {
  return diagnose::diagnose_results(made.results, made.setups, {.without = without, .jobs = 2});
}

double total(const diagnose::Diagnosis& diagnosis) {
  double sum = diagnosis.none + diagnosis.unknown;
  for (const auto& ranked : diagnosis.ranking) sum += ranked.probability;
  return sum;
}

struct Case {
  std::string id;
  tests::MadeEffect effect;
  std::string key;
  double truth;
};

/// Each effect is strong enough to shift positions by tens of times the noise of 30 µm.
std::vector<Case> strong_cases() {
  const double pi = std::acos(-1.0);
  std::vector<Case> cases;
  cases.push_back({"quadratic_drag",
                   {[](double, double, double v, double) { return -0.05 * v * std::abs(v); }, {}},
                   "c_kg_m",
                   0.05});
  cases.push_back({"load_independent_friction",
                   {[](double, double, double v, double) { return v < 0.0   ? 0.01
                                                                  : v > 0.0 ? -0.01
                                                                            : 0.0; }, {}},
                   "force_n",
                   0.01});
  cases.push_back(
      {"damping_gradient", {[](double, double x, double v, double) { return -0.93 * 0.1 * x * v; }, {}}, "b_1_m", 0.1});
  cases.push_back({"tether",
                   {[](double, double x, double, double) { return x > 0.1 ? -0.3 * (x - 0.1) : 0.0; }, {}},
                   "k_n_m",
                   0.3});
  cases.push_back({"perspective_error", {{}, [](double x, double) { return x / (1.0 + 0.02 * x); }}, "p_1_m", 0.02});
  cases.push_back({"scale_error", {{}, [](double x, double) { return 1.05 * x; }}, "e", 0.05});
  cases.push_back(
      {"base_vibration",
       {[=](double m, double, double, double t) { return m * 0.5 * std::sin(2.0 * pi * 7.3 * t + 0.4); }, {}},
       "f_hz",
       7.3});
  return cases;
}

}  // namespace

TEST_CASE("a strong effect is named first, with its size, and its probabilities sum to 1") {
  for (const Case& one : strong_cases()) {
    INFO(one.id);
    const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), one.effect, 11));
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    std::vector<std::string> named = diagnosis.effects.front().equivalent_to;
    named.push_back(diagnosis.effects.front().id);
    CHECK(std::find(named.begin(), named.end(), one.id) != named.end());
    CHECK(std::abs(total(diagnosis) - 1.0) < 1e-9);
    for (const auto& parameter : diagnosis.effects.front().parameters) {
      if (diagnosis.effects.front().id != one.id || parameter.key != one.key) continue;
      // Five standard deviations, and 3 % for the difference between "x_mid = 0" here and the middle of the data.
      CHECK(std::abs(parameter.value - one.truth) < 5.0 * parameter.sd + 0.03 * one.truth);
    }
    REQUIRE(diagnosis.gap);
    // At the floor: a tenth above it would be four standard errors, with 1200 positions.
    CHECK(diagnosis.gap->after < 1.1);
  }
}

TEST_CASE("a wrong scale and a wrong frame rate are named together: tracks cannot tell them apart") {
  const tests::MadeEffect scale = {{}, [](double x, double) { return 1.05 * x; }};
  const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), scale, 3));
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  const auto& first = diagnosis.effects.front();
  CHECK(first.probability < 0.8);
  std::vector<std::string> named = first.equivalent_to;
  named.push_back(first.id);
  CHECK(std::find(named.begin(), named.end(), "scale_error") != named.end());
  CHECK(std::find(named.begin(), named.end(), "frame_rate_error") != named.end());
  // Only the inclination shows it, and no held-out clip is off: the quantities have the effect in their model all the
  // same.
  REQUIRE_FALSE(diagnosis.recovered.empty());
  for (const auto& one : diagnosis.recovered) CHECK(one.with == std::vector<std::string>{first.id});
}

TEST_CASE("a size that only the inclination shows is found in full, however well the positions are known") {
  // With a noise of 3 µm in 1200 positions, only the stated 0.05 degrees determine the scale beside K, mu and the
  // inclination, thousands of times less well than the positions would on their own. A scale and a clock do the same to
  // positions: one chi², wherever the fit starts.
  const tests::MadeEffect effect{.seen = [](double x, double) { return 1.06 * x; }};
  const auto made = tests::made_experiment(tests::made_launches(), effect, 5, 3e-6);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  std::vector<double> gains;
  for (const char* id : {"scale_error", "frame_rate_error"}) {
    const std::size_t index = diagnose::effect_index(id);
    for (const double start : {0.002, 0.03, -0.08}) {
      const auto fit = diagnose::fit_motions(set, {index}, diagnose::with_effect(set, nominal, index, {start}, {}));
      INFO(id << " from " << start);
      CHECK(fit.converged);
      gains.push_back(0.5 * (nominal.cost - fit.cost));
    }
  }
  for (const double gain : gains) CHECK(std::abs(gain - gains.front()) < 0.05);  // the fit stops at changes of 0.001
  CHECK(gains.front() > 8.0);  // 6 % of 4 degrees is 4.8 times 0.05: a gain of 11.5, give or take 4.8
}

TEST_CASE("a nominal experiment has nothing missing, and its gap is at the floor") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), {}, seed));
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    CHECK(diagnosis.none > 0.5);
    CHECK(std::abs(total(diagnosis) - 1.0) < 1e-9);
    REQUIRE(diagnosis.gap);
    // With 1200 positions and a noise that is itself estimated, 0.04 is one standard error.
    CHECK(std::abs(diagnosis.gap->before - 1.0) < 0.16);
  }
}

TEST_CASE("the parameters that an explanation is said to add are those that its fit has") {
  const auto made = tests::made_experiment(tests::made_launches(), {}, 5);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  const auto added = [&](const std::string& id) -> std::size_t {
    const auto ranked = std::find_if(diagnosis.ranking.begin(), diagnosis.ranking.end(),
                                     [&](const auto& one) { return one.explanation == diagnose::Explanation{{id}}; });
    return ranked == diagnosis.ranking.end() ? 0 : ranked->parameters;
  };
  // Tracks cannot show whether the camera turns: its sway has a size and a frequency, and a phase in each of 8 motions.
  CHECK(added("camera_motion") == 2 + 8);
  CHECK(added("base_vibration") == 2 + 8);
  CHECK(added("stribeck") == 2);
  CHECK(added("timestamp_jitter") == 1);
}

TEST_CASE("a force that is not on the list is unknown, and the place where it acts is named") {
  // A rough patch: extra friction between 0.10 and 0.22 m.
  const tests::MadeEffect patch = {[](double m, double x, double v, double) {
                                     const double size = x > 0.10 && x < 0.22 ? 0.15 * m : 0.0;
                                     return v > 0.0 ? -size : size;
                                   },
                                   {}};
  const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), patch, 5));
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE(!diagnosis.regions.empty());
  CHECK(diagnosis.regions.front().variable == diagnose::GapVariable::position);
  // Explanations without a chance are ranked by evidence, since probabilities that underflow are all the same.
  const auto& ranking = diagnosis.ranking;
  for (std::size_t r = 1; r < ranking.size(); ++r) {
    if (ranking[r - 1].probability < 5e-4) {
      CHECK(ranking[r].log_evidence_gain <= ranking[r - 1].log_evidence_gain);
    }
  }
}

TEST_CASE("in images a strong effect keeps its name beside a weak rest, and loses it beside a strong one") {
  // A drag that shifts positions by centimetres, and a distortion of the image that is not on the list. The noise is 30
  // µm.
  const auto compared = [](double bend_m, bool filmed) {
    const auto made = tests::made_experiment(tests::made_launches(),
                                             {[](double, double, double v, double) { return -0.05 * v * std::abs(v); },
                                              [=](double x, double) { return x + bend_m * std::sin(9.0 * x); }},
                                             5);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    set.images = filmed;
    return diagnose::compare_hypotheses(set, {}, 2);
  };
  const std::size_t drag = diagnose::effect_index("quadratic_drag");
  const auto by_tracks = compared(2e-5, false), filmed = compared(2e-5, true);
  CHECK(by_tracks.unknown > 0.5);
  CHECK(filmed.unknown < 0.1);
  CHECK(filmed.effect_probability[drag] > 0.9);
  double sum = 0.0;
  for (const auto& hypothesis : filmed.all) sum += hypothesis.probability;
  CHECK(std::abs(sum - 1.0) < 1e-9);
  // 80 µm over 1600 positions: a gain of several thousand.
  CHECK(compared(8e-5, true).unknown > 0.8);
}

TEST_CASE("a suggested launch can be made, also if a glider was released from rest") {
  const std::vector<tests::MadeLaunch> launches = {
      {0.335, 3.7, 0.75, -1.05}, {0.335, 3.7, 0.7, -0.8}, {0.335, 3.7, -0.1, 0.75}, {0.335, 3.7, -0.12, 0.0}};
  const tests::MadeEffect bow{[](double m, double x, double, double) { return 0.02 * m * x; }, {}};
  const auto diagnosis = diagnosed(tests::made_experiment(launches, bow, 2));
  const diagnose::Change* change = nullptr;
  if (const auto* doubt = std::get_if<diagnose::SettleDoubt>(&diagnosis.next); doubt != nullptr && doubt->by) {
    change = &*doubt->by;
  }
  if (const auto* sharpen = std::get_if<diagnose::SharpenParameter>(&diagnosis.next); sharpen && sharpen->by) {
    change = &*sharpen->by;
  }
  if (change != nullptr && change->clip) CHECK(std::abs(change->clip->v0_m_s) >= 0.2);  // a fifth of the fastest
  CHECK_FALSE(std::holds_alternative<std::monostate>(diagnosis.next));
}

TEST_CASE("an effect that is left out of the list is unknown, never another name with high probability") {
  const tests::MadeEffect bow = {[](double m, double x, double, double) { return m * 9.8 * 0.01 * x; }, {}};
  const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), bow, 7), {"track_bow"});
  for (const auto& effect : diagnosis.effects) CHECK(effect.probability < 0.8);
}

TEST_CASE("data that support no verdict are refused, or the verdict says so") {
  SECTION("constant positions") {
    const tests::MadeEffect held = {{}, [](double, double) { return 0.25; }};
    CHECK_THROWS_AS(diagnosed(tests::made_experiment(tests::made_launches(), held, 1, 0.0)), base::InputError);
  }
  SECTION("a clip with 10 frames") {
    const auto made = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, {}, 1, 3e-5, 10);
    CHECK_THROWS_AS(diagnosed(made), base::InputError);
  }
  SECTION("a clip with 28 frames, as of a short film, lacks nothing") {
    const auto diagnosis = diagnosed(tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, {}, 1, 3e-4, 28, 30.0));
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
  }
  SECTION("one clip: held-out quarters, and a note") {
    const auto diagnosis = diagnosed(tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, {}, 1));
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    REQUIRE(diagnosis.gap);
    CHECK(diagnosis.gap->held_out.size() == 4);
    CHECK(std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
      return std::holds_alternative<diagnose::QuartersHeldOut>(note);
    }));
  }
  SECTION("no plumb and no stated uncertainty of the inclination") {
    const tests::MadeEffect scale = {{}, [](double x, double) { return 1.05 * x; }};
    const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), scale, 1, 3e-5, 150, 100.0, 0.0));
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    const auto open = [](const diagnose::Note& note) { return std::holds_alternative<diagnose::NoInclination>(note); };
    REQUIRE(std::count_if(diagnosis.notes.begin(), diagnosis.notes.end(), open) == 1);  // one for both set-ups
    const diagnose::Note note = *std::find_if(diagnosis.notes.begin(), diagnosis.notes.end(), open);
    CHECK(std::get<diagnose::NoInclination>(note).groups == std::vector<std::string>{"level", "inclined"});
  }
  SECTION("what only a camera has, of positions without images") {
    const auto of_camera = [](tests::MadeExperiment made) {
      const auto diagnosis = diagnosed(made);
      std::vector<std::string> ids;
      for (const diagnose::Note& note : diagnosis.notes) {
        if (const auto* const one = std::get_if<diagnose::OfCamera>(&note)) ids = one->ids;
      }
      REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
      return ids;
    };
    const tests::MadeEffect aslant = {{}, [](double x, double) { return x / (1.0 + 0.02 * x); }};
    tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), aslant, 5);
    CHECK(of_camera(made) == std::vector<std::string>{"perspective_error"});
    const tests::MadeEffect drag = {[](double, double, double v, double) { return -0.2 * v * std::abs(v); }};
    CHECK(of_camera(tests::made_experiment(tests::made_launches(), drag, 5)).empty());
    // A motion sensor has no such thing, as its program's header or a person says; a person knows better.
    const auto has_camera = [](const tests::MadeExperiment& of) {
      const auto diagnosis = diagnosed(of);
      bool has = false;
      for (const diagnose::RankedExplanation& one : diagnosis.ranking) {
        has = has || one.explanation.holds("perspective_error") || one.explanation.holds("lens_distortion");
      }
      const bool noted = std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
        return std::holds_alternative<diagnose::SensorPositions>(note);
      });
      CHECK(noted != has);
      return has;
    };
    CHECK(has_camera(made));
    for (core::ClipResult& clip : made.results.clips) clip.sensor_column = "Position, Ch 1 (m)";
    CHECK_FALSE(has_camera(made));
    made.results.clips.front().sensor_column.clear();
    CHECK(has_camera(made));
    for (core::ClipSetup& setup : made.setups) setup.recorded_by = core::RecordedBy::sensor;
    CHECK_FALSE(has_camera(made));
    for (core::ClipResult& clip : made.results.clips) clip.sensor_column = "Position, Ch 1 (m)";
    for (core::ClipSetup& setup : made.setups) setup.recorded_by = core::RecordedBy::camera;
    CHECK(has_camera(made));
  }
  SECTION("an effect that does not exist") {
    CHECK_THROWS_AS(diagnosed(tests::made_experiment(tests::made_launches(), {}, 1), {"magic"}), base::InputError);
  }
}

TEST_CASE("noise that the blur of a moving marker adds is no uneven clock in images, and may be one in tracks") {
  // A noise of 1.5 µm at rest, and 2 µm more at 1 m/s, as 2 µs of jitter would make too.
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal(0.0, 1.0);
  double last_x = 0.0, last_t = 0.0;
  const tests::MadeEffect blur = {{}, [&](double x, double t) {
                                    const double v = t > last_t ? (x - last_x) / (t - last_t) : 0.0;
                                    last_x = x;
                                    last_t = t;
                                    return x + 2e-6 * v * normal(random);
                                  }};
  tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), blur, 5, 1.5e-6);
  const auto of_tracks = diagnosed(made);
  REQUIRE(of_tracks.verdict == diagnose::Verdict::effect);
  CHECK(of_tracks.effects.front().id == "timestamp_jitter");
  for (core::ClipResult& clip : made.results.clips) clip.sightings.resize(1);
  CHECK(diagnosed(made).verdict == diagnose::Verdict::none);
}

TEST_CASE("a drag below zero, which would drive the glider, is a note") {
  const auto drag_of = [](const tests::MadeEffect& effect) -> std::optional<double> {
    const auto diagnosis = diagnosed(tests::made_experiment(tests::made_launches(), effect, 9));
    for (const diagnose::Note& note : diagnosis.notes) {
      const auto* loss = std::get_if<diagnose::NegativeLoss>(&note);
      if (loss != nullptr && loss->of == diagnose::NegativeLoss::Of::drag) return loss->value;
    }
    return {};
  };
  // Driven by 1.3 K v against its drag of K v: -0.3 K is left, or -0.279 N s/m.
  const double k = tests::MadeGlider{}.k_n_s_m;
  const auto driven = drag_of({.force = [k](double, double, double v, double) { return 1.3 * k * v; }});
  REQUIRE(driven);
  CHECK(std::abs(*driven + 0.3 * k) < 0.01 * k);
  CHECK_FALSE(drag_of({}));
}

TEST_CASE("a soft bumper is no hand although friction scatters and no law follows the whole motion to the noise") {
  const auto made = tests::made_with_bumper();
  const diagnose::Diagnosis found = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(found.verdict == diagnose::Verdict::effect);
  REQUIRE(!found.effects.empty());
  CHECK(found.effects.front().id == "end_stop");
  CHECK(found.effects.front().joint_probability + found.effects.front().probability > 0.5);
  const std::vector<diagnose::DiagnosedParameter>& sizes = found.effects.front().parameters;
  REQUIRE(sizes.size() == 2);
  CHECK(sizes[0].key == "k_n_m");
  CHECK(sizes[0].value == Approx(25.0).epsilon(0.03));
  CHECK(sizes[1].key == "x_b_m");
  CHECK(sizes[1].value == Approx(0.35).margin(5e-3));
  for (const diagnose::Note& note : found.notes) CHECK(!std::holds_alternative<diagnose::HandLeftOut>(note));
}

TEST_CASE("what is recovered beside a hard bumper is as certain as what the bumper leaves, not as the gap it takes") {
  tests::ScatteringFriction friction(0.02, {0.02, -0.015, 0.01, -0.02});
  tests::MadeEffect both;
  both.force = [&](double m, double x, double v, double t) {
    return friction(m, v, t) - (x > 0.35 ? 120.0 * (x - 0.35) : 0.0);
  };
  const std::vector<tests::MadeLaunch> launches = {
      {0.3, 3.0, 0.2, -1.0}, {0.3, 3.0, -0.6, 0.5}, {0.5, 3.0, 0.2, -0.9}, {0.5, 3.0, -0.6, 0.6}};
  const auto made = tests::made_experiment(launches, both, 3, 5e-6, 160, 40.0, 0.05, 0.0, {.mu = 0.02});
  const diagnose::Diagnosis found = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(found.verdict == diagnose::Verdict::effect);
  CHECK(found.effects.front().joint_probability > 0.5);  // of a bumper or a cable
  REQUIRE(found.levels);
  REQUIRE(found.levels->all > 1e3);  // an excess of 1e6 by which the noise would be negligible
  for (const diagnose::RecoveredConfiguration& one : found.recovered) {
    REQUIRE(one.mu.estimate);
    CHECK(one.mu.estimate->sd < 0.05 * 0.02);
    CHECK(std::abs(one.mu.estimate->value - 0.02) < 4.0 * one.mu.estimate->sd);
  }
}

TEST_CASE("the law without a cable that takes nearly all of the gap does not widen what is recovered beside it") {
  tests::ScatteringFriction friction(0.02, {0.02, -0.02, 0.01, -0.02});
  tests::MadeEffect both;
  both.force = [&](double m, double x, double v, double t) {
    return friction(m, v, t) - (x > 0.1 ? 3.0 * (x - 0.1) : 0.0);
  };
  const std::vector<tests::MadeLaunch> launches = {
      {0.3, 2.5, 0.6, -1.3}, {0.3, 2.5, -0.8, 0.6}, {0.45, 2.5, 0.6, -1.3}, {0.45, 2.5, -0.8, 0.6}};
  const auto made = tests::made_experiment(launches, both, 3, 3e-4, 200, 40.0, 0.05, 0.0, {.mu = 0.02});
  const diagnose::Diagnosis found = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(found.verdict == diagnose::Verdict::effect);
  REQUIRE(found.explained.front().share > 0.99);
  REQUIRE(found.recovered.size() == 2);
  for (const diagnose::RecoveredConfiguration& one : found.recovered) {
    REQUIRE(one.mu.estimate);
    CHECK(one.mu.estimate->sd < 0.1 * 0.02);
    CHECK(std::abs(one.mu.estimate->value - 0.02) < 4.0 * one.mu.estimate->sd);
  }
}
