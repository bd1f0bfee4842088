#include "diagnose/causes/cause_odds.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// A comparison of nothing, something without a name, and two effects (fits 1 and 2).
diagnose::Comparison comparison_of(double unnamed, double first, double second) {
  diagnose::Comparison comparison;
  comparison.fits.resize(3);
  comparison.all.push_back({{}, false, 0.0, 0.0, 0.0, 0});
  comparison.all.push_back({{}, true, 0.0, unnamed, 0.0, 0});
  comparison.all.push_back({{diagnose::effect_index(diagnose::ids::quadratic_drag)}, false, 0.0, first, 0.0, 1});
  comparison.all.push_back({{diagnose::effect_index(diagnose::ids::track_bow)}, false, 0.0, second, 0.0, 2});
  return comparison;
}

double probability_of(const diagnose::Comparison& comparison, std::string_view id) {
  return comparison.effect_probability[diagnose::effect_index(id)];
}

}  // namespace

TEST_CASE("of two causes with the same evidence the one that leaves less of the gap is likelier") {
  diagnose::Comparison comparison = comparison_of(20.0, 20.0, 20.0);
  diagnose::weigh_beside_remainder({{10.0, 0.5, 5.0}, kNotMeasured}, comparison);
  double sum = 0.0;
  for (const diagnose::Hypothesis& one : comparison.all) sum += one.probability;
  CHECK(sum == Approx(1.0).epsilon(1e-12));
  CHECK(comparison.none + comparison.unknown + probability_of(comparison, diagnose::ids::quadratic_drag) +
            probability_of(comparison, diagnose::ids::track_bow) ==
        Approx(1.0).epsilon(1e-12));
  CHECK(comparison.all.front().fit == 1);
  CHECK(probability_of(comparison, diagnose::ids::quadratic_drag) >
        10.0 * probability_of(comparison, diagnose::ids::track_bow));
}

TEST_CASE("log odds are linear in what is left") {
  const auto log_odds = [](double left) {
    diagnose::Comparison comparison = comparison_of(-30.0, 0.0, 0.0);
    diagnose::weigh_beside_remainder({{10.0, 0.0, 10.0 * left}, kNotMeasured}, comparison);
    return std::log(probability_of(comparison, diagnose::ids::quadratic_drag) /
                    probability_of(comparison, diagnose::ids::track_bow));
  };
  CHECK(log_odds(0.0) == Approx(0.0).margin(1e-9));
  CHECK(log_odds(0.4) == Approx(2.0 * log_odds(0.2)).epsilon(1e-9));
  CHECK(log_odds(1.0) == Approx(5.0 * log_odds(0.2)).epsilon(1e-9));
  CHECK(log_odds(3.0) == Approx(log_odds(1.0)).epsilon(1e-9));  // a cause that makes the gap worse leaves all of it
}

TEST_CASE("where the noise is negligible the odds count decades of what is left, and no evidence") {
  const auto odds = [](double evidence, double first, double second) {
    diagnose::Comparison comparison = comparison_of(0.0, 0.0, evidence);
    constexpr double kBefore = 1e15;
    diagnose::weigh_beside_remainder({{kBefore, first * kBefore, second * kBefore}, kNotMeasured}, comparison);
    return probability_of(comparison, diagnose::ids::quadratic_drag) /
           probability_of(comparison, diagnose::ids::track_bow);
  };
  CHECK(odds(0.0, 1e-4, 1e-4) == Approx(1.0));
  CHECK(odds(1e4, 1e-4, 1e-4) == Approx(1.0));
  // A hundred times less left: ten to one, beside what the parts themselves say (12.5 of 1e-2 and 1e-4).
  CHECK(odds(0.0, 1e-4, 1e-2) == Approx(10.0 * std::exp(12.5 * (1e-2 - 1e-4))));
  CHECK(odds(0.0, 1e-9, 1e-4) == Approx(odds(0.0, 1e-6, 1e-4)).epsilon(1e-4));  // the excess is a measure to 1e-6
}

TEST_CASE("the gap of a fall without drag is a measure of the quadratic drag alone") {
  // Both leave 0.9 of the nominal excess. That of a fall without drag is a thousand times as large.
  const auto weighed = [](std::optional<double> without_drag) {
    diagnose::Comparison comparison = comparison_of(0.0, 0.0, 0.0);
    diagnose::weigh_beside_remainder({{1.25, 1.125, 1.125}, kNotMeasured, without_drag}, comparison);
    return comparison;
  };
  const auto bow_to_nothing = [](const diagnose::Comparison& of) {
    return probability_of(of, diagnose::ids::track_bow) / of.none;
  };
  const diagnose::Comparison before = weighed({}), after = weighed(1250.0);
  CHECK(bow_to_nothing(after) == Approx(bow_to_nothing(before)).epsilon(1e-9));
  CHECK(probability_of(before, diagnose::ids::quadratic_drag) ==
        Approx(probability_of(before, diagnose::ids::track_bow)).epsilon(1e-9));
  CHECK(probability_of(after, diagnose::ids::quadratic_drag) >
        100.0 * probability_of(after, diagnose::ids::track_bow));  // 12.5 (0.9 - 0.0009) in log odds, and more for E
}

TEST_CASE("beside the drag of air a further cause counts by what the drag leaves of the gap") {
  // Of a fall without drag both leave next to nothing. The drag alone leaves 50, the drag with the bow `left` of it.
  const auto log_odds = [](double left) {
    diagnose::Comparison comparison = comparison_of(-1000.0, 0.0, -1000.0);
    diagnose::Hypothesis both = comparison.all[2];
    both.effects.push_back(diagnose::effect_index(diagnose::ids::track_bow));
    both.fit = 3;
    comparison.fits.resize(4);
    comparison.all.push_back(both);
    diagnose::weigh_beside_remainder({{80.0, 50.0, 80.0, left}, kNotMeasured, 3e5}, comparison);
    double of_both = 0.0, alone = 0.0;
    for (const diagnose::Hypothesis& one : comparison.all) {
      if (one.fit == 3) of_both = one.probability;
      if (one.fit == 1) alone = one.probability;
    }
    return std::log(of_both / alone);
  };
  // 1.1 + 0.8 log E - 12.5 r with E at its limit of 10 (docs/reference/weighing.md).
  for (const double left : {0.0, 5.0, 20.0})
    CHECK(log_odds(left) == Approx(1.1 + 0.8 * std::log(10.0) - 12.5 * left / 50.0).margin(1e-6));
}

TEST_CASE("evidence beside a remainder gives no certainty") {
  // 60 more in log evidence: 1e26 to one by the noise alone.
  diagnose::Comparison comparison = comparison_of(-1000.0, 60.0, 0.0);
  diagnose::weigh_beside_remainder({{10.0, 2.0, 2.0}, kNotMeasured}, comparison);
  const double behind = probability_of(comparison, diagnose::ids::track_bow);
  CHECK(behind > 1e-6);
  CHECK(behind < 0.05);
  // The odds fall with a power of the difference in evidence: from 1e3 to 1e4, and from 1e4 to 1e5, by the same factor.
  const auto odds = [](double ahead) {
    diagnose::Comparison far = comparison_of(-1000.0, ahead, 0.0);
    diagnose::weigh_beside_remainder({{10.0, 2.0, 2.0}, kNotMeasured}, far);
    return probability_of(far, diagnose::ids::track_bow) / probability_of(far, diagnose::ids::quadratic_drag);
  };
  CHECK(odds(1e5) / odds(1e4) == Approx(odds(1e4) / odds(1e3)).epsilon(0.03));
}

TEST_CASE("if a cause leaves nothing, a function without a name needs much more evidence than that cause") {
  diagnose::Comparison comparison = comparison_of(30.0, 20.0, 0.0);
  diagnose::weigh_beside_remainder({{10.0, 0.3, 8.0}, kNotMeasured}, comparison);
  CHECK(comparison.unknown < 0.4);
  diagnose::Comparison far = comparison_of(3000.0, 20.0, 0.0);
  diagnose::weigh_beside_remainder({{10.0, 3.0, 8.0}, kNotMeasured}, far);
  CHECK(far.unknown > 0.9);
}

TEST_CASE("a function without a name that leaves less than any cause is the likeliest") {
  const auto unknown = [](double left) {
    diagnose::Comparison comparison = comparison_of(40.0, 20.0, 0.0);
    diagnose::weigh_beside_remainder({{10.0, 3.0, 8.0}, left}, comparison);
    return comparison.unknown;
  };
  CHECK(unknown(0.2) > 0.9);
  CHECK(unknown(9.0) == Approx(unknown(10.0)).epsilon(1e-9));  // leaving all of the gap does not help it
  CHECK(unknown(2.0) < unknown(1.0));
}

TEST_CASE("a function without a name beside a cause counts towards the cause") {
  diagnose::Comparison comparison = comparison_of(0.0, 20.0, 0.0);
  diagnose::Hypothesis with = comparison.all[2];
  with.unnamed = true;
  with.log_evidence = 40.0;
  comparison.all.push_back(with);
  diagnose::weigh_beside_remainder({{10.0, 0.5, 8.0}, kNotMeasured}, comparison);
  CHECK(comparison.unknown < 0.1);
  CHECK(probability_of(comparison, diagnose::ids::quadratic_drag) > 0.8);
}

TEST_CASE("a hand that lets go late has odds against it, since it follows each clip") {
  const auto with_second = [](std::string_view id) {
    diagnose::Comparison comparison = comparison_of(0.0, 20.0, 20.0);
    comparison.all.back().effects = {diagnose::effect_index(id)};
    diagnose::weigh_beside_remainder({{10.0, 1.0, 1.0}, kNotMeasured}, comparison);
    return probability_of(comparison, id) / probability_of(comparison, diagnose::ids::quadratic_drag);
  };
  CHECK(with_second(diagnose::ids::track_bow) == Approx(1.0).epsilon(1e-9));
  CHECK(with_second(diagnose::ids::late_release) < 0.2);
}

TEST_CASE("scatter of single positions is no other explanation of a gap, however strong its evidence") {
  const diagnose::Comparison pure = [] {
    diagnose::Comparison comparison = comparison_of(0.0, 20.0, 15.0);
    diagnose::weigh_beside_remainder({{10.0, 0.5, 2.0}, kNotMeasured}, comparison);
    return comparison;
  }();
  // Outliers were sought only beside nothing and beside the second effect.
  diagnose::Comparison comparison = comparison_of(0.0, 20.0, 15.0);
  const std::size_t tails = diagnose::effect_index(diagnose::ids::heavy_tailed_noise);
  for (const std::size_t of : {0u, 3u}) {
    diagnose::Hypothesis with = comparison.all[of];
    with.effects.push_back(tails);
    with.log_evidence += 140.0;
    comparison.all.push_back(with);
  }
  diagnose::weigh_beside_remainder({{10.0, 0.5, 2.0}, kNotMeasured}, comparison);
  for (const char* id : {diagnose::ids::quadratic_drag, diagnose::ids::track_bow}) {
    CHECK(probability_of(comparison, id) == Approx(probability_of(pure, id)).epsilon(1e-9));
  }
  CHECK(comparison.none == Approx(pure.none).epsilon(1e-9));
  CHECK(comparison.unknown == Approx(pure.unknown).epsilon(1e-9));
  // The second effect has its outliers.
  CHECK(probability_of(comparison, diagnose::ids::heavy_tailed_noise) > 0.9 * probability_of(pure, "track_bow"));
  // Beside the gap of an encoder the noise is negligible, and so is the evidence of its tails.
  diagnose::weigh_beside_remainder({{1e8, 5e6, 2e7}, kNotMeasured}, comparison);
  CHECK(probability_of(comparison, diagnose::ids::heavy_tailed_noise) <
        0.2 * probability_of(comparison, diagnose::ids::track_bow));
}

TEST_CASE("however huge the gap, evidence counts once an explanation leaves little of it") {
  const auto bow_over_drag = [](double left_by_drag, double evidence_of_bow) {
    diagnose::Comparison comparison = comparison_of(-1e3, 0.0, evidence_of_bow);
    diagnose::weigh_beside_remainder({{1e12, left_by_drag, 1.5 * left_by_drag}, kNotMeasured}, comparison);
    return probability_of(comparison, diagnose::ids::track_bow) /
           probability_of(comparison, diagnose::ids::quadratic_drag);
  };
  CHECK(bow_over_drag(4.0, 200.0) > 100.0);
  CHECK(bow_over_drag(4.0, -200.0) < 0.01);
  // Where all leave a gap beside which the noise is negligible, only what they leave counts.
  CHECK(bow_over_drag(1e9, 200.0) == Approx(bow_over_drag(1e9, -200.0)).epsilon(1e-9));
}

TEST_CASE("a cause on the list may be imitated by one that is not: no name is certain") {
  diagnose::Comparison comparison = comparison_of(0.0, 1e6, 0.0);
  diagnose::weigh_beside_remainder({{100.0, 0.0, 90.0}, kNotMeasured}, comparison);
  // Prior odds of 0.2 to 0.5, and a fifth of it imitated.
  CHECK(probability_of(comparison, diagnose::ids::quadratic_drag) == Approx(1.0 - 0.2 * 0.2 / 0.5).margin(1e-4));
  CHECK(comparison.unknown == Approx(0.2 * 0.2 / 0.5).margin(1e-4));
  // The same where no function without a name was weighed.
  diagnose::Comparison without = comparison_of(0.0, 1e6, 0.0);
  without.all.erase(without.all.begin() + 1);
  diagnose::weigh_beside_remainder({{100.0, 0.0, 90.0}, kNotMeasured}, without);
  CHECK(without.unknown == Approx(0.2 * 0.2 / 0.5).margin(1e-4));
}

TEST_CASE("each explanation says which part of the excess it leaves") {
  diagnose::Comparison comparison = comparison_of(0.0, 20.0, 20.0);
  diagnose::weigh_beside_remainder({{10.0, 2.5, 40.0}, kNotMeasured}, comparison);
  for (const diagnose::Hypothesis& one : comparison.all) {
    REQUIRE(one.left);
    CHECK(*one.left == Approx(one.fit == 1 ? 0.25 : 1.0));
  }
}

TEST_CASE("beside clips that scatter a cause that statements show has the evidence that it has without them") {
  // The odds of a bow with clip scatter against those of clip scatter alone. Both leave nothing.
  const auto odds = [](double with_scatter, bool by_stated) {
    diagnose::Comparison comparison = comparison_of(-1000.0, 0.0, 40.0);
    const std::size_t scatter = diagnose::effect_index(diagnose::ids::clip_scatter);
    comparison.all[2].effects = {scatter};
    comparison.all.push_back({{comparison.all[3].effects.front(), scatter}, false, 0.0, with_scatter, 0.0, 3});
    comparison.fits.resize(4);
    if (by_stated) comparison.by_stated = {diagnose::effect_index(diagnose::ids::track_bow)};
    diagnose::weigh_beside_remainder({{10.0, 0.0, 9.0, 0.0}, kNotMeasured}, comparison);
    double pair = 0.0, alone = 0.0;
    for (const diagnose::Hypothesis& one : comparison.all) {
      if (one.fit == 3) pair = one.probability;
      if (one.fit == 1) alone = one.probability;
    }
    return pair / alone;
  };
  CHECK(odds(-20.0, true) == Approx(odds(40.0, true)).epsilon(1e-9));
  CHECK(odds(-20.0, true) == Approx(std::pow(1.0 + 40.0 / 5.0, 2.45)).epsilon(1e-6));
  CHECK(odds(-20.0, false) == Approx(std::pow((1.0 + 40.0 / 5.0) / (1.0 + 60.0 / 5.0), 2.45)).epsilon(1e-6));
}
