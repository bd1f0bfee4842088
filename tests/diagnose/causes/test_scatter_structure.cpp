#include "diagnose/causes/scatter_structure.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "diagnose/causes/further_causes.h"
#include "diagnose/causes/spread_prior.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Nine clips up and down a slope, three of each of three masses in turn or all of one, with these frictions.
tests::MadeExperiment with_frictions(const std::vector<double>& mu, bool three_masses, unsigned seed) {
  std::vector<tests::MadeLaunch> launches;
  for (std::size_t c = 0; c < mu.size(); ++c) {
    tests::MadeLaunch launch;
    launch.mass_kg = three_masses ? 0.3 + 0.1 * static_cast<double>(c / 3) : 0.4;
    launch.mu_more = mu[c] - 0.006;
    launches.push_back(launch);
  }
  return tests::made_experiment(launches, {}, seed, 1e-4, 150, 100.0);
}

double scattered(std::mt19937_64& random, double sd) {
  return std::normal_distribution<double>(0.0, sd)(random);
}

std::vector<std::string> names(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> ids;
  for (const auto& effect : diagnosis.effects) ids.push_back(effect.id);
  return ids;
}

diagnose::Diagnosis diagnosed(const tests::MadeExperiment& made) {
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

/// The gain of each structure for clips of these frictions.
double gain(const tests::MadeExperiment& made, std::string_view effect) {
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const auto clips = diagnose::with_clip_scatter(set, diagnose::fit_nominal(set));
  REQUIRE(clips);
  const auto found = diagnose::gain_of_structure(set, *clips, {}, diagnose::effect_index(effect));
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("sizes with a part in common are likelier with it, and independent ones without") {
  // Six sizes in two groups, known to 0.01: N(s; 0, C + W) by hand, at the widths that the search tries.
  const Eigen::MatrixXd covariance = 1e-4 * Eigen::MatrixXd::Identity(6, 6);
  const std::vector<std::size_t> kinds(6, 0);
  diagnose::SharedPart shared{0, Eigen::MatrixXd::Zero(6, 6)};
  shared.shape.topLeftCorner(3, 3).setOnes();
  shared.shape.bottomRightCorner(3, 3).setOnes();
  const auto gained = [&](const Eigen::VectorXd& sizes) {
    return diagnose::log_spread_prior(sizes, covariance, kinds, &shared) -
           diagnose::log_spread_prior(sizes, covariance, kinds);
  };
  Eigen::VectorXd grouped(6), mixed(6);
  grouped << 1.0, 1.01, 0.99, -1.0, -1.02, -0.98;
  mixed << 1.0, -1.01, 0.99, -1.0, 1.02, -0.98;
  // Apart: six sizes of width 1. Together: two of width 1, and four of 0.02, each likelier by ln(1/0.02) or so.
  CHECK(gained(grouped) > 4.0 * std::log(1.0 / 0.05));
  CHECK(gained(mixed) < 0.0);
}

TEST_CASE("a drift of friction, or a friction of each configuration, shows through clips that scatter about it") {
  struct Structure {
    std::string_view effect;
    bool three_masses = false;
    double (*mu)(int clip) = nullptr;
    double scatter = 0.0;
  };
  const std::vector<Structure> structures = {
      {diagnose::ids::friction_drift, false, [](int c) { return 0.006 * (1.0 + 0.08 * c); }, 1.2e-4},
      {diagnose::ids::configuration_friction, true, [](int c) { return c < 3   ? 0.0068
                                                                       : c < 6 ? 0.0042
                                                                               : 0.0080; },
       1.5e-4}};
  for (const Structure& structure : structures) {
    std::mt19937_64 random(5);
    for (const unsigned seed : {1u, 2u, 3u}) {
      CAPTURE(structure.effect, seed);
      std::vector<double> mu;
      for (int c = 0; c < 9; ++c) mu.push_back(structure.mu(c) + scattered(random, structure.scatter));
      const tests::MadeExperiment made = with_frictions(mu, structure.three_masses, seed);
      CHECK(gain(made, structure.effect) > 5.0);
      const std::vector<std::string> named = names(diagnosed(made));
      REQUIRE_FALSE(named.empty());
      CHECK(named.front() == structure.effect);
    }
  }
}

TEST_CASE("clips that scatter at random follow neither") {
  std::mt19937_64 random(7);
  int drifts = 0, configurations = 0;
  constexpr int kSets = 12;
  for (unsigned seed = 1; seed <= kSets; ++seed) {
    std::vector<double> mu;
    for (int c = 0; c < 9; ++c) mu.push_back(0.006 + scattered(random, 0.001));
    const tests::MadeExperiment made = with_frictions(mu, true, seed);
    drifts += gain(made, diagnose::ids::friction_drift) > 2.0 ? 1 : 0;
    configurations += gain(made, diagnose::ids::configuration_friction) > 2.0 ? 1 : 0;
  }
  // Odds of more than e² against the truth come up in less than e^-2 of all sets: 1.6 of 12.
  CHECK(drifts <= 4);
  CHECK(configurations <= 4);
}
