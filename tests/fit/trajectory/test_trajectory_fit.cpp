#include "fit/trajectory/trajectory_fit.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "fit/trajectory/trajectory_results.h"
#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"
#include "tests/core/notes.h"

using namespace glidelab;

namespace {

constexpr double kGravity = 9.80665;
const Eigen::Vector3d kLaw(2.1, 0.735, 0.048);  // the paper's middle mass on its incline

/// Closed form of equation (8), every 5 ms, with white noise.
core::FreeBlock block_of(const Eigen::Vector3d& law, double x0_m, double v0_m_s, double duration_s, double noise_m,
                         std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  core::FreeBlock block;
  bool turned = false;
  for (double t = 0.0; t < duration_s; t += 0.005) {
    const sim::State state = sim::viscous_coulomb_motion({law[1], law[2], law[2]}, law[0], x0_m, v0_m_s, t);
    block.t_s.push_back(2.0 + t);
    block.x_m.push_back(state.x_m + noise_m * normal(random));
    turned = turned || state.v_m_s * v0_m_s < 0.0;
  }
  const int first = v0_m_s < 0.0 ? -1 : 1;
  block.directions = turned ? std::vector<int>{first, -first} : std::vector<int>{first};
  return block;
}

/// As in the paper: up and back again, and down.
struct Pair {
  core::FreeBlock up, down;
  std::vector<fit::FitBlock> blocks;
  Pair(double noise_m, std::mt19937& random)
      : up(block_of(kLaw, 0.2, -1.2, 1.7, noise_m, random)), down(block_of(kLaw, -0.5, 1.2, 1.7, noise_m, random)) {
    const double variance = noise_m * noise_m;
    blocks = {{&up, {variance}, 0.0}, {&down, {variance}, 0.0}};
  }
};

const Eigen::Vector3d kStart(1.8, 0.7, 0.06);

}  // namespace

TEST_CASE("the fit of the whole motion finds the law of noise-free motions that turn") {
  std::mt19937 random(1);
  const Pair pair(0.0, random);
  const auto fit = fit::fit_trajectories(pair.blocks, kStart);
  REQUIRE(fit);
  // The solver is good to 1e-9 m; a metre of motion makes 1e-8 of the parameters of it.
  CHECK((fit->parameters - kLaw).norm() < 1e-6);
  CHECK(std::abs(fit->starts[0][1] + 1.2) < 1e-6);
  CHECK(fit->direction == 0);
}

TEST_CASE("errors of 200 noisy replicates are as large as stated, for every parameter") {
  std::mt19937 random(20261121);
  constexpr int kReplicates = 200;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), means = squares;
  for (int i = 0; i < kReplicates; ++i) {
    const Pair pair(1e-4, random);
    const auto fit = fit::fit_trajectories(pair.blocks, kStart);
    REQUIRE(fit);
    CHECK(std::abs(fit->scatter - 1.0) < 0.15);  // 680 points: 0.027 is one standard deviation
    const Eigen::Vector3d z = (Eigen::Vector3d(fit->parameters) - kLaw)
                                  .cwiseQuotient(Eigen::MatrixXd(fit->covariance).diagonal().cwiseSqrt());
    squares += z.cwiseAbs2() / kReplicates;
    means += z / kReplicates;
  }
  // The mean square of 200 standard normal numbers has the standard deviation 0.1; the mean, 0.07.
  for (int p = 0; p < 3; ++p) {
    INFO("parameter " << p << ": mean square " << squares[p] << ", mean " << means[p]);
    CHECK(std::abs(squares[p] - 1.0) < 0.35);
    CHECK(std::abs(means[p]) < 0.25);
  }
}

TEST_CASE("an error of the camera moves the fit as the stated shift says") {
  std::mt19937 random(3);
  Pair pair(1e-5, random);
  for (core::FreeBlock* block : {&pair.up, &pair.down}) {
    block->shared_m.resize(1);
    for (const double x : block->x_m) block->shared_m[0].push_back(2e-4 * x * x);
  }
  const auto before = fit::fit_trajectories(pair.blocks, kStart);
  REQUIRE(before);
  for (core::FreeBlock* block : {&pair.up, &pair.down}) {
    for (std::size_t i = 0; i < block->x_m.size(); ++i) block->x_m[i] += block->shared_m[0][i];
  }
  const auto after = fit::fit_trajectories(pair.blocks, kStart);
  REQUIRE(after);
  REQUIRE(before->shared.size() == 3);  // the mode, the scale and the clock
  const Eigen::VectorXd moved = after->parameters - before->parameters;
  // To first order: the shift is a thousandth of the parameters, so its square is a thousandth of itself.
  CHECK((moved - before->shared[0]).norm() < 0.02 * moved.norm());
}

namespace {

/// One clip, downhill.
core::AnalysisResults downhill_only() {
  std::mt19937 random(4);
  core::AnalysisResults results;
  results.gravity_m_s2 = kGravity;
  core::ClipResult clip;
  clip.name = "down";
  clip.noise_autocovariance_m2 = {1e-10};
  clip.blocks = {block_of(kLaw, -0.5, 1.2, 1.7, 1e-5, random)};
  results.clips = {clip};
  core::ConfigurationResult configuration;
  configuration.clips = {"down"};
  results.configurations = {configuration};
  return results;
}

}  // namespace

TEST_CASE("motion in one direction determines K/m and the intercept, and says that the two parts are not apart") {
  const core::AnalysisResults fitted = fit::with_trajectory_fits(downhill_only());
  CHECK(fitted.estimator == "trajectory");
  const core::ConfigurationResult& found = fitted.configurations[0];
  REQUIRE(found.k_over_m_1_s.estimate);
  CHECK(std::abs(found.k_over_m_1_s.estimate->value - kLaw[0]) < 5.0 * found.k_over_m_1_s.estimate->sd);
  REQUIRE(found.v_lim_m_s.estimate);
  CHECK(std::abs(found.v_lim_m_s.estimate->value - (kLaw[1] - kLaw[2]) / kLaw[0]) < 5.0 * found.v_lim_m_s.estimate->sd);
  CHECK_FALSE(found.mu.estimate);
  CHECK_FALSE(found.alpha_deg.estimate);
  const auto* const one_way = tests::reason_of<core::unknown::OneDirection>(found.mu);
  REQUIRE(one_way != nullptr);
  CHECK(one_way->direction == 1);
  CHECK(std::abs(one_way->a0_m_s2 - (kLaw[1] - kLaw[2])) < 5.0 * one_way->sd_m_s2);
  CHECK(one_way->sd_m_s2 < 1e-3);
}

TEST_CASE("motion in one direction gives mu where the inclination is stated with its uncertainty") {
  constexpr double kDegrees = 180.0 / std::numbers::pi, kAngle_sd_deg = 0.05;
  const double alpha = std::asin(kLaw[1] / kGravity), mu = kLaw[2] / (kGravity * std::cos(alpha));
  core::AnalysisResults results = downhill_only();
  core::ConfigurationResult& stated = results.configurations[0];
  stated.incline_deg = alpha * kDegrees;
  stated.incline_sd_deg = kAngle_sd_deg;
  const core::ConfigurationResult found = fit::with_trajectory_fits(results).configurations[0];
  REQUIRE(found.mu.estimate);
  CHECK_FALSE(found.alpha_deg.estimate);
  CHECK(tests::note_of<core::MuFromIncline>(found.notes) != nullptr);
  const auto* const one_way = tests::reason_of<core::unknown::OneDirection>(found.alpha_deg);
  REQUIRE(one_way != nullptr);
  CHECK(std::abs(found.mu.estimate->value - mu) < 5.0 * one_way->sd_m_s2 / kGravity);
  // mu = tan(alpha) - a0/(g cos): to first order in alpha, whose square is 0.006.
  const double by_hand = std::hypot(kAngle_sd_deg / kDegrees, one_way->sd_m_s2 / kGravity);
  CHECK(found.mu.estimate->sd == Approx(by_hand).epsilon(0.01));

  stated.incline_sd_deg.reset();
  const core::ConfigurationResult without = fit::with_trajectory_fits(results).configurations[0];
  const auto* const why = tests::reason_of<core::unknown::OneDirection>(without.mu);
  REQUIRE(why != nullptr);
  CHECK(why->incline_would_do);
  CHECK(tests::note_of<core::MuFromIncline>(without.notes) == nullptr);
}

TEST_CASE("the fit of the whole motion keeps what was said of the recording, and doubts stated inclinations only") {
  core::AnalysisResults results = downhill_only();
  core::ConfigurationResult configuration = results.configurations[0];
  configuration.mass_kg = 0.2;
  configuration.notes = {core::AssumedStatements{{}, true}};
  core::LineFit line;
  line.direction = 1;
  line.k_over_m_1_s.value = kLaw[0];
  line.a0_m_s2 = {kLaw[1] - kLaw[2], 1e-4};
  configuration.lines = {line};
  // The motion itself needs an inclination of at least asin((g sin(alpha) - mu g cos(alpha)) / g).
  REQUIRE((kLaw[1] - kLaw[2]) / kGravity > std::sin(0.05));
  const auto notes = [&](bool assumed) {
    configuration.incline_assumed = assumed;
    results.configurations = {configuration};
    return fit::with_trajectory_fits(results).configurations[0].notes;
  };
  const std::vector<core::Note> of_assumed = notes(true), of_stated = notes(false);
  CHECK(tests::note_of<core::AssumedStatements>(of_assumed) != nullptr);
  CHECK(tests::note_of<core::InclineContradiction>(of_assumed) == nullptr);
  CHECK(tests::note_of<core::InclineContradiction>(of_stated) != nullptr);
  // What the lines had already contradicted is said once.
  configuration.notes = of_stated;
  CHECK(notes(false).size() == of_stated.size());
}

namespace {

/// Clips "up" and "down" with the noise of 50 um that the pair was made with; no configuration yet.
core::AnalysisResults results_of(const Pair& pair) {
  core::AnalysisResults results;
  results.gravity_m_s2 = kGravity;
  for (const core::FreeBlock* block : {&pair.up, &pair.down}) {
    core::ClipResult clip;
    clip.name = block == &pair.up ? "up" : "down";
    clip.noise_autocovariance_m2 = {25e-10};
    clip.blocks = {*block};
    results.clips.push_back(clip);
  }
  return results;
}

}  // namespace

TEST_CASE("both directions give alpha, mu and v_lim with intervals that hold the truth") {
  std::mt19937 random(5);
  const Pair pair(5e-5, random);
  core::AnalysisResults results = results_of(pair);
  core::ConfigurationResult configuration;
  configuration.clips = {"up", "down"};
  results.configurations = {configuration};
  const core::ConfigurationResult found = fit::with_trajectory_fits(results).configurations[0];
  const double alpha = std::asin(kLaw[1] / kGravity);
  const auto close = [](const core::Quantity& quantity, double truth) {
    REQUIRE(quantity.estimate);
    INFO(quantity.estimate->value << " ± " << quantity.estimate->sd << ", truth " << truth);
    CHECK(std::abs(quantity.estimate->value - truth) < 4.0 * quantity.estimate->sd);
    CHECK(quantity.estimate->sd < 0.01 * truth);
  };
  close(found.k_over_m_1_s, kLaw[0]);
  close(found.alpha_deg, alpha * 57.29577951308232);
  close(found.mu, kLaw[2] / (kGravity * std::cos(alpha)));
  close(found.v_lim_m_s, (kLaw[1] - kLaw[2]) / kLaw[0]);
}

TEST_CASE("a clip without free motion is not fitted, and says so") {
  core::AnalysisResults results;
  results.gravity_m_s2 = kGravity;
  core::ClipResult clip;
  clip.name = "motor";
  results.clips = {clip};
  core::ConfigurationResult configuration;
  configuration.clips = {"motor"};
  results.configurations = {configuration};
  const core::AnalysisResults fitted = fit::with_trajectory_fits(results);
  CHECK(tests::reason_of<core::unknown::NoFreeMotion>(fitted.configurations[0].k_over_m_1_s) != nullptr);
}

TEST_CASE("what is stated wrong is noted beside the fit of the whole motion as it is beside lines") {
  std::mt19937 random(6);
  const Pair pair(5e-5, random);
  core::AnalysisResults results = results_of(pair);
  core::ConfigurationResult light, heavy;
  light.mass_kg = 0.335;
  heavy.mass_kg = 335.0;
  light.clips = heavy.clips = {"up", "down"};
  light.incline_deg = heavy.incline_deg = std::asin(kLaw[1] / kGravity) * 57.29577951308232;
  results.configurations = {light, heavy};
  const auto fitted = fit::with_trajectory_fits(results).configurations;
  CHECK(fitted[0].notes.empty());
  REQUIRE(fitted[1].notes.size() == 1);
  CHECK(std::holds_alternative<core::MassInGrams>(fitted[1].notes[0]));
  results.gravity_m_s2 *= 1.6;
  const auto notes = fit::with_trajectory_fits(results).configurations[0].notes;
  REQUIRE(notes.size() == 1);
  REQUIRE(std::holds_alternative<core::InclineContradiction>(notes[0]));
  CHECK(std::get<core::InclineContradiction>(notes[0]).stated.by == "incline_deg");
}

namespace {

/// The four quantities of a fit of both directions: K/m, mu, alpha in degrees, v_lim.
Eigen::VectorXd quantities_of(const Eigen::VectorXd& p) {
  const double alpha = std::asin(p[1] / kGravity);
  return Eigen::Vector4d(p[0], p[2] / (kGravity * std::cos(alpha)), alpha * 57.29577951308232, (p[1] - p[2]) / p[0]);
}

/// sd² = g' (covariance + shared errors) g with g by central differences, and its random part.
template <typename Quantities>
std::vector<std::pair<double, double>> variances_of(const fit::TrajectoryFit& fit, Quantities quantities) {
  std::vector<std::pair<double, double>> all(static_cast<std::size_t>(quantities(fit.parameters).size()));
  Eigen::MatrixXd by(quantities(fit.parameters).size(), fit.parameters.size());
  constexpr double kStep = 1e-6;  // an error of 1e-12 times third derivatives of up to 1e2
  for (Eigen::Index p = 0; p < fit.parameters.size(); ++p) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(fit.parameters.size(), p);
    by.col(p) = (quantities(fit.parameters + step) - quantities(fit.parameters - step)) / (2.0 * kStep);
  }
  Eigen::MatrixXd total = fit.covariance;
  for (const Eigen::VectorXd& shift : fit.shared) total += shift * shift.transpose();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::VectorXd g = by.row(static_cast<Eigen::Index>(i));
    all[i] = {g.dot(total * g), g.dot(fit.covariance * g)};
  }
  return all;
}

void check_sds(const core::Quantity& quantity, double value, const std::pair<double, double>& variances) {
  REQUIRE(quantity.estimate);
  // The two fits start from other guesses, and stop where the cost settles to 1e-10 of itself.
  CHECK(quantity.estimate->value == Approx(value).epsilon(1e-6));
  CHECK(quantity.estimate->sd == Approx(std::sqrt(variances.first)).epsilon(1e-5));
  CHECK(quantity.noise_sd.value() == Approx(std::sqrt(variances.second)).epsilon(1e-5));
}

}  // namespace

TEST_CASE("every quantity has the variance of its numerical gradient, errors that the positions share included") {
  std::mt19937 random(8);
  Pair pair(5e-5, random);
  for (core::FreeBlock* block : {&pair.up, &pair.down}) {
    block->shared_m.resize(1);
    for (const double x : block->x_m) block->shared_m[0].push_back(3e-4 * x * x);
  }
  core::AnalysisResults results = results_of(pair);
  for (core::ClipResult& clip : results.clips) clip.scale_sd_relative = 2e-3;
  core::ConfigurationResult both, down;
  both.clips = {"up", "down"};
  down.clips = {"down"};
  results.configurations = {both, down};
  const auto found = fit::with_trajectory_fits(results).configurations;

  for (fit::FitBlock& block : pair.blocks) block.scale_sd_relative = 2e-3;
  const auto of_both = fit::fit_trajectories(pair.blocks, kStart);
  REQUIRE(of_both);
  const Eigen::VectorXd values = quantities_of(of_both->parameters);
  const auto variances = variances_of(*of_both, quantities_of);
  check_sds(found[0].k_over_m_1_s, values[0], variances[0]);
  check_sds(found[0].mu, values[1], variances[1]);
  check_sds(found[0].alpha_deg, values[2], variances[2]);
  check_sds(found[0].v_lim_m_s, values[3], variances[3]);
  // Both parts count, or the test would show less.
  for (const auto& [total, noise] : variances) CHECK(total > 1.1 * noise);

  const auto of_down = fit::fit_trajectories({pair.blocks[1]}, kStart);
  REQUIRE(of_down);
  REQUIRE(of_down->parameters.size() == 2);
  const auto k_and_limit = [](const Eigen::VectorXd& p) { return Eigen::VectorXd(Eigen::Vector2d(p[0], p[1] / p[0])); };
  const auto one_way = variances_of(*of_down, k_and_limit);
  check_sds(found[1].k_over_m_1_s, of_down->parameters[0], one_way[0]);
  check_sds(found[1].v_lim_m_s, of_down->parameters[1] / of_down->parameters[0], one_way[1]);
}

TEST_CASE("where gravity is not stated, alpha and mu of the whole motion contain its uncertainty, and a note says so") {
  std::mt19937 random(9);
  const Pair pair(5e-5, random);
  core::AnalysisResults results = results_of(pair);
  core::ConfigurationResult both;
  both.clips = {"up", "down"};
  results.configurations = {both};
  const auto with = [&](double gravity_m_s2, double sd_m_s2) {
    results.gravity_m_s2 = gravity_m_s2;
    results.gravity_sd_m_s2 = sd_m_s2;
    return fit::with_trajectory_fits(results).configurations[0];
  };
  const auto stated = with(kGravity, 0.0), assumed = with(kGravity, 0.015);
  const auto above = with(kGravity + 1e-3, 0.0), below = with(kGravity - 1e-3, 0.0);
  for (const auto of : {&core::ConfigurationResult::alpha_deg, &core::ConfigurationResult::mu}) {
    const double by_gravity = ((above.*of).estimate->value - (below.*of).estimate->value) / 2e-3;
    const double sd = std::hypot((stated.*of).estimate->sd, 0.015 * by_gravity);
    CHECK((assumed.*of).estimate->sd == Approx(sd).epsilon(1e-6));  // central differences: (1e-3/g)^2 = 1e-8
  }
  CHECK(assumed.k_over_m_1_s.estimate->sd == stated.k_over_m_1_s.estimate->sd);
  CHECK(tests::note_of<core::GravityAssumed>(assumed.notes) != nullptr);
  CHECK(tests::note_of<core::GravityAssumed>(stated.notes) == nullptr);
}
