#include "diagnose/causes/remainder.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>
#include <vector>

#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/tracks/whitening.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr std::size_t kFrames = 60;

struct Fitted {
  diagnose::TrackSet set;
  diagnose::MotionFit fit;
};

Fitted fitted(const std::vector<tests::MadeLaunch>& launches, unsigned seed, const tests::MadeEffect& effect = {}) {
  const tests::MadeExperiment made = tests::made_experiment(launches, effect, seed, 1e-4, kFrames, 50.0);
  Fitted result{diagnose::track_set(made.results, made.setups, true), {}};
  result.fit = diagnose::fit_nominal(result.set);
  return result;
}

/// The covariance, in units of the noise, that the remainder adds to a motion, by integrating dv/dt = -(K/m) v + a in
/// small steps, with a constant over each of `parts` equal parts of the motion.
Eigen::MatrixXd dense_remainder(const Fitted& of, std::size_t i, const diagnose::RemainderSizes& sizes, int parts) {
  const diagnose::TrackedMotion& motion = of.set.motions[i];
  const double k = of.fit.at.global[0] / of.set.masses[motion.mass].mass_kg;
  const std::size_t n = motion.t_s.size();
  const double from = motion.t_s.front(), length = (motion.t_s.back() - from) / parts;
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), parts);
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Ones(parts, 3);
  for (int j = 0; j < parts; ++j) {
    double x = 0.0, v = 0.0, t = from, speed = 0.0, sign = 0.0, count = 0.0;
    constexpr int kSteps = 2000;  // a relative error of the order of (length/2000)²
    for (std::size_t p = 0; p < n; ++p) {
      const double h = (motion.t_s[p] - t) / kSteps;
      for (int s = 0; s < kSteps && h > 0.0; ++s) {
        const double middle = t + 0.5 * h;
        const double a = middle >= from + j * length && middle < from + (j + 1) * length ? 1.0 : 0.0;
        const double half = v + 0.5 * h * (a - k * v);
        x += h * half;
        v += h * (a - k * half);
        t += h;
      }
      t = motion.t_s[p];
      b(static_cast<Eigen::Index>(p), j) = x / motion.sd_of(p);
      const bool last = j + 1 == parts;
      if (motion.t_s[p] >= from + j * length && (last || motion.t_s[p] < from + (j + 1) * length)) {
        speed += of.fit.motions[i].v_m_s[p];
        sign += of.fit.motions[i].v_m_s[p] > 0.0 ? 1.0 : -1.0;
        count += 1.0;
      }
    }
    shapes(j, 1) = sign / count;
    shapes(j, 2) = k * speed / count;
  }
  const double f2 = sizes.force_m_s2 * sizes.force_m_s2;
  const Eigen::MatrixXd s = sizes.q_m2_s3 / length * Eigen::MatrixXd::Identity(parts, parts) +
                            f2 * shapes.col(0) * shapes.col(0).transpose() +
                            f2 * shapes.col(1) * shapes.col(1).transpose() +
                            sizes.drag * sizes.drag * shapes.col(2) * shapes.col(2).transpose();
  return b * s * b.transpose();
}

/// Log likelihood with all parameters integrated out over flat priors, by dense matrices over all positions at once.
double dense_likelihood(const Fitted& of, const diagnose::RemainderSizes& sizes, int parts) {
  Eigen::Index points = 0, own = 0;
  for (const diagnose::FitMotion& motion : of.fit.motions) {
    points += motion.residual.size();
    own += motion.own.cols();
  }
  const Eigen::Index common = of.fit.at.global.size(), stated = std::ssize(of.fit.statements);
  Eigen::MatrixXd v = Eigen::MatrixXd::Identity(points + stated, points + stated);
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(points + stated, common + own);
  Eigen::VectorXd r(points + stated);
  Eigen::Index row = 0, column = common;
  for (std::size_t i = 0; i < of.fit.motions.size(); ++i) {
    const diagnose::FitMotion& motion = of.fit.motions[i];
    const Eigen::Index n = motion.residual.size();
    v.block(row, row, n, n) += dense_remainder(of, i, sizes, parts);
    x.block(row, 0, n, common) = motion.global;
    x.block(row, column, n, motion.own.cols()) = motion.own;
    r.segment(row, n) = motion.residual;
    row += n;
    column += motion.own.cols();
  }
  for (const diagnose::FitStatement& s : of.fit.statements) {
    x(row, static_cast<Eigen::Index>(s.global)) = 1.0 / s.sd;
    r[row] = (s.value - of.fit.at.global[static_cast<Eigen::Index>(s.global)]) / s.sd;
    ++row;
  }
  const Eigen::MatrixXd inverse = v.ldlt().solve(Eigen::MatrixXd::Identity(v.rows(), v.cols()));
  const Eigen::MatrixXd normal = x.transpose() * inverse * x;
  const Eigen::VectorXd right = x.transpose() * inverse * r;
  const auto log_determinant = [](const Eigen::MatrixXd& m) { return m.ldlt().vectorD().array().log().sum(); };
  return -0.5 * (r.dot(inverse * r) - right.dot(normal.ldlt().solve(right))) - 0.5 * log_determinant(v) -
         0.5 * log_determinant(normal);
}

}  // namespace

TEST_CASE("the likelihood of a remainder is that of its dense covariance") {
  const Fitted of = fitted({{0.4, 4.0, 0.3, -1.1}, {0.4, 4.0, -0.6, 1.2}}, 5);
  REQUIRE(of.set.motions.size() == 2);
  const diagnose::RemainderSpace space(of.set, of.fit);
  // Sixty positions make 15 parts of four positions each.
  const int parts = static_cast<int>(of.set.motions[0].t_s.size() / 4);
  REQUIRE(of.set.motions[1].t_s.size() / 4 == of.set.motions[0].t_s.size() / 4);
  const double space_zero = space.log_likelihood(diagnose::RemainderSizes{}),
               dense_zero = dense_likelihood(of, {}, parts);
  for (const diagnose::RemainderSizes& sizes : {diagnose::RemainderSizes{1e-4, 0.0, 0.0, {}},
                                                {0.0, 0.02, 0.0, {}},
                                                {0.0, 0.0, 0.1, {}},
                                                {3e-5, 0.01, 0.05, {}}}) {
    // Differences, since constants are left out. The small steps are good to 1e-6 of columns of up to 1e3 in units of
    // the noise.
    const double difference = space.log_likelihood(sizes) - space_zero;
    CHECK(difference == Approx(dense_likelihood(of, sizes, parts) - dense_zero).margin(0.02));
    CHECK(std::abs(difference) > 0.1);  // otherwise the test would show nothing
  }
}

TEST_CASE("whitening with a remainder turns noise and remainder into unit white noise, and can be undone") {
  Fitted of = fitted({{0.4, 4.0, 0.3, -1.1}}, 6);
  const diagnose::RemainderSizes sizes{1e-4, 0.01, 0.02, {}};
  const auto n = static_cast<Eigen::Index>(of.set.motions[0].t_s.size());
  const int parts = static_cast<int>(n / 4);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n) + dense_remainder(of, 0, sizes, parts);
  const diagnose::TrackedMotion alone = of.set.motions[0];
  diagnose::add_remainder(of.fit, sizes, of.set);
  // The columns of the identity are positions in units of their own noise: W, and then W'.
  const Eigen::MatrixXd noise = diagnose::whitened(alone, Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd w = diagnose::whitened(of.set.motions[0], Eigen::MatrixXd::Identity(n, n));
  // The remainder is a covariance of positions that are whitened by their own noise.
  const Eigen::MatrixXd both = noise.inverse() * (Eigen::MatrixXd::Identity(n, n)) * noise.inverse().transpose() +
                               (covariance - Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd unit = w * both * w.transpose();
  // Less than a thousandth of the variance of the noise is left out, in each of at most 18 directions.
  CHECK((unit - Eigen::MatrixXd::Identity(n, n)).norm() < 0.02);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd y = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
  const Eigen::VectorXd weights = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
  const Eigen::VectorXd white = diagnose::whitened(of.set.motions[0], y);
  CHECK((diagnose::coloured(of.set.motions[0], white) - y).norm() < 1e-9 * y.norm() * 1e3);
  const Eigen::MatrixXd of_white = diagnose::weights_of_white(of.set.motions[0], weights);
  CHECK(of_white.col(0).dot(white) == Approx(weights.dot(y)).margin(1e-7));
}

TEST_CASE("the sizes of a remainder are recovered from motions that have it, and are small without") {
  // A constant force along the track in each clip, drawn with a standard deviation of 0.02 m/s².
  std::vector<tests::MadeLaunch> launches;
  for (int c = 0; c < 12; ++c) launches.push_back({0.4, 4.0, c % 2 == 0 ? 0.3 : -0.6, c % 2 == 0 ? -1.1 : 1.2});
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> forces;
  for (std::size_t c = 0; c < launches.size(); ++c) forces.push_back(0.4 * 0.02 * normal(random));
  double square = 0.0;
  for (const double f : forces) square += f * f / (0.4 * 0.4) / static_cast<double>(forces.size());
  std::size_t clip = 0;
  double before = 1.0;
  tests::MadeEffect scatter;
  scatter.force = [&](double, double, double, double t) {
    if (t < before - 0.1) ++clip;  // the next clip begins
    before = t;
    return forces[std::min(clip - 1, forces.size() - 1)];
  };
  const Fitted with = fitted(launches, 7, scatter), without = fitted(launches, 7);
  const auto found = diagnose::RemainderSpace(with.set, with.fit).likeliest();
  // A standard deviation from twelve draws is known to 1/sqrt(24); three of these, and as much for what K and mu
  // absorb.
  CHECK(found.sizes.force_m_s2 / std::sqrt(square) > 0.4);
  CHECK(found.sizes.force_m_s2 / std::sqrt(square) < 1.9);
  const auto nothing = diagnose::RemainderSpace(without.set, without.fit).likeliest();
  CHECK(nothing.sizes.force_m_s2 < 0.1 * found.sizes.force_m_s2);
  CHECK(nothing.log_likelihood -
            diagnose::RemainderSpace(without.set, without.fit).log_likelihood(diagnose::RemainderSizes{}) <
        4.0);
  CHECK(found.log_likelihood - diagnose::RemainderSpace(with.set, with.fit).log_likelihood(diagnose::RemainderSizes{}) >
        100.0);
}

TEST_CASE("one motion that is far worse than the others does not set the remainder of all") {
  std::vector<tests::MadeLaunch> launches;
  for (int c = 0; c < 8; ++c) launches.push_back({0.4, 4.0, c % 2 == 0 ? 0.3 : -0.6, c % 2 == 0 ? -1.1 : 1.2});
  std::size_t clip = 0;
  double before = 1.0;
  tests::MadeEffect kick;
  kick.force = [&](double, double, double, double t) {
    if (t < before - 0.1) ++clip;
    before = t;
    return clip == 3 && t > 0.5 && t < 0.6 ? 0.2 : 0.0;
  };
  const Fitted of = fitted(launches, 8, kick);
  const auto found = diagnose::RemainderSpace(of.set, of.fit).likeliest();
  REQUIRE(found.sizes.wider.size() == of.set.motions.size());
  for (std::size_t i = 0; i < of.set.motions.size(); ++i) {
    if (of.set.motions[i].clip == 2) CHECK(found.sizes.wider[i] >= 4.0);
    if (of.set.motions[i].clip != 2) CHECK(found.sizes.wider[i] <= 2.0);
  }
}

TEST_CASE("a single motion has no scatter from motion to motion, whatever its law lacks") {
  const tests::MadeEffect bow{.force = [](double m, double x, double, double) { return -0.5 * m * x; }};
  const Fitted one = fitted({{0.4, 4.0, -0.6, 1.2}}, 5, bow);
  const diagnose::RemainderSpace space(one.set, one.fit);
  const auto best = space.likeliest();
  CHECK(best.sizes.drag == 0.0);
  CHECK(best.sizes.force_m_s2 == 0.0);
  const diagnose::RemainderSizes scattered{1e-4, 0.1, 0.7, {}};
  CHECK(space.likeliest(&scattered).sizes.drag == 0.0);
}

TEST_CASE("what differs from fall to fall is no friction and no inclination") {
  // Of each mass another part of the weight: an acceleration that differs from motion to motion.
  const auto differs = [](double m, double, double, double) { return (m > 0.5 ? 0.5 : -0.5) * m; };
  const auto scatter = [&](double incline_deg) {
    const Fitted of = fitted({{0.4, incline_deg, -0.6, 0.2}, {0.7, incline_deg, -0.6, 0.2}}, 5, {.force = differs});
    const diagnose::RemainderSpace space(of.set, of.fit);
    const diagnose::RemainderSizes given{0.0, 0.5, 0.0, {}};
    const auto best = space.likeliest();
    CHECK(space.log_likelihood(best.sizes) >
          space.log_likelihood(diagnose::RemainderSizes{}) + 10.0);  // the falls do differ
    return std::max(best.sizes.force_m_s2, space.likeliest(&given).sizes.force_m_s2);
  };
  CHECK(scatter(4.0) > 0.05);
  CHECK(scatter(90.0) == 0.0);
}

// Two priors of g about different values, of the same fall: the ratio of their evidences is that of the integrals over
// the range of g of the likelihood times each. The fall is so heavy and so steep that nothing else acts; x0 and v0 are
// linear, so that chi² is a parabola in g.
TEST_CASE("a gravity at the edge of its range has the evidence of the integral over that range, as one within has") {
  const tests::MadeGlider glider{.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = 9.90};
  const tests::MadeExperiment made =
      tests::made_experiment({{50.0, 90.0, 0.0, 0.1}}, {}, 31, 2e-3, 60, 120.0, 1e-4, 0.0, glider);
  const auto at = [&](double gravity_m_s2) {
    core::AnalysisResults results = made.results;
    results.gravity_m_s2 = gravity_m_s2;
    diagnose::TrackSet set = diagnose::track_set(results, made.setups, true);
    set.gravity_sd_m_s2 = 0.015;
    return diagnose::without_drag(set);
  };
  const auto evidence = [](const diagnose::TrackSet& set) {
    return diagnose::RemainderSpace(set, diagnose::fit_nominal(set)).log_likelihood(diagnose::RemainderSizes{});
  };
  const diagnose::TrackedMotion motion = at(9.80665).motions.front();
  Eigen::MatrixXd design(static_cast<Eigen::Index>(motion.t_s.size()), 3);
  Eigen::VectorXd x(design.rows());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const auto p = static_cast<std::size_t>(i);
    const double t = motion.t_s[p] - motion.t_s.front(), w = motion.outlier[p] ? 0.0 : 1.0 / motion.sd_of(p);
    design.row(i) << w, w * t, 0.5 * w * t * t;
    x[i] = w * motion.x_m[p];
  }
  const Eigen::Matrix3d covariance = (design.transpose() * design).inverse();
  const double best = (covariance * (design.transpose() * x))[2], sd = std::sqrt(covariance(2, 2));
  const auto integral = [&](double gravity_m_s2) {
    double sum = 0.0;
    constexpr int kParts = 20000;
    for (int i = 0; i < kParts; ++i) {
      const double z = -3.0 + 6.0 * (i + 0.5) / kParts, g = gravity_m_s2 + 0.015 * z;
      sum += std::exp(-0.5 * (z * z + std::pow((g - best) / sd, 2))) / kParts;
    }
    return std::log(sum);
  };
  const diagnose::TrackSet middle = at(9.89);
  REQUIRE(std::abs(best - 9.89) < 0.04);
  for (const double gravity : {9.80665, 9.84, 9.86, 9.94}) {
    CAPTURE(gravity, best, sd);
    // The inclination and K, which this integral leaves out, change by their ranges: 1e-4 degrees, and 1e-4 N s/m.
    CHECK(std::abs(evidence(at(gravity)) - evidence(middle) - (integral(gravity) - integral(9.89))) < 0.02);
  }
}
