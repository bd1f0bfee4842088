/// How the share of the gap changes probabilities: sums that must hold whatever was weighed, and each rule by hand.
#include "diagnose/verdict/probabilities_by_share.h"

#include <cmath>
#include <numeric>

#include "diagnose/effects/effect_library.h"
#include "tests/catch.h"

using namespace glidelab;
using diagnose::Comparison;
using diagnose::effect_index;
using diagnose::Hypothesis;
namespace ids = diagnose::ids;

namespace {

const std::size_t kDrag = effect_index(ids::quadratic_drag), kInertia = effect_index(ids::rotational_inertia),
                  kPlace = effect_index(ids::place_friction);

struct Weighed {
  std::vector<std::size_t> effects;
  double probability;
  double left = 0.0;  // of the gap
};

/// The rest, up to 1, is unknown.
Comparison comparison_of(const std::vector<Weighed>& all, double none = 0.0) {
  Comparison comparison;
  comparison.effect_probability.assign(diagnose::effect_list().size(), 0.0);
  comparison.none = none;
  comparison.unknown = 1.0 - none;
  for (const Weighed& one : all) {
    Hypothesis explanation;
    explanation.effects = one.effects;
    explanation.probability = one.probability;
    explanation.left = one.left;
    comparison.all.push_back(explanation);
    comparison.unknown -= one.probability;
    for (const std::size_t e : one.effects) comparison.effect_probability[e] += one.probability;
  }
  return comparison;
}

diagnose::CauseSequence sequence_of(std::string_view main, double share, double gap_before) {
  diagnose::CauseSequence sequence;
  sequence.is_gap = true;
  sequence.gap_before = gap_before;
  sequence.named_share = share;
  sequence.causes = {{std::string(main), share, {}, 1.0}};
  return sequence;
}

constexpr double kNoNoise = 1e4;  // a gap beside which the noise is negligible: its square is above 1e6
constexpr double kPlain = 5.0;

double probability_of(const Comparison& comparison, const std::vector<std::size_t>& effects) {
  for (const Hypothesis& one : comparison.all) {
    if (one.effects == effects) return one.probability;
  }
  FAIL("not there");
  return 0.0;
}

/// Probabilities sum to 1, and that of an effect is the sum over its explanations.
void check_sums(const Comparison& comparison) {
  double sum = comparison.none + comparison.unknown;
  std::vector<double> of_effects(comparison.effect_probability.size(), 0.0);
  for (const Hypothesis& one : comparison.all) {
    sum += one.probability;
    for (const std::size_t e : one.effects) of_effects[e] += one.probability;
  }
  CHECK(std::abs(sum - 1.0) < 1e-12);
  for (std::size_t e = 0; e < of_effects.size(); ++e) {
    CHECK(std::abs(of_effects[e] - comparison.effect_probability[e]) < 1e-12);
  }
  CHECK(comparison.unknown >= 0.0);
  CHECK(comparison.unknown <= 1.0);
}

}  // namespace

TEST_CASE("a law that takes most of a gap without noise is named, and effects beside it keep their part") {
  Comparison comparison = comparison_of({{{kDrag}, 0.06}, {{kDrag, kInertia}, 0.02}, {{kPlace}, 0.12}});
  diagnose::hold_to_share(sequence_of(ids::quadratic_drag, 0.9, kNoNoise), {kDrag, kInertia}, false, comparison);
  check_sums(comparison);
  CHECK(comparison.effect_probability[kDrag] == Approx(0.8));
  CHECK(comparison.effect_probability[kInertia] == Approx(0.8 * 0.02 / 0.08));  // as likely beside the drag as before
  CHECK(probability_of(comparison, {kDrag}) == Approx(0.8 * 0.06 / 0.08));
  // 0.12 of others and 0.8 of the unknown share what is left in proportion.
  CHECK(probability_of(comparison, {kPlace}) == Approx(0.2 * 0.12 / 0.92));
  CHECK(comparison.unknown == Approx(0.2 * 0.8 / 0.92));
  CHECK(comparison.all.front().effects == std::vector{kDrag});  // the likeliest first
}

TEST_CASE("a law that lost its probability to the unknown gets it back by its share") {
  Comparison comparison = comparison_of({{{kDrag}, 0.0}, {{kPlace}, 0.1}});
  diagnose::hold_to_share(sequence_of(ids::quadratic_drag, 0.9, kNoNoise), {kDrag}, false, comparison);
  check_sums(comparison);
  CHECK(probability_of(comparison, {kDrag}) == Approx(0.8));
  CHECK(comparison.unknown == Approx(0.2 * 0.9));
}

TEST_CASE("a name by its share alone needs negligible noise, most of the gap, and a law of all clips") {
  const auto after = [](std::string_view main, double share, double gap, double probability) {
    const std::size_t effect = effect_index(main);
    Comparison comparison = comparison_of({{{effect}, probability}});
    diagnose::hold_to_share(sequence_of(main, share, gap), {effect}, false, comparison);
    check_sums(comparison);
    return comparison.effect_probability[effect];
  };
  CHECK(after(ids::quadratic_drag, 0.9, kNoNoise, 0.1) == Approx(0.8));
  CHECK(after(ids::quadratic_drag, 0.9, kPlain, 0.1) == Approx(0.1));      // the noise counts
  CHECK(after(ids::quadratic_drag, 0.7, kNoNoise, 0.1) == Approx(0.1));    // half is not most
  CHECK(after(ids::clip_scatter, 0.9, kNoNoise, 0.1) == Approx(0.1));      // sizes of each clip follow any curve
  CHECK(after(ids::quadratic_drag, 0.9, kNoNoise, 0.95) == Approx(0.95));  // the evidence gives it more
}

TEST_CASE("causes that take less than half of a gap are unknown, and no gap counts as none") {
  Comparison comparison = comparison_of({{{kDrag}, 0.7}, {{kPlace}, 0.1}}, 0.15);
  diagnose::hold_to_share(sequence_of(ids::quadratic_drag, 0.3, kPlain), {kDrag}, false, comparison);
  check_sums(comparison);
  CHECK(comparison.none == 0.0);
  // 0.05 of the unknown, 0.15 of none, and the name's own 0.7.
  CHECK(comparison.unknown == Approx(0.9));
  CHECK(comparison.effect_probability[kDrag] == Approx(0.1 * 0.7 / 0.8));

  Comparison unlikely = comparison_of({{{kDrag}, 0.05}, {{kPlace}, 0.9}});
  diagnose::hold_to_share(sequence_of(ids::quadratic_drag, 0.3, kPlain), {kDrag}, false, unlikely);
  check_sums(unlikely);
  CHECK(unlikely.unknown > 0.5);  // that is the verdict
}

TEST_CASE("explanations that leave more than half of the gap give their probability to the unknown") {
  Comparison comparison = comparison_of({{{kDrag}, 0.6, 0.7}, {{kPlace}, 0.3, 0.2}});
  diagnose::move_minorities_to_unknown(comparison);
  check_sums(comparison);
  CHECK(comparison.unknown == Approx(0.7));
  CHECK(probability_of(comparison, {kDrag}) == 0.0);
  CHECK(comparison.all.front().effects == std::vector{kPlace});
}

TEST_CASE("what is known by stated inclinations keeps its probability, whatever part of the gap acts beside it") {
  const std::size_t scale = effect_index(ids::scale_error);
  Comparison comparison = comparison_of({{{scale, kDrag}, 0.6, 0.7}, {{kPlace}, 0.3, 0.2}, {{scale}, 0.05, 1.0}});
  for (Hypothesis& one : comparison.all) one.fit = 0;
  comparison.by_stated = {scale};
  diagnose::move_minorities_to_unknown(comparison);
  check_sums(comparison);
  CHECK(probability_of(comparison, {scale}) == Approx(0.65));
  CHECK(comparison.effect_probability[scale] == Approx(0.65));
  CHECK(comparison.effect_probability[kDrag] == Approx(0.0));

  // It need not take half of a gap that is less than the noise.
  diagnose::CauseSequence sequence = sequence_of(ids::scale_error, 0.0, 1.3);
  CHECK(diagnose::needs_no_share(sequence, {{scale}}, comparison));
  CHECK(!diagnose::needs_no_share(sequence, {{scale, kDrag}}, comparison));
  CHECK(!diagnose::needs_no_share(sequence, {{kDrag}}, comparison));
  diagnose::hold_to_share(sequence, {scale}, false, comparison);
  CHECK(comparison.unknown == Approx(0.05));
  sequence.gap_before = 1.5;
  CHECK(!diagnose::needs_no_share(sequence, {{scale}}, comparison));
  diagnose::hold_to_share(sequence, {scale}, false, comparison);
  CHECK(comparison.unknown > 0.5);
}

TEST_CASE("explanations that are not needed count as none") {
  Comparison comparison = comparison_of({{{kDrag}, 0.6}, {{kPlace}, 0.3}}, 0.05);
  diagnose::move_to_none([](const Hypothesis& one) { return one.effects.front() == kDrag; }, comparison);
  check_sums(comparison);
  CHECK(comparison.none == Approx(0.65));
  CHECK(comparison.effect_probability[kDrag] == Approx(0.0).margin(1e-12));
}

TEST_CASE("a likelier cause replaces named ones only if the verdict then still names something") {
  const auto share = [](double of) { return sequence_of(ids::quadratic_drag, of, kPlain); };
  CHECK(diagnose::may_displace(share(0.6), share(0.9)));        // it explains the gap as well
  CHECK_FALSE(diagnose::may_displace(share(0.4), share(0.9)));  // the cause would be unknown although there is a name
  CHECK(diagnose::may_displace(share(0.4), share(0.3)));        // it is unknown anyway
}

TEST_CASE("the probability that one of several acts counts each explanation once, and none with a rest") {
  Comparison comparison = comparison_of({{{kDrag}, 0.3}, {{kDrag, kPlace}, 0.2}, {{kPlace}, 0.1}, {{kInertia}, 0.25}});
  comparison.all.push_back({{kDrag}, true, 0.0, 0.0, 0.15});
  CHECK(std::abs(diagnose::probability_of_any(comparison, {kDrag}) - 0.5) < 1e-12);
  CHECK(std::abs(diagnose::probability_of_any(comparison, {kDrag, kPlace}) - 0.6) < 1e-12);
  CHECK(diagnose::probability_of_any(comparison, {}) == 0.0);
}

TEST_CASE("what resolves a contradicted inclination takes the place of causes that show and make no gap") {
  const std::size_t scale = effect_index(ids::scale_error), clock = effect_index(ids::frame_rate_error);
  const auto fit_at = [](double alpha_rad) {  // 0.1 ± 0.01 rad is stated
    diagnose::MotionFit fit;
    fit.at.global = Eigen::VectorXd::Constant(1, alpha_rad);
    fit.statements = {{0, 0.1, 0.01, diagnose::Against::stated}};
    return fit;
  };
  const auto made = [&](double alpha_rad) {
    Comparison comparison = comparison_of({{{kDrag}, 0.1}, {{scale}, 0.02}, {{clock}, 0.01}}, 0.05);
    comparison.fits = {fit_at(alpha_rad), fit_at(alpha_rad), fit_at(0.1), fit_at(0.1)};
    for (std::size_t k = 0; k < 3; ++k) comparison.all[k].fit = static_cast<int>(k + 1);
    comparison.all[1].log_evidence = 3.0 + std::log(2.0);
    comparison.all[2].log_evidence = 3.0;
    Hypothesis curve;
    curve.unnamed = true;
    curve.probability = comparison.unknown;
    comparison.all.push_back(curve);
    return comparison;
  };
  Comparison off = made(0.05);  // five standard deviations
  REQUIRE(diagnose::trust_stated(off));
  CHECK(off.none == 0.0);
  CHECK(off.unknown == Approx(0.1));
  CHECK(probability_of(off, {scale}) == Approx(0.6));
  CHECK(probability_of(off, {clock}) == Approx(0.3));
  CHECK(probability_of(off, {kDrag}) == 0.0);
  CHECK(off.effect_probability[scale] == Approx(0.6));
  CHECK(off.all.front().effects == std::vector{scale});
  Comparison part = made(0.02);  // eight, of which five remain
  for (std::size_t k = 2; k < 4; ++k) part.fits[k] = fit_at(0.05);
  CHECK_FALSE(diagnose::trust_stated(part));
  Comparison near = made(0.06);  // four
  CHECK_FALSE(diagnose::trust_stated(near));
  CHECK(probability_of(near, {kDrag}) == 0.1);
  CHECK(near.none == 0.05);
}

TEST_CASE("a name may take nothing if its share may be none of a gap that is less than the noise") {
  diagnose::CauseSequence sequence;
  sequence.gap_before = 1.3;  // an excess of 0.69
  CHECK_FALSE(diagnose::may_take_nothing(sequence));
  diagnose::ExplainedCause cause;
  cause.share = 0.9;
  sequence.causes = {cause};
  CHECK_FALSE(diagnose::may_take_nothing(sequence));  // one clip: no interval
  sequence.causes.front().share_interval95 = {-0.1, 1.9};
  CHECK(diagnose::may_take_nothing(sequence));
  sequence.causes.front().share_interval95 = {0.1, 1.7};
  CHECK_FALSE(diagnose::may_take_nothing(sequence));
  sequence.causes.front().share_interval95 = {-0.1, 1.9};
  sequence.gap_before = 1.5;
  CHECK_FALSE(diagnose::may_take_nothing(sequence));
}
