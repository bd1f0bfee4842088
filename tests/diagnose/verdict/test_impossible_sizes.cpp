#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/verdict_details.h"
#include "diagnose/weigh/fit_odds.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// A fit with one effect whose size is put at this part of its range.
diagnose::MotionFit with_size_at(const diagnose::TrackSet& set, const diagnose::MotionFit& nominal, const char* id,
                                 double part, std::vector<double> start) {
  const std::size_t effect = diagnose::effect_index(id);
  diagnose::MotionFit fit = diagnose::fit_with_effect(
      set, nominal, effect, diagnose::with_effect(set, nominal, effect, std::move(start), {}));
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter == nullptr || globals[g].parameter->slot.parameter != 0) continue;
    fit.at.global[static_cast<Eigen::Index>(g)] =
        globals[g].range.low + part * (globals[g].range.high - globals[g].range.low);
  }
  return fit;
}

diagnose::Diagnosis diagnosed(const tests::MadeExperiment& made) {
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

}  // namespace

TEST_CASE("a size at the end of its range is impossible and costs odds, within the range it is neither") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 1, 2e-4);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  CHECK_FALSE(diagnose::impossible_sizes(nominal));
  diagnose::Comparison comparison;
  comparison.fits = {nominal, with_size_at(set, nominal, "rotational_inertia", 0.2, {0.01}),
                     with_size_at(set, nominal, "rotational_inertia", 1.0, {0.01})};
  diagnose::set_fit_odds(set, comparison);
  CHECK(comparison.fit_odds[2] - comparison.fit_odds[1] == Approx(-std::log(1000.0)).margin(1e-6));
  CHECK_FALSE(diagnose::impossible_sizes(comparison.fits[1]));
  const auto impossible = diagnose::impossible_sizes(comparison.fits[2]);
  REQUIRE(impossible);
  CHECK(impossible->at_end == std::vector<std::string>{"rotational_inertia"});
  CHECK(impossible->negative.empty());
  // At the end at which it has no effect, and a bumper that is too stiff to tell how stiff, are neither.
  CHECK_FALSE(diagnose::impossible_sizes(with_size_at(set, nominal, "rotational_inertia", 0.0, {0.01})));
  CHECK_FALSE(diagnose::impossible_sizes(with_size_at(set, nominal, "end_stop", 1.0, {10.0, 0.2})));
}

TEST_CASE("a friction that is surely negative makes an explanation impossible") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 2, 2e-4);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  diagnose::MotionFit fit = diagnose::fit_nominal(set);
  fit.at.global[1] = 0.0;
  CHECK_FALSE(diagnose::impossible_sizes(fit));
  fit.at.global[1] = -1.0;
  const auto impossible = diagnose::impossible_sizes(fit);
  REQUIRE(impossible);
  REQUIRE(impossible->negative.size() == 1);
  CHECK(impossible->negative.front().of == diagnose::NegativeLoss::Of::friction);
}

TEST_CASE(
    "a friction below zero by three standard deviations drives the glider of the nominal model, by five beside names") {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 2, 2e-4);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  diagnose::MotionFit bowed = with_size_at(set, nominal, "track_bow", 0.0, {0.001});
  const auto drives = [](diagnose::MotionFit& fit, double sds) {
    fit.at.global[1] = -sds * std::sqrt(diagnose::common_covariance(fit)(1, 1));
    return !diagnose::what_drives(fit).empty();
  };
  CHECK_FALSE(drives(nominal, 2.9));
  CHECK(drives(nominal, 3.1));
  CHECK_FALSE(drives(bowed, 4.9));
  CHECK(drives(bowed, 5.1));
}

TEST_CASE("no cause of a fall under a drag of v^0.67 has a size at the end of its range") {
  // 15 g with a terminal velocity of 1 m/s. An inertia of 12 kg and a scale to match follow such positions nearly.
  constexpr double kMass_kg = 0.015, kTerminal_m_s = 1.0;
  tests::MadeEffect drag;
  drag.force = [](double m, double, double v, double) {
    return -m * 9.80665 * std::copysign(std::pow(std::abs(v) / kTerminal_m_s, 0.67), v);
  };
  for (const unsigned seed : {1u, 2u}) {
    CAPTURE(seed);
    const std::vector<tests::MadeLaunch> launches(4, {kMass_kg, 90.0, 0.0, 0.02});
    const tests::MadeExperiment made = tests::made_experiment(launches, drag, seed, 5e-4, 60, 60.0, 0.0, 0.0,
                                                              {.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = 9.80665});
    const diagnose::Diagnosis diagnosis = diagnosed(made);
    CHECK(diagnosis.verdict != diagnose::Verdict::none);
    for (const auto& effect : diagnosis.effects) {
      CAPTURE(effect.id);
      CHECK(std::none_of(effect.parameters.begin(), effect.parameters.end(),
                         [](const auto& parameter) { return parameter.at_end; }));
    }
  }
}

TEST_CASE("what drives a glider is told with the uncertainty of the recovered values, remainder included") {
  // A force that grows downhill: the nominal model takes it for a negative drag, and a remainder leaves that open.
  tests::MadeEffect downhill;
  downhill.force = [](double m, double x, double, double) { return m * (0.4 * x + 0.05 * std::sin(12.0 * x)); };
  std::vector<tests::MadeLaunch> launches;
  for (const double v0_m_s : {0.1, 0.15, 0.2, 0.25}) launches.push_back({0.4, 2.0, -0.4, v0_m_s});
  const tests::MadeExperiment made =
      tests::made_experiment(launches, downhill, 4, 5e-5, 120, 60.0, 0.05, 0.0, {.k_n_s_m = 0.02, .mu = 0.004});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const std::vector<diagnose::NegativeLoss> by_noise = diagnose::what_drives(nominal);
  REQUIRE(by_noise.size() == 1);
  REQUIRE(by_noise.front().of == diagnose::NegativeLoss::Of::drag);
  diagnose::Diagnosis diagnosis;
  diagnosis.limits.driving = by_noise;
  diagnosis.notes = {diagnose::OnlyFalls{}, by_noise.front()};
  const diagnose::RemainderSizes sizes = diagnose::RemainderSpace(set, nominal).likeliest().sizes;
  const auto beside = diagnose::RemainderSpace(set, nominal).solve(sizes);
  diagnose::count_remainder(set, nominal, sizes, diagnosis);
  CHECK(diagnosis.notes.size() == 1 + diagnosis.limits.driving.size());
  CHECK(std::holds_alternative<diagnose::OnlyFalls>(diagnosis.notes.front()));
  for (const diagnose::NegativeLoss& loss : diagnosis.limits.driving) {
    const Eigen::Index g = loss.of == diagnose::NegativeLoss::Of::drag ? 0 : 1;
    CHECK(loss.value == Approx(nominal.at.global[g] + beside.change[g]));
    CHECK(loss.sd >= std::sqrt(beside.covariance(g, g)) * (1.0 - 1e-9));
    CHECK(loss.value < -3.0 * loss.sd);
  }
  // Without a remainder it is what the noise alone says.
  diagnose::count_remainder(set, nominal, {}, diagnosis);
  REQUIRE(diagnosis.limits.driving.size() == 1);
  CHECK(diagnosis.limits.driving.front().value == Approx(by_noise.front().value).epsilon(0.02));
}
