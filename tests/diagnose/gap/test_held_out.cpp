#include "diagnose/gap/held_out.h"

#include <Eigen/Dense>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr Eigen::Index kPoints = 40;
constexpr double kStated = 0.07, kSd = 0.001;

/// Three clips of one motion each, linear in K, mu, alpha and their starts, not at the minimum; alpha is stated. An
/// unnamed function that goes with alpha (`likeness` 0: not at all).
struct Linear {
  diagnose::TrackSet set;
  diagnose::MotionFit fit;
  diagnose::UnnamedFamily family;
};

Linear linear_case(bool data_see_alpha, double likeness, double tau) {
  Linear made;
  made.set.groups.push_back({"g", 0.0, {{kStated, kSd, diagnose::Against::stated}}, 0.0});
  made.set.masses.push_back({0.4, 0.0});
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto drawn = [&](Eigen::Index columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(kPoints, columns, [&] { return normal(random); }));
  };
  made.family.columns.resize(3 * kPoints, 1);
  made.family.tau = tau;
  for (std::size_t i = 0; i < 3; ++i) {
    made.set.clips.push_back({"c" + std::to_string(i), 100.0, 0.4, 40, 0.0});
    diagnose::TrackedMotion motion;
    motion.clip = i;
    motion.sd_m = 1e-5;
    motion.t_s.resize(kPoints);
    motion.outlier.assign(kPoints, 0);
    made.set.motions.push_back(motion);
    diagnose::FitMotion of;
    of.own = drawn(2);
    of.global = drawn(3);
    of.global.col(2) *= data_see_alpha ? 300.0 : 0.0;
    of.residual = drawn(1).col(0) + (data_see_alpha ? 0.03 : 0.0) * of.global.col(2) + of.own.col(0);
    of.plain = of.residual;
    Eigen::VectorXd column = drawn(1).col(0) + likeness * of.global.col(2);
    const Eigen::MatrixXd inverse = (of.own.transpose() * of.own).inverse();
    column -= of.own * (inverse * (of.own.transpose() * column));
    made.family.columns.col(0).segment(static_cast<Eigen::Index>(i) * kPoints, kPoints) = column;
    made.fit.motions.push_back(of);
    made.fit.at.own.push_back(Eigen::Vector2d::Zero());
  }
  made.fit.layout = std::make_shared<const diagnose::ParameterLayout>(made.set, std::vector<std::size_t>{});
  made.fit.at.global = Eigen::Vector3d::Zero();
  made.fit.statements = {{2, kStated, kSd, diagnose::Against::stated, true}};
  return made;
}

/// All columns side by side: K, mu, alpha, the function without a name (where it is free), the three starts.
Eigen::MatrixXd dense(const Linear& made) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * kPoints, 10);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const diagnose::FitMotion& of = made.fit.motions[static_cast<std::size_t>(i)];
    all.block(i * kPoints, 0, kPoints, 3) = of.global;
    all.block(i * kPoints, 4 + 2 * i, kPoints, 2) = of.own;
  }
  all.col(3) = made.family.columns.col(0);
  return all;
}

}  // namespace

TEST_CASE(
    "with a function without a name, a statement is as far off as all else says, its errors added in quadrature") {
  for (const double likeness : {0.0, 0.01, 0.3}) {
    const Linear made = linear_case(true, likeness, std::numeric_limits<double>::infinity());
    const diagnose::MotionFit with = diagnose::with_unnamed(made.set, made.fit, made.family);
    // Without the statement: all columns at once.
    const Eigen::MatrixXd columns = dense(made);
    Eigen::VectorXd residual(3 * kPoints);
    for (Eigen::Index i = 0; i < 3; ++i) {
      residual.segment(i * kPoints, kPoints) = made.fit.motions[static_cast<std::size_t>(i)].residual;
    }
    const Eigen::MatrixXd covariance = (columns.transpose() * columns).inverse();
    const double alpha = (covariance * (columns.transpose() * residual))[2];
    const double expected = (kStated - alpha) / std::sqrt(kSd * kSd + covariance(2, 2));
    const auto pulls = diagnose::statement_pulls(made.set, with);
    REQUIRE(pulls.size() == 1);
    REQUIRE(pulls.front().z);
    CHECK(*pulls.front().z == Approx(expected).epsilon(1e-4));

    // And with it: what is left, and where the fit is.
    Eigen::MatrixXd joined(3 * kPoints + 1, 10);
    joined << columns, Eigen::RowVectorXd::Zero(10);
    joined(3 * kPoints, 2) = 1.0 / kSd;
    Eigen::VectorXd right(3 * kPoints + 1);
    right << residual, kStated / kSd;
    const Eigen::VectorXd sizes = joined.colPivHouseholderQr().solve(right);
    const Eigen::VectorXd left = residual - columns * sizes;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto& of = with.motions[static_cast<std::size_t>(i)];
      CHECK((of.residual - left.segment(i * kPoints, kPoints)).norm() < 1e-6);
      CHECK((of.plain - of.residual).norm() == 0.0);  // white noise
    }
    CHECK(with.at.global[3] == Approx(sizes[3]).margin(1e-6));
    CHECK(with.at.own[1][0] == Approx(sizes[6]).epsilon(1e-6));
  }
}

TEST_CASE("a statement of what nothing else knows is not said to be off") {
  const Linear made = linear_case(false, 0.0, 1.0);
  const auto pulls = diagnose::statement_pulls(made.set, diagnose::with_unnamed(made.set, made.fit, made.family));
  REQUIRE(pulls.size() == 1);
  CHECK_FALSE(pulls.front().z);
}

TEST_CASE("the gap of held-out clips does not depend on where in its linear neighbourhood a fit stands") {
  const Linear made = linear_case(true, 0.01, 1.0);
  const auto here = diagnose::held_out_gap(made.set, made.fit);
  const auto there = diagnose::held_out_gap(made.set, diagnose::at_linear_minimum(made.set, made.fit));
  REQUIRE(here.clips.size() == 3);
  for (std::size_t c = 0; c < 3; ++c) CHECK(there.clips[c].chi2 == Approx(here.clips[c].chi2).epsilon(1e-6));
}

TEST_CASE("a short motion of a single clip is held out as a clip of its own would be") {
  Linear made = linear_case(true, 0.0, 1.0);
  constexpr Eigen::Index kShort = 12;  // of too few points for two stretches of 8
  made.set.motions.pop_back();
  made.set.clips.pop_back();
  made.fit.motions.pop_back();
  made.fit.at.own.pop_back();
  diagnose::FitMotion& of = made.fit.motions[1];
  of.own.conservativeResize(kShort, Eigen::NoChange);
  of.global.conservativeResize(kShort, Eigen::NoChange);
  of.residual.conservativeResize(kShort);
  of.plain = of.residual;
  made.set.motions[1].t_s.resize(kShort);
  made.set.motions[1].outlier.resize(kShort);
  const auto apart = diagnose::held_out_gap(made.set, made.fit);
  REQUIRE(apart.clips.size() == 2);
  made.set.clips.pop_back();
  made.set.motions[1].clip = 0;
  const auto together = diagnose::held_out_gap(made.set, made.fit);
  REQUIRE(together.clips.size() == 5);  // four stretches of the other motion
  CHECK(together.clips.back().chi2 == Approx(apart.clips.back().chi2).epsilon(1e-6));
  CHECK(together.clips.back().freedom == apart.clips.back().freedom);
  CHECK(apart.clips.back().freedom == kShort - 2);
}

TEST_CASE("a clip held out by one step of Newton's has the chi² that a fit to the other clips leaves it") {
  // Drag in proportion to the square of the speed, by the effect's own fit.
  const tests::MadeEffect drag{.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); }};
  const auto made = tests::made_experiment(tests::made_launches(), drag, 4, 2e-5, 100);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::size_t quadratic = diagnose::effect_index("quadratic_drag");
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::MotionFit fit =
      diagnose::fit_motions(set, {quadratic}, diagnose::with_effect(set, nominal, quadratic, {0.08}, {}));
  for (const diagnose::MotionFit& all : {nominal, fit}) {
    const auto gap = diagnose::held_out_gap(set, all);
    REQUIRE(gap.clips.size() == set.clips.size());
    for (const std::size_t c : {0u, 3u, 6u}) {
      diagnose::TrackSet others = set;
      diagnose::FitPoint start = all.at;
      others.motions.erase(others.motions.begin() + static_cast<std::ptrdiff_t>(c));
      start.own.erase(start.own.begin() + static_cast<std::ptrdiff_t>(c));
      const diagnose::MotionFit taught = diagnose::fit_motions(others, all.effects, start);
      diagnose::FitPoint at{taught.at.global, all.at.own};
      const diagnose::FitMotion held = diagnose::linearise_at(set, all.effects, at).motions[c];
      // Its start is free: a variance far above all others.
      const Eigen::Index n = held.residual.size();
      const Eigen::VectorXd size = held.own.colwise().norm();
      const Eigen::MatrixXd own = held.own * size.cwiseInverse().asDiagonal();
      const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n) + 1e9 * own * own.transpose() +
                                         held.global * diagnose::common_covariance(taught) * held.global.transpose();
      const double chi2 = held.residual.dot(covariance.llt().solve(held.residual));
      INFO(set.clips[c].name << ": " << chi2 << ", by one step " << gap.clips[c].chi2);
      // Where the model is right, a thousandth of the noise; where it is not, what is left is bent by a hundredth.
      CHECK(gap.clips[c].chi2 == Approx(chi2).epsilon(all.effects.empty() ? 0.02 : 1e-3));
    }
  }
}

TEST_CASE("what an unknown leaves of the positions is what its likeliest curve leaves") {
  // A magnet at one place: 0.04 N, and no name for it.
  const tests::MadeEffect magnet{
      .force = [](double, double x, double, double) { return 0.04 * std::exp(-std::pow((x - 0.1) / 0.06, 2)); }};
  const auto made = tests::made_experiment(tests::made_launches(), magnet, 4, 2e-5, 150, 150.0);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE(diagnosis.gap);
  REQUIRE(diagnosis.gap->after < 0.2 * diagnosis.gap->before);
  double before = 0.0, after = 0.0;
  for (const auto& curve : diagnosis.residuals) {
    for (const double x : curve.before_m) before += x * x;
    for (const double x : curve.after_m) after += x * x;
  }
  INFO(std::sqrt(before) << " " << std::sqrt(after));
  // The gap's own shrink, but for what a held-out clip is further off than a fitted one.
  CHECK(std::sqrt(after / before) < 0.2);
  const auto& interval = diagnosis.gap->interval95;
  REQUIRE(interval.before);
  CHECK(interval.before->low < diagnosis.gap->before);
  CHECK(interval.before->high > diagnosis.gap->before);
  REQUIRE(interval.shrink);
  CHECK(interval.shrink->high > *diagnosis.gap->shrink);
  for (const auto& parameter : diagnosis.gap->parameters) {
    if (parameter.z_after) CHECK(std::abs(*parameter.z_after) < 4.0);  // the inclinations are right
  }
}

TEST_CASE("where nothing is missing the gap scatters about 1 by its standard error") {
  constexpr int kExperiments = 100;
  double mean = 0.0, squares = 0.0;
  for (unsigned seed = 1; seed <= kExperiments; ++seed) {
    const auto made = tests::made_experiment({{0.4, 0.0, 0.5, -1.2}, {0.4, 0.0, -0.5, 1.0}, {0.4, 4.0, -0.6, 1.2}}, {},
                                             seed + 100, 3e-5, 80);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::HeldOutGap gap = diagnose::held_out_gap(set, diagnose::fit_nominal(set));
    const double off = (gap.value - 1.0) / gap.standard_error;
    mean += off / kExperiments;
    squares += off * off / kExperiments;
  }
  INFO("mean " << mean << ", mean square " << squares);
  CHECK(std::abs(mean) < 0.5);
  // A mean square of 100 numbers has a standard deviation of 0.14 of itself: three of them.
  CHECK(squares > 0.58);
  CHECK(squares < 1.42);
}

TEST_CASE("a stretch of a single clip has the chi² of a prediction from all the rest, the motion's start included") {
  Linear made = linear_case(true, 0.0, 1.0);
  made.set.clips.resize(1);
  made.set.motions.resize(1);
  made.fit.motions.resize(1);
  made.fit.at.own.resize(1);
  for (Eigen::Index p = 0; p < kPoints; ++p) {
    made.set.motions[0].t_s[static_cast<std::size_t>(p)] = 0.01 * static_cast<double>(p);
  }
  const diagnose::HeldOutGap gap = diagnose::held_out_gap(made.set, made.fit);
  REQUIRE(gap.clips.size() == 4);
  // Ordinary least squares of the other thirty points and the statement, and its prediction's covariance.
  const diagnose::FitMotion& of = made.fit.motions[0];
  Eigen::MatrixXd columns(kPoints, 5);
  columns << of.global, of.own;
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Eigen::Index from = 10 * k;
    Eigen::MatrixXd others(31, 5);
    Eigen::VectorXd right(31);
    others.topRows(from) = columns.topRows(from);
    others.middleRows(from, 30 - from) = columns.bottomRows(30 - from);
    others.row(30) << 0.0, 0.0, 1.0 / kSd, 0.0, 0.0;
    right.head(from) = of.residual.head(from);
    right.segment(from, 30 - from) = of.residual.tail(30 - from);
    right[30] = kStated / kSd;
    const Eigen::MatrixXd covariance = (others.transpose() * others).inverse();
    const Eigen::VectorXd sizes = covariance * (others.transpose() * right);
    const Eigen::MatrixXd held = columns.middleRows(from, 10);
    const Eigen::VectorXd off = of.residual.segment(from, 10) - held * sizes;
    const Eigen::MatrixXd predictive = Eigen::MatrixXd::Identity(10, 10) + held * covariance * held.transpose();
    const auto& clip = gap.clips[static_cast<std::size_t>(k)];
    CHECK(clip.freedom == 10.0);
    CHECK(clip.chi2 == Approx(off.dot(predictive.llt().solve(off))).epsilon(1e-6));
  }
}

TEST_CASE("the gap of a single clip sees what a wrong law does over the whole motion") {
  // The slope changes by 0.4 m/s² in a metre: within a quarter of the motion a start of its own would take most of it.
  const tests::MadeEffect bow{.force = [](double m, double x, double, double) { return -0.4 * m * x; }};
  const auto made = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, bow, 3, 3e-5, 150, 100.0, 0.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const double rms = std::sqrt(nominal.cost / static_cast<double>(set.motions[0].t_s.size()));
  REQUIRE(rms > 3.0);
  CHECK(diagnose::held_out_gap(set, nominal).value > rms);  // predicted is further off than fitted
}

TEST_CASE("three motions of a single clip are held out as three clips of one motion each are") {
  const auto gap_of = [](bool together) {
    const tests::MadeEffect bow{.force = [](double m, double x, double, double) { return -0.4 * m * x; }};
    const auto made = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}, {0.4, 4.0, 0.0, 0.6}, {0.4, 4.0, 0.2, -0.8}}, bow,
                                             3, 3e-5, 150, 100.0, 0.0);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    REQUIRE(set.motions.size() == 3);
    if (together) {
      set.clips.resize(1);
      for (diagnose::TrackedMotion& motion : set.motions) motion.clip = 0;
    }
    return diagnose::held_out_gap(set, diagnose::fit_nominal(set));
  };
  const diagnose::HeldOutGap one = gap_of(true), three = gap_of(false);
  REQUIRE(one.clips.size() == 3);
  CHECK(one.value == Approx(three.value).epsilon(1e-9));
}

TEST_CASE("a clip that alone determines a parameter, in two motions, has the chi² that it adds to a fit of all") {
  // As a clip does that alone reaches a bumper: on its way there and back. Whatever the parameter's unit is, the other
  // clips say exactly nothing of it.
  for (const double unit : {1.0, 1e3, 1e6}) {
    Linear made = linear_case(true, 0.0, 1.0);
    for (std::size_t i = 1; i < 3; ++i) made.fit.motions[i].global.col(0).setZero();
    made.fit.motions[0].global.col(0) *= unit;
    diagnose::FitMotion back = made.fit.motions[0];  // the same numbers in another order are another motion
    back.global = Eigen::MatrixXd(back.global.colwise().reverse());
    back.residual = Eigen::VectorXd(-0.7 * made.fit.motions[0].residual.reverse());
    back.plain = back.residual;
    made.fit.motions.push_back(back);
    made.fit.at.own.push_back(Eigen::Vector2d::Zero());
    made.set.motions.push_back(made.set.motions[0]);
    const diagnose::HeldOutGap gap = diagnose::held_out_gap(made.set, made.fit);
    REQUIRE(gap.clips.size() == 3);
    const auto least_chi2 = [&](const std::vector<std::size_t>& motions) {
      const auto many = static_cast<Eigen::Index>(motions.size());
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(many * kPoints + 1, 3 + 2 * many);
      Eigen::VectorXd right(columns.rows());
      for (Eigen::Index k = 0; k < many; ++k) {
        const diagnose::FitMotion& of = made.fit.motions[motions[static_cast<std::size_t>(k)]];
        columns.block(k * kPoints, 0, kPoints, 3) = of.global;
        columns.col(0).segment(k * kPoints, kPoints) /= unit;
        columns.block(k * kPoints, 3 + 2 * k, kPoints, 2) = of.own;
        right.segment(k * kPoints, kPoints) = of.residual;
      }
      columns(many * kPoints, 2) = 1.0 / kSd;
      right[many * kPoints] = kStated / kSd;
      return (right - columns * columns.completeOrthogonalDecomposition().solve(right)).squaredNorm();
    };
    // Of a linear model: what the clip adds to the least chi² is that of its prediction.
    const double expected = least_chi2({0, 1, 2, 3}) - least_chi2({1, 2});
    CHECK(gap.clips[0].chi2 == Approx(expected).epsilon(1e-6));
    CHECK(gap.clips[0].freedom == 2.0 * (kPoints - 2));
  }
}
