#include "core/motion/lines/line_fit.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "core/motion/bandwidth/rule_lines.h"
#include "core/result/estimate.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

constexpr double kStep = 0.005;

/// A clip of one direction with its smoothed points, as analyze_motion.cpp puts them together.
struct Smoothed {
  Motion motion;
  std::vector<FreeStretch> stretches;
  std::vector<StretchPoint> points;
  LineInput input;
};

Smoothed smoothed(const std::vector<double>& x, int direction, double bandwidth_s) {
  Smoothed all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    all.motion.t_s.push_back(static_cast<double>(i) * kStep);
    all.motion.point.push_back(i);
  }
  all.motion.x_m = all.motion.y_m = x;
  all.motion.step_s = kStep;
  all.stretches = {{0, x.size(), direction, LeftOut::kernel_end, LeftOut::kernel_end, LeftOut::used}};
  all.points = smooth_stretches(all.motion, all.stretches, bandwidth_s);
  const std::vector<double> law = pilot_law(all.motion, all.stretches, bandwidth_s);
  const std::vector<double> bias = smoothing_bias(all.motion, all.stretches, law, all.points);
  all.input = line_input(all.motion, all.points, bias, direction, 1.0, 0.0);
  return all;
}

std::vector<double> positions(const tests::Law& law, double v_m_s, std::size_t count) {
  const auto motion = tests::launch(law, v_m_s, kStep * static_cast<double>(count));
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(motion.x(kStep * static_cast<double>(i)));
  return x;
}

}  // namespace

TEST_CASE("a line through smoothed noise-free positions has the kernel's bias (k h)^2 / 2, and says so") {
  const tests::Law law{4.0, 0.006, 2.0};
  const double h = 0.04;
  const auto all = smoothed(positions(law, 1.2, 300), 1, h);
  const auto line = fit_line(1, all.input, {1e-20}, 0.0, Misfit::ignored);
  REQUIRE(line);
  // Next order of the kernel's bias: (k h)^4 / 8 (the eighth moment's share), 5e-6 here; near an end the constant is
  // smaller by up to a fifth on some 2 % of the points each.
  const double bias = 0.5 * std::pow(law.k_1_s * h, 2);
  CHECK(line->k_over_m_1_s.value == Approx(law.k_1_s * (1.0 + bias)).epsilon(0.1 * bias));
  CHECK(line->a0_m_s2.value == Approx(law.a0(1) * (1.0 + bias)).epsilon(0.1 * bias));
  CHECK(line->parts.smoothing_k == Approx(line->k_over_m_1_s.value - law.k_1_s).epsilon(0.1));
  CHECK(line->parts.smoothing_a0 == Approx(line->a0_m_s2.value - law.a0(1)).epsilon(0.1));
  CHECK(line->r2 > 1.0 - 1e-5);
}

TEST_CASE("the covariance of a line is L Sigma L' as a dense computation gives it, for correlated noise") {
  const auto x = positions({4.0, 0.006, 2.0}, 1.2, 120);
  const auto all = smoothed(x, 1, 0.03);
  const std::vector<double> autocovariance{4.0, 2.0, 0.5};
  const auto line = fit_line(1, all.input, autocovariance, 0.0, Misfit::ignored);
  REQUIRE(line);
  const auto n = static_cast<Eigen::Index>(x.size());
  const auto used = static_cast<Eigen::Index>(all.input.rows.size());
  Eigen::MatrixXd of_e = Eigen::MatrixXd::Zero(used, n), sigma = Eigen::MatrixXd::Zero(n, n), design(used, 2);
  for (Eigen::Index j = 0; j < used; ++j) {
    const KernelRow& row = all.input.rows[static_cast<std::size_t>(j)];
    for (std::size_t i = 0; i < row.weights->a.size(); ++i) {
      of_e(j, static_cast<Eigen::Index>(row.first + i)) =
          row.weights->a[i] + line->k_over_m_1_s.value * row.weights->v[i];
    }
    design.row(j) << -all.input.v_m_s[static_cast<std::size_t>(j)], 1.0;
  }
  for (Eigen::Index r = 0; r < n; ++r) {
    for (Eigen::Index c = std::max<Eigen::Index>(0, r - 2); c < std::min(n, r + 3); ++c) {
      sigma(r, c) = autocovariance[static_cast<std::size_t>(std::abs(r - c))];
    }
  }
  const Eigen::MatrixXd gain = (design.transpose() * design).inverse() * design.transpose() * of_e;
  const Eigen::Matrix2d covariance = gain * sigma * gain.transpose();
  CHECK(line->parts.var_k == Approx(covariance(0, 0)).epsilon(1e-9));  // rounding
  CHECK(line->parts.var_a0 == Approx(covariance(1, 1)).epsilon(1e-9));
  CHECK(line->parts.cov == Approx(covariance(0, 1)).epsilon(1e-9));
}

TEST_CASE("intervals of a line hold the truth in 95 % of noisy clips, and the textbook's formula is off") {
  const tests::Law law{4.0, 0.006, 2.0};
  const auto exact = positions(law, 1.2, 300);
  const double noise_m = 1e-4, h = 0.03;
  std::mt19937_64 random(2024);
  std::normal_distribution<double> normal(0.0, noise_m);
  constexpr int kClips = 400;
  int inside = 0;
  double squares = 0.0, textbook = 0.0;
  for (int clip = 0; clip < kClips; ++clip) {
    auto x = exact;
    for (double& value : x) value += normal(random);
    const auto all = smoothed(x, 1, h);
    const auto line = fit_line(1, all.input, {noise_m * noise_m}, 0.0);
    REQUIRE(line);
    const double off = line->k_over_m_1_s.value - law.k_1_s;
    inside += line->k_over_m_1_s.low95 <= law.k_1_s && law.k_1_s <= line->k_over_m_1_s.high95;
    squares += std::pow(off - line->parts.smoothing_k, 2) / line->parts.var_k;
    double e2 = 0.0, vv = 0.0, mean = 0.0;
    const auto n = static_cast<double>(all.input.v_m_s.size());
    for (const double v : all.input.v_m_s) mean += v / n;
    for (std::size_t j = 0; j < all.input.v_m_s.size(); ++j) {
      const double v = all.input.v_m_s[j];
      e2 += std::pow(all.input.a_m_s2[j] - line->a0_m_s2.value + line->k_over_m_1_s.value * v, 2);
      vv += std::pow(v - mean, 2);
    }
    textbook += std::pow(off - line->parts.smoothing_k, 2) / (e2 / (n - 2.0) / vv);
  }
  // 95 % of 400 with sd 1.1 %: four of them, 90.6 %. The kernel's bias, added in quadrature, can only raise it.
  CHECK(inside >= 0.906 * kClips);
  // Mean square of the standardised noise: 1 with sd sqrt(2/400) = 0.071; four of them.
  CHECK(std::abs(squares / kClips - 1.0) < 0.29);
  // The textbook's formula for independent points does not pass the same test (here too wide: what a noisy position
  // does to one smoothed point it nearly takes back from its neighbours).
  CHECK(std::abs(textbook / kClips - 1.0) > 0.29);
}

TEST_CASE("points that are no line widen the interval, points that are do not") {
  auto x = positions({4.0, 0.006, 2.0}, 1.2, 300);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 2e-5);
  for (double& value : x) value += normal(random);
  const std::vector<double> autocovariance{4e-10};
  const auto straight = fit_line(1, smoothed(x, 1, 0.03).input, autocovariance, 0.0);
  CHECK(std::isinf(straight->parts.degrees));
  CHECK(straight->parts.scatter < 1.5);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 1e-3 * std::sin(5.0 * kStep * static_cast<double>(i));  // a bow
  const auto bent = fit_line(1, smoothed(x, 1, 0.03).input, autocovariance, 0.0);
  CHECK(bent->parts.scatter > 2.0);
  CHECK(bent->k_over_m_1_s.sd > 3.0 * straight->k_over_m_1_s.sd);
  CHECK(std::isfinite(bent->parts.degrees));
}

TEST_CASE("neighbouring residuals count as many independent ones as the squares of their correlations say") {
  // The variance of a sum of squares of normal numbers of covariance C is 2 tr C², so that it is worth (tr C)² / tr C²
  // independent ones; here for all residuals at once, of which those at the ends have fewer neighbours.
  const auto all = smoothed(positions({4.0, 0.006, 2.0}, 1.2, 800), 1, 0.03);
  const auto used = static_cast<Eigen::Index>(all.input.rows.size());
  const double k = 4.0;
  Eigen::MatrixXd of_e = Eigen::MatrixXd::Zero(used, 800);
  for (Eigen::Index j = 0; j < used; ++j) {
    const KernelRow& row = all.input.rows[static_cast<std::size_t>(j)];
    for (std::size_t i = 0; i < row.weights->a.size(); ++i) {
      of_e(j, static_cast<Eigen::Index>(row.first + i)) = row.weights->a[i] + k * row.weights->v[i];
    }
  }
  const Eigen::MatrixXd covariance = of_e * of_e.transpose();
  const double worth = std::pow(covariance.trace(), 2) / covariance.squaredNorm();
  const std::vector<double> residual(all.input.rows.size(), 1.0);
  const Scatter scatter = scatter_of(all.input, residual, k, {1.0});
  // A kernel reaches over a twentieth of the points or less: what the ends lack is less than that.
  CHECK(scatter.limit - 1.0 == Approx(chi2_ratio_limit(worth) - 1.0).epsilon(0.03));
  CHECK(scatter.ratio == Approx(static_cast<double>(used) / covariance.trace()).epsilon(1e-9));  // rounding
}

namespace {

/// Points of a line, each with a position and an error of its own: fit_line() then is ordinary least squares.
LineInput independent_points(double k, double a0, double error_m_s2, std::mt19937_64& random) {
  constexpr std::size_t kPoints = 400;
  std::normal_distribution<double> normal(0.0, error_m_s2);
  const auto weights = std::make_shared<const KernelWeights>(KernelWeights{{0.0}, {0.0}, {1.0}});
  LineInput input;
  input.track_points = kPoints;
  for (std::size_t j = 0; j < kPoints; ++j) {
    input.v_m_s.push_back(1.2 - static_cast<double>(j) / kPoints);
    input.a_m_s2.push_back(a0 - k * input.v_m_s[j] + normal(random));
    input.rows.push_back({j, weights});
  }
  input.stretch.assign(kPoints, 0);
  input.bias_a_m_s2.assign(kPoints, 0.0);
  input.mass_part_m_s2.assign(kPoints, 0.0);
  return input;
}

}  // namespace

TEST_CASE("noise that is twice what a clip says makes the covariance of twice the noise") {
  const double k = 4.0, a0 = 0.5, stated = 0.01, real = 2.0 * stated;
  std::mt19937_64 random(31);
  constexpr int kClips = 2000;
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero(), truth = Eigen::Matrix2d::Zero();
  int inside = 0;
  for (int clip = 0; clip < kClips; ++clip) {
    const LineInput input = independent_points(k, a0, real, random);
    const auto noise = fit_line(1, input, {stated * stated}, 0.0, Misfit::ignored);
    const auto line = fit_line(1, input, {stated * stated}, 0.0);
    REQUIRE((line && noise));
    Eigen::Matrix2d covariance;
    covariance << line->parts.var_k, line->parts.cov, line->parts.cov, line->parts.var_a0;
    mean += covariance / kClips;
    truth << noise->parts.var_k, noise->parts.cov, noise->parts.cov, noise->parts.var_a0;
    inside += line->a0_m_s2.low95 <= a0 && a0 <= line->a0_m_s2.high95;
    // Welch and Satterthwaite: a part that is known, and one from eight blocks less two for the line.
    const double wider = line->parts.var_a0 - noise->parts.var_a0;
    CHECK(line->parts.degrees == Approx(6.0 * std::pow(line->parts.var_a0 / wider, 2)).epsilon(1e-6));
  }
  truth *= std::pow(real / stated, 2);
  // Of the squares of eight blocks along v the fit takes up 1/8 + 1.8/8 = 0.35 for the slope (1.8: the kurtosis of even
  // v); 8/(8 - 2) gives back a quarter. So three quarters of the variance come out as 0.65 * 8/6 = 0.87 of themselves,
  // the whole as 0.90. A single clip's has a standard deviation of a half, the mean of 2000 one of 0.012.
  CHECK(mean(0, 0) / truth(0, 0) == Approx(0.90).margin(0.05));
  CHECK(mean(0, 1) / truth(0, 1) == Approx(0.90).margin(0.05));
  CHECK(mean(1, 1) / truth(1, 1) == Approx(0.90).margin(0.05));
  // 1900 of 2000 with a standard deviation of 10; four of them, and 5 % too narrow are 1.3 % of the clips.
  CHECK(std::abs(inside - 0.937 * kClips) < 60);
}

TEST_CASE("leaving out one at a time gives a mean the variance s²/n that a textbook gives it") {
  // Of the mean of n values y the i-th one's loss moves it by (m - y_i)/(n - 1); so (n - 1)/n of the sum of squares is
  // sum of (y - m)² / (n (n - 1)).
  const std::vector<double> y{0.3, -1.2, 2.5, 0.1, -0.7, 1.1};
  const auto n = static_cast<double>(y.size());
  double mean = 0.0, squares = 0.0, with_other = 0.0;
  for (const double value : y) mean += value / n;
  std::vector<Eigen::Vector2d> moved;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double off = y[i] - mean, other = i % 2 == 0 ? 1.0 : -1.0;
    squares += off * off;
    with_other += off * other;
    moved.push_back(Eigen::Vector2d(-off, -other) / (n - 1.0));
  }
  LineUncertainty parts;
  parts.var_k = parts.var_a0 = 1e-3;
  REQUIRE(widen_by_jackknife(moved, parts));
  CHECK(parts.var_k == Approx(squares / (n * (n - 1.0))).epsilon(1e-12));
  CHECK(parts.var_a0 == Approx(1.0 / (n - 1.0)).epsilon(1e-12));
  CHECK(parts.cov == Approx(with_other / (n * (n - 1.0))).epsilon(1e-12));
  CHECK(parts.degrees == n - 2.0);
  // A variance that the noise already makes larger stays, and the correlation is the jackknife's.
  LineUncertainty half;
  half.var_k = 1e-3;
  half.var_a0 = 4.0;
  REQUIRE(widen_by_jackknife(moved, half));
  CHECK(half.var_a0 == 4.0);
  CHECK(half.cov / std::sqrt(half.var_k * half.var_a0) ==
        Approx(parts.cov / std::sqrt(parts.var_k * parts.var_a0)).epsilon(1e-12));
  // What noise explains within chance stays as it is.
  LineUncertainty wide;
  wide.var_k = wide.var_a0 = 1.0;
  CHECK_FALSE(widen_by_jackknife(moved, wide));
  CHECK(wide.var_k == 1.0);
}

TEST_CASE("a clips' scatter adds to the covariance with its own correlation, wherever it adds to a variance") {
  const auto line_with = [](double var_k, double var_a0, double cov, const LineShift& shift) {
    LineFit line;
    line.parts.var_k = var_k;
    line.parts.var_a0 = var_a0;
    line.parts.cov = cov;
    line.parts.degrees = std::numeric_limits<double>::infinity();
    line.parts.clips = {shift, {-shift.k, -shift.a0}};
    line.parts.clip_degrees = 1.0;
    complete_line(line);
    return line;
  };
  // Two clips apart by (2 k, 2 a0): variances 2 k² and 2 a0², of correlation 1. Without a value there is no other
  // error.
  const LineFit both = line_with(1.0, 4.0, 0.5, {3.0, 5.0});
  CHECK(both.covariance == Approx(0.5 + std::sqrt(18.0 * 50.0) - 2.0).epsilon(1e-12));
  const LineFit one = line_with(1.0, 4.0, 1.9, {3.0, 0.1});  // a0 scatters by less than its noise
  CHECK(one.k_over_m_1_s.sd == Approx(std::sqrt(18.0)).epsilon(1e-12));
  CHECK(one.a0_m_s2.sd == Approx(2.0).epsilon(1e-12));
  CHECK(one.covariance == Approx(1.9 + std::sqrt(18.0 * 4.0) - 2.0).epsilon(1e-12));
  CHECK(one.covariance < one.k_over_m_1_s.sd * one.a0_m_s2.sd);
  CHECK(line_with(1.0, 4.0, 1.9, {0.1, 0.1}).covariance == Approx(1.9).epsilon(1e-12));
}

TEST_CASE("the scale's uncertainty is one of a0 and not of K/m, the mass's one of both where a force is known") {
  const auto all = smoothed(positions({4.0, 0.006, 2.0}, 1.2, 200), 1, 0.02);
  const auto exact = fit_line(1, all.input, {1e-16}, 0.0, Misfit::ignored);
  const auto scaled = fit_line(1, all.input, {1e-16}, 0.01, Misfit::ignored);
  CHECK(scaled->k_over_m_1_s.sd == exact->k_over_m_1_s.sd);
  const double expected = std::hypot(exact->a0_m_s2.sd, 0.01 * exact->a0_m_s2.value);
  CHECK(scaled->a0_m_s2.sd == Approx(expected).epsilon(1e-12));
  LineInput forced = all.input;
  for (std::size_t j = 0; j < forced.v_m_s.size(); ++j) forced.mass_part_m_s2[j] = 0.03 - 0.02 * forced.v_m_s[j];
  const auto heavy = fit_line(1, forced, {1e-16}, 0.0, Misfit::ignored);
  CHECK(heavy->parts.mass_k == Approx(0.02).epsilon(1e-9));  // the part is itself a line: rounding
  CHECK(heavy->parts.mass_a0 == Approx(0.03).epsilon(1e-9));
}

TEST_CASE("a displacement of all positions changes the line as a fit of the displaced positions does") {
  const tests::Law law{2.8, 0.006, 4.0};
  const std::vector<double> x = positions(law, 1.2, 250);
  const auto all = smoothed(x, 1, 0.03);
  // What an error of a camera looks like: an origin, a scale, a tilt of the plane, the lens at the field's ends.
  std::vector<std::vector<double>> modes(4);
  for (const double at : x) {
    modes[0].push_back(1e-4);
    modes[1].push_back(1e-4 * at);
    modes[2].push_back(1e-4 * at * at);
    modes[3].push_back(3e-5 * std::sin(7.0 * at));
  }
  auto input = all.input;
  input.calibration = calibration_shifts(all.motion, input, modes);
  const auto line = fit_line(1, input, {1e-10}, 0.0, Misfit::ignored);
  REQUIRE(line);
  REQUIRE(line->parts.calibration.size() == 4);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    std::vector<double> displaced = x;
    for (std::size_t i = 0; i < x.size(); ++i) displaced[i] += modes[k][i];
    const auto moved = fit_line(1, smoothed(displaced, 1, 0.03).input, {1e-10}, 0.0, Misfit::ignored);
    INFO("mode " << k);
    // The second order: displacements are 1e-4 of the positions, the fourth one's slope 2e-4.
    const double by_k = moved->k_over_m_1_s.value - line->k_over_m_1_s.value;
    const double by_a0 = moved->a0_m_s2.value - line->a0_m_s2.value;
    CHECK(line->parts.calibration[k].k == Approx(by_k).epsilon(5e-3).margin(1e-9));
    CHECK(line->parts.calibration[k].a0 == Approx(by_a0).epsilon(5e-3).margin(1e-9));
  }
  CHECK(std::abs(line->parts.calibration[0].k) + std::abs(line->parts.calibration[0].a0) < 1e-8);
  CHECK(line->parts.calibration[1].a0 == Approx(1e-4 * line->a0_m_s2.value).epsilon(1e-6));  // a scale
  CHECK(std::abs(line->parts.calibration[1].k) < 1e-9);
}

TEST_CASE("the terminal velocity is a0 over K/m, and null where the data do not determine it") {
  LineFit line;
  line.direction = 1;
  line.k_over_m_1_s.value = 2.0;
  line.a0_m_s2.value = 0.6;
  line.parts.var_k = 1e-4;
  line.parts.var_a0 = 4e-6;
  line.parts.cov = 1e-5;
  line.parts.scale_relative = 0.003;
  line.parts.degrees = std::numeric_limits<double>::infinity();
  complete_line(line);
  const Quantity v_lim = limit_velocity({line});
  REQUIRE(v_lim.estimate);
  CHECK(v_lim.estimate->value == Approx(0.3).epsilon(1e-14));
  // First order: (d a0 - v_lim d k) / k, and the scale.
  const double variance = (4e-6 - 2.0 * 0.3 * 1e-5 + 0.09 * 1e-4) / 4.0 + std::pow(0.003 * 0.3, 2);
  CHECK(v_lim.estimate->sd ==
        Approx(std::hypot(std::sqrt(variance), kClockSdRelative * v_lim.estimate->value)).epsilon(1e-12));

  line.a0_m_s2.value = -0.07;
  complete_line(line);
  CHECK_FALSE(limit_velocity({line}).estimate);
  CHECK(tests::reason_of<unknown::InterceptNotPositive>(limit_velocity({line})) != nullptr);
  line.a0_m_s2.value = 0.6;
  line.k_over_m_1_s.value = 0.01;
  complete_line(line);
  const Quantity level = limit_velocity({line});
  const auto* const rate = tests::reason_of<unknown::RateNotPositive>(level);
  REQUIRE(rate != nullptr);
  CHECK(rate->of_line);
  line.direction = -1;
  CHECK(tests::reason_of<unknown::NoDownhillLine>(limit_velocity({line})) != nullptr);
}

TEST_CASE("too few points or points of one v give no line") {
  const auto all = smoothed(positions({4.0, 0.006, 2.0}, 1.2, 200), 1, 0.02);
  LineInput few = all.input;
  few.v_m_s.resize(4);
  few.a_m_s2.resize(4);
  few.rows.resize(4);
  few.stretch.resize(4);
  few.bias_a_m_s2.resize(4);
  few.mass_part_m_s2.resize(4);
  CHECK_FALSE(fit_line(1, few, {1e-10}, 0.0));
  LineInput one = all.input;
  std::fill(one.v_m_s.begin(), one.v_m_s.end(), 0.3);
  CHECK_FALSE(fit_line(1, one, {1e-10}, 0.0));
}
