#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/verdict/verdict.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// A small experiment that only provides a set: the compared hypotheses are put in by hand.
const diagnose::TrackSet& small_set() {
  static const diagnose::TrackSet set = [] {
    const auto made = tests::made_experiment({{0.4, 0.0, 0.5, -1.2}, {0.4, 4.0, -0.6, 1.2}}, {}, 1, 3e-5, 80);
    return diagnose::track_set(made.results, made.setups, true);
  }();
  return set;
}

diagnose::Hypothesis only(std::string_view id, double probability, double log_evidence, double gain) {
  diagnose::Hypothesis hypothesis;
  hypothesis.effects = {diagnose::effect_index(id)};
  hypothesis.probability = probability;
  hypothesis.log_evidence = log_evidence;
  hypothesis.gain = gain;
  return hypothesis;
}

diagnose::Diagnosis verdict_on(std::vector<diagnose::Hypothesis> all) {
  diagnose::Comparison comparison;
  comparison.fits.push_back(diagnose::fit_nominal(small_set()));
  comparison.scans.resize(diagnose::effect_list().size());
  comparison.all = std::move(all);
  diagnose::set_probabilities(comparison);
  return diagnose::verdict_of(small_set(), comparison);
}

/// Whether these data are said not to tell quadratic drag from a tether.
bool alike(double less_log_evidence, double less_gain) {
  const auto diagnosis =
      verdict_on({only(diagnose::ids::tether, 0.9, 50.0, 60.0),
                  only(diagnose::ids::quadratic_drag, 0.1, 50.0 - less_log_evidence, 60.0 - less_gain)});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(diagnosis.effects.front().id == diagnose::ids::tether);
  const std::vector<std::string>& others = diagnosis.effects.front().equivalent_to;
  return std::find(others.begin(), others.end(), diagnose::ids::quadratic_drag) != others.end();
}

}  // namespace

TEST_CASE("an effect that an explanation lacks is not told apart from nothing in it, least of all from itself") {
  diagnose::Hypothesis best = only(diagnose::ids::tether, 0.9, 50.0, 60.0);
  best.effects.push_back(diagnose::effect_index(diagnose::ids::lens_distortion));
  diagnose::Comparison comparison;
  comparison.all = {best, only(diagnose::ids::damping_gradient, 0.1, 50.0, 60.0)};
  CHECK(diagnose::not_told_apart(comparison, best, diagnose::effect_index(diagnose::ids::damping_gradient), false)
            .empty());
}

TEST_CASE("effects are alike down to a twentieth of the likelihood and a hundredth of the evidence, and no farther") {
  CHECK(alike(0.0, 0.0));
  CHECK(alike(0.9 * std::log(100.0), 0.0));
  CHECK(alike(0.0, 0.9 * std::log(20.0)));
  CHECK_FALSE(alike(1.1 * std::log(100.0), 0.0));
  CHECK_FALSE(alike(0.0, 1.1 * std::log(20.0)));
}

TEST_CASE("effects are alike only if they take the same part of the gap, and scatter is alike to no law") {
  const auto alike = [](std::string_view id, double left) {
    diagnose::Hypothesis tether = only(diagnose::ids::tether, 0.9, 50.0, 60.0), other = only(id, 0.1, 50.0, 60.0);
    tether.left = 0.1;
    other.left = left;
    return !verdict_on({tether, other}).effects.front().equivalent_to.empty();
  };
  // Odds of 20 for what is left, with log odds of 12.5 for a whole excess (cause_odds.h): 0.24.
  CHECK(alike(diagnose::ids::quadratic_drag, 0.1 + 0.9 * std::log(20.0) / 12.5));
  CHECK_FALSE(alike(diagnose::ids::quadratic_drag, 0.1 + 1.1 * std::log(20.0) / 12.5));
  CHECK_FALSE(alike(diagnose::ids::heavy_tailed_noise, 0.1));
}

TEST_CASE("explanations that a page gives no chance are ordered by evidence, all others by probability") {
  // A page shows "< 0.001" for what rounds to 0.000: half of that.
  const auto order = [](double second, double third) {
    const auto diagnosis = verdict_on({only(diagnose::ids::tether, 1.0 - second - third, 50.0, 60.0),
                                       only(diagnose::ids::quadratic_drag, second, 20.0, 30.0),
                                       only(diagnose::ids::track_bow, third, 40.0, 50.0)});
    std::vector<std::string> ids;
    for (const auto& ranked : diagnosis.ranking) ids.push_back(ranked.explanation.effects.front());
    return ids;
  };
  using Ids = std::vector<std::string>;
  CHECK(order(4e-4, 3e-4) == Ids{"tether", "track_bow", "quadratic_drag"});
  CHECK(order(6e-4, 3e-4) == Ids{"tether", "quadratic_drag", "track_bow"});
  CHECK(order(2e-2, 1e-2) == Ids{"tether", "quadratic_drag", "track_bow"});
}
