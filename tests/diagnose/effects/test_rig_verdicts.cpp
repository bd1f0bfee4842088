// Effects of test rigs: in an experiment with one such effect, simulated by the tests' own generator, it is named with
// its size.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

using tests::MadeEffect;
using tests::MadeLaunch;
constexpr tests::MadeGlider kGlider;

double sign_of(double v) {
  return v < 0.0 ? -1.0 : 1.0;
}

/// The force of a motor that pulls back and forth, linear over each tenth of a second, so that samples at 50 Hz are
/// exact.
double pull_n(double t) {
  const auto at = [](double tenths) { return 0.25 * std::sin(0.7 * tenths) + 0.15 * std::sin(1.7 * tenths); };
  const double before = std::floor(10.0 * t + 1e-9), part = 10.0 * t - before;
  return (1.0 - part) * at(before) + part * at(before + 1.0);
}

diagnose::Diagnosis diagnosed(const std::vector<MadeLaunch>& launches, const MadeEffect& effect, unsigned seed,
                              std::vector<std::string> without = {}) {
  const auto made = tests::made_experiment(launches, effect, seed, 2e-5, 75, 50.0);
  return diagnose::diagnose_results(made.results, made.setups, {.without = std::move(without), .jobs = 2});
}

/// The effect is named with a probability above 0.9, its size is right to three standard deviations, and one of these
/// is less than a fifth of it.
void check_named(const diagnose::Diagnosis& diagnosis, const std::string& id, const std::string& key, double size) {
  INFO(id);
  std::string ranking;
  for (const auto& ranked : diagnosis.ranking) {
    if (ranked.probability < 1e-3) continue;
    for (const auto& one : ranked.explanation.effects) ranking += one + " ";
    ranking += fmt::format("{:.4f}, evidence {:.2f}\n", ranked.probability, ranked.log_evidence_gain);
  }
  INFO(ranking);
  INFO("none " << diagnosis.none << " unknown " << diagnosis.unknown);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(diagnosis.effects.size() == 1);
  CHECK(diagnosis.effects.front().id == id);
  CHECK(diagnosis.effects.front().probability > 0.9);
  const auto& parameters = diagnosis.effects.front().parameters;
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.key == key; });
  REQUIRE(found != parameters.end());
  INFO(key << " " << found->value << " +- " << found->sd);
  CHECK(std::abs(found->value - size) < 3.0 * found->sd);
  CHECK(found->sd < 0.2 * std::abs(size));
}

/// K/m and µ of each configuration are recovered to four of their standard deviations (one in a thousand of these
/// sixteen lies farther off by chance). K/m is known to 2 % of itself: what a configuration has of its own counts, and
/// not how far another one might differ.
void check_recovered(const diagnose::Diagnosis& diagnosis, const std::vector<MadeLaunch>& launches) {
  for (const auto& one : diagnosis.recovered) {
    INFO(one.group << ", " << one.mass_kg << " kg");
    const auto made = std::find_if(launches.begin(), launches.end(), [&](const MadeLaunch& launch) {
      return launch.mass_kg == one.mass_kg && std::abs(launch.incline_deg - one.incline_deg) < 0.5;
    });
    REQUIRE(made != launches.end());
    REQUIRE(one.k_over_m_1_s.estimate);
    REQUIRE(one.mu.estimate);
    const core::Estimate rate = *one.k_over_m_1_s.estimate, mu = *one.mu.estimate;
    const double true_rate = (kGlider.k_n_s_m + made->k_more_n_s_m) / made->mass_kg;
    INFO("K/m " << rate.value << " +- " << rate.sd << ", true " << true_rate);
    CHECK(std::abs(rate.value - true_rate) < 4.0 * rate.sd);
    CHECK(rate.sd < 0.02 * true_rate);
    INFO("mu " << mu.value << " +- " << mu.sd << ", true " << kGlider.mu + made->mu_more);
    CHECK(std::abs(mu.value - kGlider.mu - made->mu_more) < 4.0 * mu.sd);
  }
}

/// Standard deviation about the mean, with n - 1.
double sd_of(const std::vector<double>& values) {
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean);
  return std::sqrt(square / static_cast<double>(values.size() - 1));
}

/// Twelve clips: the eight, and four of them again.
std::vector<MadeLaunch> twelve() {
  std::vector<MadeLaunch> launches = tests::made_launches();
  for (const std::size_t again : {2u, 3u, 4u, 5u}) {
    launches.push_back(launches[again]);
    launches.back().v0_m_s *= 0.8;
  }
  return launches;
}

/// Index of the configuration of a launch of made_launches().
std::size_t configuration(const MadeLaunch& launch) {
  return (launch.mass_kg > 0.4 ? 2u : 0u) + (launch.incline_deg > 0.0 ? 1u : 0u);
}

}  // namespace

TEST_CASE("a drag that depends on the direction is named, with K for each direction") {
  const MadeEffect directed{
      .force = [](double, double, double v, double) { return -0.05 * kGlider.k_n_s_m * std::abs(v); }};
  const diagnose::Diagnosis diagnosis = diagnosed(tests::made_launches(), directed, 5);
  check_named(diagnosis, "direction_dependent_drag", "d", 0.05);
  check_named(diagnosis, "direction_dependent_drag", "k_plus_n_s_m", 1.05 * kGlider.k_n_s_m);
  check_named(diagnosis, "direction_dependent_drag", "k_minus_n_s_m", 0.95 * kGlider.k_n_s_m);
}

TEST_CASE("a soft bumper at the uphill end is named, which no cable can be") {
  std::vector<MadeLaunch> launches = tests::made_launches();
  for (const double mass : {0.335, 0.535}) launches.push_back({mass, 4.0, -0.3, -1.3});
  const MadeEffect stop{.force = [](double, double x, double, double) { return x < -0.5 ? -2.0 * (x + 0.5) : 0.0; }};
  const diagnose::Diagnosis diagnosis = diagnosed(launches, stop, 5);
  check_named(diagnosis, "end_stop", "k_n_m", 2.0);
  check_named(diagnosis, "end_stop", "x_b_m", -0.5);
}

TEST_CASE("with a recorded force, a wrong mass is named together with a wrong scale, from which nothing can tell it") {
  std::vector<MadeLaunch> inert = tests::made_launches();
  for (MadeLaunch& launch : inert) launch.inertia = 1.04;
  const diagnose::Diagnosis diagnosis = diagnosed(inert, {.recorded = pull_n}, 5);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(diagnosis.effects.size() == 1);
  const diagnose::DiagnosedEffect& named = diagnosis.effects.front();
  std::set<std::string> ids = {named.id};
  ids.insert(named.equivalent_to.begin(), named.equivalent_to.end());
  CHECK(ids == std::set<std::string>{"mass_error", "scale_error", "frame_rate_error"});
  CHECK(named.joint_probability > 0.9);
  const diagnose::Diagnosis mass = diagnosed(inert, {.recorded = pull_n}, 5, {"scale_error", "frame_rate_error"});
  check_named(mass, "mass_error", "e", 0.04);
}

TEST_CASE("a recorded force that is too small and one that is late are told apart") {
  const MadeEffect gain{.force = [](double, double, double, double t) { return 0.05 * pull_n(t); }, .recorded = pull_n};
  check_named(diagnosed(tests::made_launches(), gain, 5), "force_gain", "e", 0.05);
  const MadeEffect late{.force = [](double, double, double, double t) { return pull_n(t - 0.004) - pull_n(t); },
                        .recorded = pull_n};
  check_named(diagnosed(tests::made_launches(), late, 5), "force_delay", "tau_s", 0.004);
}

TEST_CASE("a friction that drifts from clip to clip is named") {
  std::vector<MadeLaunch> launches = twelve();
  std::rotate(launches.begin(), launches.begin() + 5,
              launches.end());  // so that neither mass nor set-up follows the number
  for (std::size_t n = 0; n < launches.size(); ++n) launches[n].mu_more = 0.03 * static_cast<double>(n) * kGlider.mu;
  check_named(diagnosed(launches, {}, 5), "friction_drift", "r_1_clip", 0.03);
}

TEST_CASE("friction or drag of each configuration is named, with the size of each") {
  const std::vector<double> mu_more = {0.0008, -0.0005, 0.0004, -0.0007};
  std::vector<MadeLaunch> launches = tests::made_launches();
  for (MadeLaunch& launch : launches) launch.mu_more = mu_more[configuration(launch)];
  const diagnose::Diagnosis friction = diagnosed(launches, {}, 5);
  check_named(friction, "configuration_friction", "sd", sd_of(mu_more));
  check_named(friction, "configuration_friction", "mu.level, 0.335 kg", kGlider.mu + 0.0008);
  check_named(friction, "configuration_friction", "mu.inclined, 0.535 kg", kGlider.mu - 0.0007);
  check_recovered(friction, launches);
  const std::vector<double> k_more = {0.05, -0.04, 0.02, -0.03};
  for (MadeLaunch& launch : launches) {
    launch.mu_more = 0.0;
    launch.k_more_n_s_m = k_more[configuration(launch)];
  }
  const diagnose::Diagnosis drag = diagnosed(launches, {}, 5);
  check_named(drag, "configuration_drag", "sd_n_s_m", sd_of(k_more));
  check_named(drag, "configuration_drag", "k_n_s_m.inclined, 0.335 kg", kGlider.k_n_s_m - 0.04);
  check_recovered(drag, launches);
}

TEST_CASE("friction and drag that scatter from clip to clip are named, with their spread") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<MadeLaunch> launches = twelve();
  std::vector<double> mu, k;
  for (MadeLaunch& launch : launches) {
    mu.push_back(launch.mu_more = 0.0008 * normal(random));
    k.push_back(launch.k_more_n_s_m = 0.03 * normal(random));
  }
  const diagnose::Diagnosis diagnosis = diagnosed(launches, {}, 5);
  check_named(diagnosis, "clip_scatter", "sd_mu", sd_of(mu));
  check_named(diagnosis, "clip_scatter", "sd_k_n_s_m", sd_of(k));
}

TEST_CASE("a friction that changes along the track is named, with its size and place") {
  const auto s = [](double x) { return 0.5 * std::sin(std::numbers::pi * (x + 0.6) / 0.7); };
  const MadeEffect along{.force = [&](double m, double x, double v, double) {
    return -sign_of(v) * kGlider.mu * s(x) * m * kGlider.gravity_m_s2;
  }};
  const diagnose::Diagnosis diagnosis = diagnosed(twelve(), along, 5);
  // s has the mean 0 over the range of positions, and mu is the mean friction.
  double low = 0.0, high = 0.0, mean = 0.0, square = 0.0;
  for (const MadeLaunch& launch : twelve()) {
    for (const double x : tests::made_motion(kGlider, launch, along, 75, 50.0)) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  constexpr int kParts = 1000;
  const auto place = [&](int i) { return low + (high - low) * (i + 0.5) / kParts; };
  for (int i = 0; i < kParts; ++i) mean += s(place(i)) / kParts;
  const auto less_mean = [&](double x) { return (1.0 + s(x)) / (1.0 + mean) - 1.0; };
  for (int i = 0; i < kParts; ++i) square += less_mean(place(i)) * less_mean(place(i)) / kParts;
  check_named(diagnosis, "place_friction", "sd", std::sqrt(square));
  for (const auto& told : diagnosis.effects.front().parameters) {
    if (!told.key.starts_with("s.at ")) continue;
    INFO(told.key << " " << told.value << " +- " << told.sd);
    // Six bumps fit a sine wave of one and a half periods to a few hundredths.
    CHECK(std::abs(told.value - less_mean(std::stod(told.key.substr(5)))) < 3.0 * told.sd + 0.03);
  }
}
