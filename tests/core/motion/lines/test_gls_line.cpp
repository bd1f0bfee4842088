#include "core/motion/lines/gls_line.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>

#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "tests/catch.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using core::LineMethod;
using tests::Law;

namespace {

const Law kInclined{4.3, 0.0071, 2.77};

core::ClipResult analyze(const Law& law, double v_m_s, const tests::Filming& how, LineMethod lines,
                         std::optional<double> bandwidth_s = {}) {
  core::MotionOptions options;
  options.lines = lines;
  options.bandwidth_s = bandwidth_s;
  const auto track = tests::film(tests::launch(law, v_m_s, how.duration_s), how);
  return core::analyze_motion(tests::clip_setup(v_m_s < 0.0 ? core::Launched::up : core::Launched::down, law.alpha_deg),
                              track, options);
}

bool covers(const core::Estimate& estimate, double truth) {
  return estimate.low95 <= truth && truth <= estimate.high95;
}

struct Line {
  double k = 0.0, a0 = 0.0, r2 = 0.0;
  double sd_k = 0.0, sd_a0 = 0.0;  ///< textbook: independent points
};

/// Ordinary least squares as a spreadsheet does it.
Line spreadsheet(const std::vector<double>& v, const std::vector<double>& a) {
  const auto n = static_cast<double>(v.size());
  double mean_v = 0.0, mean_a = 0.0, vv = 0.0, va = 0.0, aa = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    mean_v += v[i] / n;
    mean_a += a[i] / n;
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    vv += (v[i] - mean_v) * (v[i] - mean_v);
    va += (v[i] - mean_v) * (a[i] - mean_a);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
  }
  Line line;
  line.k = -va / vv;
  line.a0 = mean_a + line.k * mean_v;
  line.r2 = va * va / (vv * aa);
  const double variance = (aa - va * va / vv) / (n - 2.0);
  line.sd_k = std::sqrt(variance / vv);
  line.sd_a0 = std::sqrt(variance * (1.0 / n + mean_v * mean_v / vv));
  return line;
}

double mu_of(double minus, double plus) {
  const double mean = 0.5 * (minus + plus);
  return 0.5 * (minus - plus) / std::sqrt(tests::kGravity * tests::kGravity - mean * mean);
}

/// Cramér-Rao standard deviation of k: the closed form's derivatives by x0, v0, k, a0 over the points of one direction.
double least_sd_of_k(const std::vector<double>& t, double k, double a0, double v0, double noise_m) {
  Eigen::MatrixXd j(static_cast<Eigen::Index>(t.size()), 4);
  const auto x = [&](double time, double k_1_s, double a) {
    const tests::Phase phase{0.0, 0.0, v0, a, k_1_s};
    return phase.x(time);
  };
  for (Eigen::Index r = 0; r < j.rows(); ++r) {
    const double time = t[static_cast<std::size_t>(r)];
    j.row(r) << 1.0, -std::expm1(-k * time) / k, (x(time, k + 1e-5, a0) - x(time, k - 1e-5, a0)) / 2e-5,
        (x(time, k, a0 + 1e-5) - x(time, k, a0 - 1e-5)) / 2e-5;
  }
  const Eigen::MatrixXd information = j.transpose() * j / (noise_m * noise_m);
  return std::sqrt(information.inverse()(2, 2));
}

}  // namespace

TEST_CASE("generalised lines cover the truth, come near the bound, and textbook intervals of plain ones do not") {
  constexpr int kReplicates = 300;
  const double noise_m = 4e-4, h = 0.043;
  int k_covered[2] = {}, a0_covered[2] = {}, textbook_covered[2] = {};
  double square[2] = {};
  for (int seed = 1; seed <= kReplicates; ++seed) {
    const tests::Filming how{200.0, 1.7, noise_m, static_cast<unsigned>(seed)};
    const auto clip = analyze(kInclined, -1.3, how, LineMethod::generalised, h);
    REQUIRE(clip.segments.size() == 2);
    for (const core::LineFit& line : clip.segments) {
      const bool down = line.direction > 0;
      k_covered[down] += covers(line.k_over_m_1_s, kInclined.k_1_s);
      a0_covered[down] += covers(line.a0_m_s2, kInclined.a0(line.direction));
      square[down] += std::pow(line.k_over_m_1_s.value - kInclined.k_1_s, 2) / kReplicates;
      std::vector<double> v, a;
      for (const core::MotionPoint& point : clip.motion) {
        if (point.left_out != core::LeftOut::used || (point.v_m_s > 0.0) != down) continue;
        v.push_back(point.v_m_s);
        a.push_back(point.a_m_s2);
      }
      const Line plain = spreadsheet(v, a);
      textbook_covered[down] += std::abs(plain.k - kInclined.k_1_s) < 1.96 * plain.sd_k;
    }
  }
  const double turn_s = std::log(1.0 + 1.3 * kInclined.k_1_s / kInclined.a0(-1)) / kInclined.k_1_s;
  std::vector<double> before, after;
  for (double t = 0.0; t < 1.7001; t += 0.005) (t < turn_s ? before : after).push_back(t < turn_s ? t : t - turn_s);
  const double least[2] = {least_sd_of_k(before, kInclined.k_1_s, kInclined.a0(-1), -1.3, noise_m),
                           least_sd_of_k(after, kInclined.k_1_s, kInclined.a0(1), 0.0, noise_m)};
  for (const int down : {0, 1}) {
    INFO("direction " << down << ": K " << k_covered[down] << ", a0 " << a0_covered[down] << ", textbook "
                      << textbook_covered[down] << " of 300; sd of K " << std::sqrt(square[down]) << ", least "
                      << least[down]);
    // 285 +- 3.8 of 300; three standard deviations, and one point in a hundred for a noise that is itself estimated.
    CHECK(k_covered[down] >= 271);
    CHECK(k_covered[down] <= 297);
    CHECK(a0_covered[down] >= 271);
    CHECK(a0_covered[down] <= 297);
    CHECK(textbook_covered[down] < 240);  // 80 %
    // The standard deviation of 300 draws is known to 4 %: three times that, and 5 % for what nodes leave out.
    CHECK(std::sqrt(square[down]) < 1.17 * least[down]);
    CHECK(std::sqrt(square[down]) > 0.88 * least[down]);
  }
}

TEST_CASE("generalised lines of times that jitter by most of a step state the errors that they have") {
  constexpr int kReplicates = 150;
  constexpr double kNoise_m = 5e-5, kStep_s = 0.005, kJitter = 0.4;
  const tests::SimulatedMotion motion = tests::launch(kInclined, -1.0, 2.1);
  const core::ClipSetup setup = tests::clip_setup(core::Launched::up, kInclined.alpha_deg);
  core::MotionOptions options;
  options.lines = LineMethod::generalised;
  double of_mu = 0.0, of_alpha = 0.0, of_k = 0.0;
  for (unsigned seed = 1; seed <= kReplicates; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, kNoise_m);
    std::uniform_real_distribution<double> jitter(-kJitter, kJitter);
    core::TrackData track;
    track.frame_rate_hz = 1.0 / kStep_s;
    for (std::size_t i = 0; i < 400; ++i) {
      track.t_s.push_back((static_cast<double>(i) + 0.5 + jitter(random)) * kStep_s);
      track.x_m.push_back(motion.x(track.t_s.back()) + noise(random));
      track.frame.push_back(i);
    }
    track.frame_t_s = track.t_s;
    const core::ClipResult clip = core::analyze_motion(setup, track, options);
    const auto found = core::configurations_of_clips({setup}, {clip}, tests::kGravity, options.lines).front();
    const auto z2 = [](const core::Quantity& quantity, double truth) {
      REQUIRE(quantity.estimate);
      return std::pow((quantity.estimate->value - truth) / quantity.estimate->sd, 2) / kReplicates;
    };
    of_mu += z2(found.mu, kInclined.mu);
    of_alpha += z2(found.alpha_deg, kInclined.alpha_deg);
    of_k += z2(found.k_over_m_1_s, kInclined.k_1_s);
  }
  // Root mean square z of 150: sd 1/sqrt(300) = 0.058; three of them.
  for (const double sum : {of_mu, of_alpha, of_k}) CHECK(std::sqrt(sum) == Approx(1.0).margin(0.175));
}

TEST_CASE("generalised lines do not depend on the bandwidth, and have no bias by it") {
  for (const double h : {0.02, 0.043, 0.08}) {
    double k[2] = {}, a0[2] = {};
    constexpr int kClips = 40;
    double sd_k[2] = {}, sd_a0[2] = {};
    for (int seed = 1; seed <= kClips; ++seed) {
      const auto clip =
          analyze(kInclined, -1.3, {200.0, 1.7, 2e-5, static_cast<unsigned>(seed)}, LineMethod::generalised, h);
      REQUIRE(clip.segments.size() == 2);
      for (const core::LineFit& line : clip.segments) {
        k[line.direction > 0] += line.k_over_m_1_s.value / kClips;
        a0[line.direction > 0] += line.a0_m_s2.value / kClips;
        sd_k[line.direction > 0] = line.k_over_m_1_s.sd;
        sd_a0[line.direction > 0] = line.a0_m_s2.sd;
      }
    }
    for (const int down : {0, 1}) {
      INFO("h " << h << " direction " << down);
      // The mean of 40 has sd / sqrt(40); four of those, and a tenth of one clip's sd for the estimated event.
      CHECK(std::abs(k[down] - kInclined.k_1_s) < 0.75 * sd_k[down]);
      CHECK(std::abs(a0[down] - kInclined.a0(down ? 1 : -1)) < 0.75 * sd_a0[down]);
    }
  }
}

TEST_CASE("a kernel of 80 ms over a reversal or an end makes mu wrong by tens of percent at R^2 above 0.999") {
  const double h = 0.08;
  // Smoothed across the reversal, both directions' accelerations mix: all points count, as in a spreadsheet.
  const Law inclined{4.3, 0.004, 1.73};
  const tests::Filming how{200.0, 2.2, 1e-5, 1};
  const auto track = tests::film(tests::launch(inclined, -1.3, 2.2), how);
  const auto smoothed = core::LocalCubic(track.t_s, h).smooth(track.x_m);
  std::vector<double> v[2], a[2];
  for (std::size_t i = 0; i < smoothed.size(); ++i) {
    if (track.t_s[i] < 2.5 * h || track.t_s[i] > 2.2 - 2.5 * h) continue;
    v[smoothed[i]->v_m_s > 0.0].push_back(smoothed[i]->v_m_s);
    a[smoothed[i]->v_m_s > 0.0].push_back(smoothed[i]->a_m_s2);
  }
  const Line minus = spreadsheet(v[0], a[0]), plus = spreadsheet(v[1], a[1]);
  INFO("mu across the reversal: " << mu_of(minus.a0, plus.a0));
  CHECK(minus.r2 > 0.999);
  CHECK(plus.r2 > 0.999);
  CHECK(mu_of(minus.a0, plus.a0) < 0.8 * inclined.mu);
  const auto of_gls = [&](const core::ClipResult& clip) {
    REQUIRE(clip.segments.size() == 2);
    return mu_of(clip.segments[0].a0_m_s2.value, clip.segments[1].a0_m_s2.value);
  };
  CHECK(of_gls(analyze(inclined, -1.3, how, LineMethod::generalised, h)) == Approx(inclined.mu).epsilon(0.03));

  // On a level track, up to just before it rests: the last points' kernels are one-sided, and each counts as much as
  // any other. Overstated by a fifth.
  const Law level{0.0, 0.0075, 2.88};
  const double rest_s = std::log(1.0 + 1.0 * level.k_1_s / level.friction()) / level.k_1_s;
  const tests::Filming before{200.0, rest_s - 0.005, 1e-5, 1};
  const auto alone = tests::film(tests::launch(level, 1.0, 2.0), before);
  const auto all = core::LocalCubic(alone.t_s, h).smooth(alone.x_m);
  std::vector<double> level_v, level_a;
  for (const auto& point : all) {
    level_v.push_back(point->v_m_s);
    level_a.push_back(point->a_m_s2);
  }
  const Line plain = spreadsheet(level_v, level_a);
  INFO("mu on the level: " << -plain.a0 / tests::kGravity);
  CHECK(plain.r2 > 0.999);
  CHECK(-plain.a0 / tests::kGravity > 1.15 * level.mu);
  const auto clip = analyze(level, 1.0, before, LineMethod::generalised, h);
  REQUIRE(clip.segments.size() == 1);
  CHECK(-clip.segments[0].a0_m_s2.value / tests::kGravity == Approx(level.mu).epsilon(0.03));
}

TEST_CASE("no point near v = 0 is thrown away: the pieces reach to the estimated event") {
  const auto count = [](LineMethod lines) {
    const auto clip = analyze(kInclined, -1.3, {200.0, 1.7, 1e-4, 1}, lines, 0.05);
    std::size_t points = 0;
    for (const core::LineFit& line : clip.segments) points += line.points;
    return points;
  };
  CHECK(count(LineMethod::generalised) >= 335);  // of 341: two standard deviations of the event on both sides, 2 ms
  CHECK(count(LineMethod::ordinary) < 260);
}

TEST_CASE("a law that is no line widens a generalised line's interval") {
  // Quadratic drag v' = -c v^2: v = v0 / (1 + c v0 t), x = log(1 + c v0 t) / c.
  core::TrackData track;
  track.frame_rate_hz = 200.0;
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 2e-5);
  for (std::size_t i = 0; i < 300; ++i) {
    track.t_s.push_back(0.005 * static_cast<double>(i));
    track.x_m.push_back(std::log(1.0 + 1.2 * track.t_s.back()) + noise(random));
    track.frame.push_back(i);
  }
  track.frame_t_s = track.t_s;
  core::MotionOptions options;
  options.lines = LineMethod::generalised;
  const auto clip = core::analyze_motion(tests::clip_setup(core::Launched::down, 0.0), track, options);
  REQUIRE(clip.segments.size() == 1);
  const core::LineFit& line = clip.segments[0];
  CHECK(line.parts.scatter > 2.0);
  // The tangents' slopes run from 2 * 1.2 down to 2 * 1.2 / (1 + 1.2 * 1.5) = 0.86: noise alone would say 1e-3.
  CHECK(line.k_over_m_1_s.sd > 0.02);
}

TEST_CASE("joined clips of generalised lines are weighed by what each of them knows") {
  // One clip has ten times the noise: the joint K/m is the quiet one's, within its share of the weight (1 %).
  const auto quiet = analyze(kInclined, -1.3, {200.0, 1.7, 2e-5, 1}, LineMethod::generalised);
  const auto loud = analyze(kInclined, -1.3, {200.0, 1.7, 2e-4, 2}, LineMethod::generalised);
  const std::vector<core::ClipSetup> setups(2, tests::clip_setup(core::Launched::up, 4.0));
  const auto joined = core::configurations_of_clips(setups, {quiet, loud}, tests::kGravity, LineMethod::generalised);
  REQUIRE(joined.size() == 1);
  REQUIRE(joined[0].lines.size() == 2);
  for (std::size_t d = 0; d < 2; ++d) {
    const double of_quiet = quiet.segments[d].k_over_m_1_s.value, of_loud = loud.segments[d].k_over_m_1_s.value;
    CHECK(std::abs(joined[0].lines[d].k_over_m_1_s.value - of_quiet) < 0.05 * std::abs(of_loud - of_quiet));
  }
  CHECK(covers(*joined[0].mu.estimate, kInclined.mu));
  CHECK(joined[0].mu.estimate->sd < 0.05 * kInclined.mu);
}

namespace {

/// A run down the inclined track with white noise, as one piece.
struct OnePiece {
  core::Motion motion;
  std::vector<core::FreePiece> pieces;
  core::GlsInput input;
};

OnePiece one_piece(double noise_m, double stated_m, std::mt19937_64& random) {
  constexpr std::size_t kPoints = 300;
  std::normal_distribution<double> normal(0.0, noise_m);
  const auto run = tests::launch(kInclined, 0.2, 1.6);
  OnePiece all;
  for (std::size_t i = 0; i < kPoints; ++i) {
    all.motion.t_s.push_back(0.005 * static_cast<double>(i));
    all.motion.x_m.push_back(run.x(all.motion.t_s.back()) + normal(random));
    all.motion.point.push_back(i);
  }
  all.motion.y_m = all.motion.x_m;
  all.motion.step_s = 0.005;
  all.pieces = {{0, kPoints, 1}};
  all.input.bandwidth_s = 0.03;
  all.input.autocovariance = {stated_m * stated_m};
  all.input.k_start_1_s = kInclined.k_1_s;
  return all;
}

/// rho' C^-1 rho at the best a0, by dense matrices.
double chi2_of(const core::LineNodes& nodes, double k) {
  const Eigen::MatrixXd lower = nodes.covariance(k);
  const Eigen::MatrixXd covariance = lower.selfadjointView<Eigen::Lower>();
  const Eigen::LDLT<Eigen::MatrixXd> inverse(covariance);
  const core::NodeResidual at = nodes.residual(k);
  const double a0 = at.p.dot(inverse.solve(at.y)) / at.p.dot(inverse.solve(at.p));
  const Eigen::VectorXd rho = at.y - a0 * at.p;
  return rho.dot(inverse.solve(rho));
}

}  // namespace

TEST_CASE("the K/m of a generalised line is where rho' C(k)^-1 rho is least, C(k) and all") {
  std::mt19937_64 random(12);
  const double noise_m = 2e-4;
  for (int clip = 0; clip < 5; ++clip) {
    const OnePiece all = one_piece(noise_m, noise_m, random);
    const auto line = core::fit_line_gls(1, all.motion, all.pieces, all.input);
    REQUIRE(line);
    const auto count = static_cast<std::size_t>(std::lround(299 * 0.005 / all.input.bandwidth_s)) + 1;
    const core::LineNodes nodes(all.motion, all.pieces[0], all.input, count);
    REQUIRE(nodes.well_conditioned(kInclined.k_1_s));
    const double k = line->k_over_m_1_s.value, sd = std::sqrt(line->parts.var_k);
    CHECK(line->parts.scatter == Approx(std::sqrt(chi2_of(nodes, k) / (nodes.count() - 2))).epsilon(1e-6));
    // The parabola through three values has its least within 0.003 sd: the search ends at 1e-4 sd, by the first
    // derivatives of rho alone, and the third derivative of chi² is worth the rest.
    const double below = chi2_of(nodes, k - 0.1 * sd), at = chi2_of(nodes, k), above = chi2_of(nodes, k + 0.1 * sd);
    const double least_sd = 0.05 * (below - above) / (below - 2.0 * at + above);
    INFO("least at " << least_sd << " standard deviations");
    CHECK(std::abs(least_sd) < 0.003);
  }
}

TEST_CASE("noise that is twice what a clip says makes the covariance of twice the noise, for a generalised line too") {
  std::mt19937_64 random(13);
  const double stated_m = 1e-4, noise_m = 2.0 * stated_m;
  constexpr int kClips = 300;
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero(), truth = Eigen::Matrix2d::Zero();
  for (int clip = 0; clip < kClips; ++clip) {
    OnePiece all = one_piece(noise_m, stated_m, random);
    const auto line = core::fit_line_gls(1, all.motion, all.pieces, all.input);
    all.input.autocovariance = {noise_m * noise_m};
    const auto known = core::fit_line_gls(1, all.motion, all.pieces, all.input);
    REQUIRE((line && known));
    if (std::isinf(known->parts.degrees)) {
      // 51 nodes in nine blocks, less two for the line; the part that is known is that of the stated noise.
      // Both searches for k end within 1e-4 of its standard deviation.
      const double wider = line->parts.var_a0 - known->parts.var_a0 * std::pow(stated_m / noise_m, 2);
      CHECK(line->parts.degrees == Approx(7.0 * std::pow(line->parts.var_a0 / wider, 2)).epsilon(1e-4));
    }
    mean(0, 0) += line->parts.var_k / kClips;
    mean(0, 1) += line->parts.cov / kClips;
    mean(1, 1) += line->parts.var_a0 / kClips;
    truth(0, 0) += known->parts.var_k / kClips;
    truth(0, 1) += known->parts.cov / kClips;
    truth(1, 1) += known->parts.var_a0 / kClips;
  }
  INFO(mean << "\n" << truth);
  CHECK(mean(0, 0) / truth(0, 0) == Approx(0.90).margin(0.05));
  CHECK(mean(0, 1) / truth(0, 1) == Approx(0.90).margin(0.05));
  CHECK(mean(1, 1) / truth(1, 1) == Approx(0.90).margin(0.05));
}
