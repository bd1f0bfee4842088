#include "diagnose/recovered/recovered.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/math/angles.h"
#include "base/math/distributions.h"
#include "diagnose/causes/further_causes.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

namespace {

/// Twelve clips of one configuration.
std::vector<tests::MadeLaunch> launches() {
  std::vector<tests::MadeLaunch> made;
  for (int c = 0; c < 12; ++c) made.push_back({0.4, 4.0, c % 2 == 0 ? 0.3 : -0.6, c % 2 == 0 ? -1.1 : 1.2});
  return made;
}

diagnose::TrackSet set_of(unsigned seed, const tests::MadeEffect& effect) {
  const tests::MadeExperiment made = tests::made_experiment(launches(), effect, seed, 1e-4, 60, 50.0);
  return diagnose::track_set(made.results, made.setups, true);
}

/// A fit with one more effect, started from a small size.
diagnose::MotionFit with_effect_of(const diagnose::TrackSet& set, const diagnose::MotionFit& nominal,
                                   std::string_view id, double size) {
  const std::size_t effect = diagnose::effect_index(id);
  const diagnose::MotionFit fit =
      diagnose::fit_with_effect(set, nominal, effect, diagnose::with_effect(set, nominal, effect, {size}, {}));
  return diagnose::linearise_again(set, fit);
}

}  // namespace

TEST_CASE("K/m scatters from clip to clip, and its interval comes from how the clips differ") {
  // A drag that differs by 10 % from clip to clip. The fit counts it as noise of positions, which would make K/m far
  // more precise than twelve clips can.
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> more;
  for (std::size_t c = 0; c < launches().size(); ++c) more.push_back(0.1 * normal(random));
  std::size_t clip = 0;
  double before = 1.0;
  tests::MadeEffect scatter;
  scatter.force = [&](double, double, double v, double t) {
    if (t < before - 0.1) ++clip;
    before = t;
    return -0.93 * more[std::min(clip - 1, more.size() - 1)] * v;
  };
  const diagnose::TrackSet set = set_of(5, scatter);
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const auto found = diagnose::recovered_of(set, {{&fit, {}, 1.0}});
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].k_over_m_1_s.estimate);
  double square = 0.0;
  for (const double one : more) square += one * one;
  // The mean of twelve drags is known to their scatter over sqrt(12) if every clip determines K equally well. Clips do
  // not, and mu and K are correlated: within a factor of three.
  const double mean_sd = 0.93 / 0.4 * std::sqrt(square / 12.0) / std::sqrt(12.0);
  const double sd = found[0].k_over_m_1_s.estimate->sd;
  CHECK(sd > mean_sd / 3.0);
  CHECK(sd < mean_sd * 3.0);
  // By the noise alone it would be known ten times better.
  const diagnose::RemainderSpace space(set, fit);
  const diagnose::RemainderSpace::Solution solution = space.solve({});
  CHECK(std::sqrt(solution.covariance(0, 0)) / 0.4 < 0.1 * sd);
  CHECK(std::sqrt(solution.between_clips(0, 0)) / 0.4 == Approx(sd).epsilon(1e-6));
}

TEST_CASE("a group that bears its inclination's name is told from one that a person named") {
  diagnose::TrackSet set = set_of(6, {});
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  set.groups.at(0).stated_rad = 4.25 * base::kRadPerDegree;
  for (const auto& [name, by_incline] : {std::pair{"4.25 deg", true}, {"4.2 deg", false}, {"hill", false}}) {
    set.groups[0].name = name;
    CHECK(diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0).is_named_by_incline == by_incline);
  }
}

TEST_CASE("without scatter the clips give the same uncertainty as the noise") {
  const diagnose::TrackSet set = set_of(6, {});
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::RemainderSpace space(set, fit);
  const diagnose::RemainderSpace::Solution solution = space.solve({});
  // The variance of twelve scores is known to sqrt(2/12), and so the standard deviation to 20 %; three of these and a
  // bit.
  CHECK(std::sqrt(solution.between_clips(0, 0) / solution.covariance(0, 0)) == Approx(1.0).margin(0.7));
}

TEST_CASE("a stated scale holds along the path and not at the image's edge, where a plane was turned") {
  // The scale is right in the middle of the path, at 0.55 m from the image's edge: a projective map about that place.
  constexpr double kMiddle_m = 0.55, kTurn_1_m = 0.02;
  std::vector<double> seen_m;
  tests::MadeEffect turned;
  turned.seen = [&](double x, double) {
    seen_m.push_back(kMiddle_m + x / (1.0 + kTurn_1_m * x));
    return seen_m.back();
  };
  diagnose::TrackSet set = set_of(9, turned);
  const diagnose::MotionFit nominal = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::MotionFit fit = with_effect_of(set, nominal, diagnose::ids::perspective_error, 0.01);
  CHECK_FALSE(set.plain_scale);  // tracks
  const auto at_edge = diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  set.plain_scale = true;
  const auto along = diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  const auto [low, high] = std::minmax_element(seen_m.begin(), seen_m.end());
  // The square of 1 - p (x - middle) over the path: a mean of 1 to second order, and 2 p length / sqrt(12) apart.
  const double spread = 2.0 * kTurn_1_m * (*high - *low) / std::sqrt(12.0);
  const double sine = std::sin(4.0 * base::kRadPerDegree);
  CHECK(at_edge.alpha_deg.estimate->value == Approx(4.0 * (1.0 + 2.0 * kTurn_1_m * kMiddle_m)).epsilon(0.003));
  CHECK(std::abs(along.alpha_deg.estimate->value - 4.0) < 2.0 * along.alpha_deg.estimate->sd);
  CHECK(along.alpha_deg.estimate->sd == Approx(std::atan(sine) * base::kDegreesPerRad * spread).epsilon(0.1));
  CHECK(std::abs(along.mu.estimate->value - 0.006) < 2.0 * along.mu.estimate->sd);
  CHECK(along.k_over_m_1_s.estimate->value == at_edge.k_over_m_1_s.estimate->value);
  CHECK(along.v_lim_m_s.estimate->value / at_edge.v_lim_m_s.estimate->value ==
        Approx(std::sin(along.alpha_deg.estimate->value * base::kRadPerDegree) /
               std::sin(at_edge.alpha_deg.estimate->value * base::kRadPerDegree)));
}

TEST_CASE("an explanation that is nearly as likely widens what is recovered by as much as it differs") {
  const tests::MadeEffect drag = {[](double, double, double v, double) { return -0.1 * v * std::abs(v); }};
  const diagnose::TrackSet set = set_of(7, drag);
  const diagnose::MotionFit nominal = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::MotionFit quadratic = with_effect_of(set, nominal, diagnose::ids::quadratic_drag, 0.05);
  REQUIRE(quadratic.cost < nominal.cost);
  const auto one = diagnose::recovered_of(set, {{&quadratic, {}, 1.0}});
  const auto other = diagnose::recovered_of(set, {{&nominal, {}, 1.0}});
  const auto both = diagnose::recovered_of(set, {{&quadratic, {}, 0.6}, {&nominal, {}, 0.3}});
  REQUIRE(both.size() == 1);
  const core::Estimate a = *one[0].k_over_m_1_s.estimate, b = *other[0].k_over_m_1_s.estimate,
                       mixed = *both[0].k_over_m_1_s.estimate;
  CHECK(mixed.value == a.value);  // that of the reported explanation
  // 95 % of both together lie within the interval. The other is far away and has a third of the probability: the
  // boundary cuts off 15 % of its own distribution, on the far side.
  const double far = std::abs(b.value - a.value), half = mixed.high95 - mixed.value;
  REQUIRE(far - 2.0 * b.sd > 3.0 * a.sd);
  CHECK(half == Approx(far + b.sd * base::student_t_quantile(11.0, 0.85)).epsilon(0.02));
  CHECK(mixed.sd > 2.0 * a.sd);  // otherwise the test would show nothing
  CHECK(both[0].with == std::vector<std::string>{"quadratic_drag"});
}

TEST_CASE("an unlikely explanation far away hardly widens what is recovered") {
  const diagnose::TrackSet set = set_of(7, {});
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  diagnose::MotionFit far = fit;  // a K/m that is higher by 0.5 1/s
  far.at.global[0] += 0.5 * 0.4;
  const double alone = diagnose::recovered_of(set, {{&fit, {}, 1.0}})[0].k_over_m_1_s.estimate->sd;
  REQUIRE(0.5 > 20.0 * alone);
  // Four percent lie outside with the other, so that one of the own 96 % may: 1.04 % of them.
  const double widened = diagnose::recovered_of(set, {{&fit, {}, 0.96}, {&far, {}, 0.04}})[0].k_over_m_1_s.estimate->sd;
  CHECK(widened / alone == Approx(base::normal_quantile(1.0 - 0.5 / 96.0) / base::kNormal95).epsilon(0.15));
  CHECK(widened > 1.2 * alone);
}

TEST_CASE("alpha and mu of a diagnosis contain the uncertainty of gravity, on a track as in a fall") {
  diagnose::TrackSet set = set_of(7, {});
  set.gravity_sd_m_s2 = 0.0;
  const auto recovered = [&] {
    const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
    return diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  };
  const diagnose::RecoveredConfiguration known = recovered();
  set.gravity_sd_m_s2 = 0.05;
  REQUIRE_FALSE(diagnose::gravity_matters(set));
  const diagnose::RecoveredConfiguration unknown = recovered();
  // g sin(alpha) and mu g are what the motions show.
  const double part = 0.05 / set.gravity_m_s2, alpha = known.alpha_deg.estimate->value;
  const double of_alpha = part * std::tan(alpha * std::acos(-1.0) / 180.0) * 180.0 / std::acos(-1.0);
  CHECK(unknown.alpha_deg.estimate->sd == Approx(std::hypot(known.alpha_deg.estimate->sd, of_alpha)).epsilon(1e-6));
  CHECK(unknown.mu.estimate->sd ==
        Approx(std::hypot(known.mu.estimate->sd, part * known.mu.estimate->value)).epsilon(1e-6));
  CHECK(unknown.k_over_m_1_s.estimate->sd == Approx(known.k_over_m_1_s.estimate->sd).epsilon(1e-6));
  CHECK(unknown.v_lim_m_s.estimate->sd == Approx(known.v_lim_m_s.estimate->sd).epsilon(1e-6));
}

TEST_CASE("a quantity in which the likely explanations differ by more than its value is not given") {
  const diagnose::TrackSet set = set_of(7, {});
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  // The same residuals and derivatives about another point: an explanation with a K/m that is higher by 20 1/s.
  diagnose::MotionFit far = fit;
  far.at.global[0] += 20.0 * 0.4;
  const auto alone = diagnose::recovered_of(set, {{&fit, {}, 1.0}});
  REQUIRE(alone[0].k_over_m_1_s.estimate);
  const auto both = diagnose::recovered_of(set, {{&fit, {}, 0.6}, {&far, {}, 0.3}});
  CHECK_FALSE(both[0].k_over_m_1_s.estimate);
  CHECK(both[0].mu.estimate);
}

TEST_CASE("motion in one direction gives neither mu nor alpha where the inclination is not known otherwise") {
  // Only mu - tan(alpha) acts downhill: the inclination, known to 10 degrees, passes its uncertainty on to mu.
  const std::vector<tests::MadeLaunch> downhill = {{0.4, 4.0, -0.6, 1.2}, {0.4, 4.0, -0.6, 0.6}};
  for (const double incline_sd_deg : {10.0, 0.05}) {
    const tests::MadeExperiment made = tests::made_experiment(downhill, {}, 11, 1e-4, 60, 50.0, incline_sd_deg);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
    const auto found = diagnose::recovered_of(set, {{&fit, {}, 1.0}});
    REQUIRE(found.size() == 1);
    INFO("inclination known to " << incline_sd_deg << " degrees");
    CHECK(found[0].k_over_m_1_s.estimate.has_value());
    CHECK(found[0].mu.estimate.has_value() == (incline_sd_deg < 1.0));
    CHECK(found[0].alpha_deg.estimate.has_value() == (incline_sd_deg < 1.0));
  }
}

TEST_CASE(
    "a cable that pulls in the middle of the track, or friction that drifts, does not change the terminal velocity") {
  // m g (sin(alpha) - mu cos(alpha)) = K v, by the law without them.
  const tests::MadeGlider glider;
  const double alpha = 4.0 * std::acos(-1.0) / 180.0;
  const double v_lim = 0.4 * glider.gravity_m_s2 * (std::sin(alpha) - glider.mu * std::cos(alpha)) / glider.k_n_s_m;
  const auto check = [&](const diagnose::TrackSet& set, const diagnose::MotionFit& fit) {
    const auto found = diagnose::recovered_of(set, {{&fit, {}, 1.0}});
    REQUIRE(found.size() == 1);
    const auto& estimate = found[0].v_lim_m_s.estimate;
    REQUIRE(estimate);
    INFO(estimate->value << " +- " << estimate->sd << ", true " << v_lim);
    CHECK(std::abs(estimate->value - v_lim) < 4.0 * estimate->sd);
    CHECK(estimate->sd < 0.02 * v_lim);
  };
  tests::MadeEffect cable;
  cable.force = [](double x, double, double, double) { return x > -0.4 ? -0.8 * (x + 0.4) : 0.0; };
  const diagnose::TrackSet pulled = set_of(8, cable);
  REQUIRE(pulled.groups[0].x_mid_m > -0.3);  // it pulls there
  const diagnose::MotionFit nominal = diagnose::linearise_again(pulled, diagnose::fit_nominal(pulled));
  const std::size_t tether = diagnose::effect_index(diagnose::ids::tether);
  check(pulled,
        diagnose::linearise_again(
            pulled, diagnose::fit_with_effect(pulled, nominal, tether,
                                              diagnose::with_effect(pulled, nominal, tether, {0.6, -0.38}, {}))));
  std::vector<tests::MadeLaunch> later = launches();
  for (std::size_t c = 0; c < later.size(); ++c) later[c].mu_more = 0.3 * glider.mu * static_cast<double>(c);
  const tests::MadeExperiment made = tests::made_experiment(later, {}, 9, 1e-4, 60, 50.0);
  const diagnose::TrackSet drifted = diagnose::track_set(made.results, made.setups, true);
  check(drifted, with_effect_of(drifted, diagnose::linearise_again(drifted, diagnose::fit_nominal(drifted)),
                                diagnose::ids::friction_drift, 0.1));
}

TEST_CASE(
    "A camera that drifts adds its speed to the uncertainty of the terminal velocity, and what drag makes of it to "
    "that of alpha") {
  constexpr double kDrift_m_s = 0.0024;
  diagnose::TrackSet set = set_of(5, {});
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::RecoveredConfiguration still = diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  set.camera_drift_m_s = kDrift_m_s;
  const diagnose::RecoveredConfiguration drifting = diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  REQUIRE((still.v_lim_m_s.estimate && drifting.v_lim_m_s.estimate && drifting.alpha_deg.estimate));
  const auto added = [](const core::Quantity& before, const core::Quantity& after) {
    CHECK(after.estimate->value == before.estimate->value);
    return std::sqrt(std::pow(after.estimate->sd, 2) - std::pow(before.estimate->sd, 2));
  };
  CHECK(added(still.v_lim_m_s, drifting.v_lim_m_s) == Approx(kDrift_m_s).epsilon(1e-6));
  // At constant speed g sin(alpha) = K/m v + mu g cos(alpha): viscous drag at a speed that is wrong by d. The slope of
  // the force is a difference over 0.1 % of v.
  const double cos_alpha = std::cos(still.alpha_deg.estimate->value * base::kRadPerDegree);
  const double expected_rad = still.k_over_m_1_s.estimate->value * kDrift_m_s / (set.gravity_m_s2 * cos_alpha);
  CHECK(added(still.alpha_deg, drifting.alpha_deg) == Approx(expected_rad / base::kRadPerDegree).epsilon(1e-3));
  CHECK(added(still.mu, drifting.mu) == 0.0);
  CHECK(added(still.k_over_m_1_s, drifting.k_over_m_1_s) == 0.0);
}

TEST_CASE("an inclination at the limit of its statement is not given as if it were known to a ten-thousandth") {
  // A fall that is said to be vertical and accelerates with 0.9 of gravity: no angle within 3 degrees does that.
  std::vector<tests::MadeLaunch> falls(3, tests::MadeLaunch{0.3, 90.0, 0.0, 0.2});
  const tests::MadeGlider free{.k_n_s_m = 0.0, .mu = 0.0};
  const tests::MadeEffect slow = {[](double m, double, double, double) { return -0.1 * m * 9.80665; }};
  const tests::MadeExperiment made = tests::made_experiment(falls, slow, 3, 1e-4, 30, 60.0, 1.0, 0.0, free);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit fit = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::RecoveredConfiguration found = diagnose::recovered_of(set, {{&fit, {}, 1.0}}).at(0);
  CHECK_FALSE(found.alpha_deg.estimate);
  REQUIRE(found.alpha_deg.why);
  CHECK(std::holds_alternative<core::unknown::AtItsLimit>(found.alpha_deg.why->reason));
  // However far from the vertical that limit is, a fall presses on no track.
  const tests::MadeExperiment loose = tests::made_experiment(falls, slow, 3, 1e-4, 30, 60.0, 10.0, 0.0, free);
  const diagnose::TrackSet tilted = diagnose::track_set(loose.results, loose.setups, true);
  const diagnose::MotionFit there = diagnose::linearise_again(tilted, diagnose::fit_nominal(tilted));
  REQUIRE(std::cos(there.at.global[2]) > 0.3);
  const diagnose::RecoveredConfiguration aslant = diagnose::recovered_of(tilted, {{&there, {}, 1.0}}).at(0);
  CHECK_FALSE(aslant.mu.estimate);
  REQUIRE(aslant.mu.why);
  CHECK(std::holds_alternative<core::unknown::FreeFall>(aslant.mu.why->reason));
}

TEST_CASE("nothing is recovered from an explanation whose fit stopped before its minimum") {
  const tests::MadeEffect drag = {[](double, double, double v, double) { return -0.1 * v * std::abs(v); }};
  const diagnose::TrackSet set = set_of(7, drag);
  const diagnose::MotionFit nominal = diagnose::linearise_again(set, diagnose::fit_nominal(set));
  const diagnose::MotionFit quadratic = with_effect_of(set, nominal, diagnose::ids::quadratic_drag, 0.05);
  diagnose::LikelyFit one{&quadratic, {}, 1.0};
  REQUIRE(diagnose::recovered_of(set, {one}).at(0).mu.estimate);
  one.at_minimum = false;
  const diagnose::RecoveredConfiguration found = diagnose::recovered_of(set, {one}).at(0);
  for (const core::Quantity& quantity : {found.k_over_m_1_s, found.mu, found.alpha_deg, found.v_lim_m_s}) {
    CHECK_FALSE(quantity.estimate);
    REQUIRE(quantity.why);
    CHECK(std::holds_alternative<core::unknown::NoMinimum>(quantity.why->reason));
  }
}

TEST_CASE("where clips scatter, friction and drag are the means of the clips, to within their scatter over its root") {
  // The friction of eight clips of one configuration differs by 5 % (rms, one degree of freedom less).
  const std::vector<double> part = {0.05, -0.07, 0.02, -0.03, 0.06, 0.01, -0.06, 0.04};
  constexpr double kMu = 0.02, kDrag = 0.93, kMass = 0.4;
  double mean = 0.0, squares = 0.0;
  for (const double one : part) mean += one / 8.0;
  for (const double one : part) squares += (one - mean) * (one - mean);
  const double sd_of_mean = kMu * std::sqrt(squares / 7.0 / 8.0);
  const double alpha = 4.0 * std::acos(-1.0) / 180.0;
  tests::ScatteringFriction friction(kMu * std::cos(alpha), part);
  tests::MadeEffect scatter;
  scatter.force = [&](double m, double, double v, double t) { return friction(m, v, t); };
  std::vector<tests::MadeLaunch> launches;
  for (int i = 0; i < 4; ++i) {
    launches.push_back({kMass, 4.0, 0.3, -1.1 - 0.05 * i});
    launches.push_back({kMass, 4.0, -0.6, 1.2 - 0.05 * i});
  }
  const auto made = tests::made_experiment(launches, scatter, 5, 5e-5, 100, 60.0, 0.05, 0.0, {.mu = kMu});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::optional<diagnose::MotionFit> fit = diagnose::with_clip_scatter(set, diagnose::fit_nominal(set));
  REQUIRE(fit);
  const auto recovered = diagnose::recovered_of(set, {{&*fit, {}, 1.0}});
  REQUIRE(recovered.size() == 1);
  REQUIRE(recovered[0].mu.estimate);
  REQUIRE(recovered[0].k_over_m_1_s.estimate);
  REQUIRE(recovered[0].v_lim_m_s.estimate);
  const core::Estimate& mu = *recovered[0].mu.estimate;
  CHECK(mu.sd > 0.8 * sd_of_mean);
  CHECK(mu.sd < 1.5 * sd_of_mean);  // not the 0.02/sqrt(8) of the prior that holds the deviations
  CHECK(std::abs(mu.value - kMu * (1.0 + mean)) < 0.5 * sd_of_mean);
  CHECK(std::abs(recovered[0].k_over_m_1_s.estimate->value - kDrag / kMass) <
        3.0 * recovered[0].k_over_m_1_s.estimate->sd);
  CHECK(recovered[0].k_over_m_1_s.estimate->sd < 0.01 * kDrag / kMass);
  // m g (sin(alpha) - mu cos(alpha)) = K v, with the clips' mean friction.
  const double v = kMass * 9.80665 * (std::sin(alpha) - kMu * (1.0 + mean) * std::cos(alpha)) / kDrag;
  CHECK(std::abs(recovered[0].v_lim_m_s.estimate->value - v) < 3.0 * recovered[0].v_lim_m_s.estimate->sd);
  CHECK(recovered[0].v_lim_m_s.estimate->sd < 0.02 * v);
}
