#include <cmath>
#include <random>

#include "core/result/estimate.h"
#include "fit/trajectory/trajectory_fit.h"
#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

const Eigen::Vector3d kLaw(2.1, 0.735, 0.048);
const Eigen::Vector3d kStart(1.8, 0.7, 0.06);
constexpr double kNoise = 1e-4;

core::FreeBlock block_of(const Eigen::Vector3d& law, double x0_m, double v0_m_s, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, kNoise);
  core::FreeBlock block;
  bool turned = false;
  for (double t = 0.0; t < 1.7; t += 0.005) {
    const sim::State state = sim::viscous_coulomb_motion({law[1], law[2], law[2]}, law[0], x0_m, v0_m_s, t);
    block.t_s.push_back(t);
    block.x_m.push_back(state.x_m + normal(random));
    turned = turned || state.v_m_s * v0_m_s < 0.0;
  }
  const int first = v0_m_s < 0.0 ? -1 : 1;
  block.directions = turned ? std::vector<int>{first, -first} : std::vector<int>{first};
  return block;
}

std::vector<core::FreeBlock> up_and_down(std::mt19937& random) {
  return {block_of(kLaw, 0.2, -1.2, random), block_of(kLaw, -0.5, 1.2, random)};
}

std::vector<fit::FitBlock> with_noise(const std::vector<core::FreeBlock>& blocks) {
  std::vector<fit::FitBlock> fits;
  for (const core::FreeBlock& block : blocks) fits.push_back({&block, {kNoise * kNoise}, 0.0});
  return fits;
}

double deviations(const fit::TrajectoryFit& fit, Eigen::Index i) {
  return std::abs(fit.parameters[i] - kLaw[i]) / std::sqrt(fit.covariance(i, i));
}

}  // namespace

TEST_CASE("planted outliers pull the plain fit, and the robust one leaves them out and finds the law") {
  std::mt19937 random(11);
  auto blocks = up_and_down(random);
  std::size_t planted = 0;
  for (std::size_t i = 20; i < blocks[0].x_m.size(); i += 12, ++planted) {  // one in twelve, all to one side
    blocks[0].x_m[i] += kNoise * (i < 170 ? 25.0 : 60.0);
  }
  for (std::size_t i = 200; i < 220; ++i, ++planted) blocks[1].x_m[i] -= 40.0 * kNoise;  // a tenth of a second wrong
  const auto plain = fit::fit_trajectories(with_noise(blocks), kStart);
  const auto robust = fit::fit_trajectories(with_noise(blocks), kStart, {.robust = true});
  REQUIRE(plain);
  REQUIRE(robust);
  const double sd_k = std::sqrt(robust->covariance(0, 0));
  CHECK(std::abs(plain->parameters[0] - kLaw[0]) > 5.0 * sd_k);
  // Four standard deviations of three parameters: once in five thousand.
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(deviations(*robust, i) < 4.0);
  CHECK(robust->left_out >= planted);
  CHECK(robust->left_out <= planted + 4);  // 6 in 1e5 of 680 by chance
  CHECK(robust->points + robust->left_out == blocks[0].x_m.size() + blocks[1].x_m.size());
}

TEST_CASE("without outliers the robust fit is the plain one, but for a position or two") {
  std::mt19937 random(12);
  const auto blocks = up_and_down(random);
  const auto plain = fit::fit_trajectories(with_noise(blocks), kStart);
  const auto robust = fit::fit_trajectories(with_noise(blocks), kStart, {.robust = true});
  REQUIRE(plain);
  REQUIRE(robust);
  CHECK(robust->left_out <= 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double sd = std::sqrt(plain->covariance(i, i));
    // Three of 680 positions at four deviations move a parameter by less than a third of its standard deviation.
    CHECK(std::abs(robust->parameters[i] - plain->parameters[i]) < 0.35 * sd);
    CHECK(std::abs(std::sqrt(robust->covariance(i, i)) / sd - 1.0) < 0.1);  // the scale of 340 medians: 4 %
  }
}

TEST_CASE("a start far from the law, from which the motion would not even turn, still ends at the law") {
  std::mt19937 random(13);
  const auto blocks = up_and_down(random);
  for (const Eigen::Vector3d& start : {Eigen::Vector3d(0.1, 0.2, 0.3), Eigen::Vector3d(9.0, 0.05, 0.2),
                                       Eigen::Vector3d(2.1, -0.4, 0.0), Eigen::Vector3d(0.0, 3.0, 0.0)}) {
    INFO(start.transpose());
    const auto fit = fit::fit_trajectories(with_noise(blocks), start);
    REQUIRE(fit);
    for (Eigen::Index i = 0; i < 3; ++i) CHECK(deviations(*fit, i) < 4.0);
  }
}

TEST_CASE("passes that differ among themselves by more than the noise widen the intervals to what they differ by") {
  std::mt19937 random(14);
  std::normal_distribution<double> drive(0.0, 0.004);  // 100 times what the noise leaves uncertain
  std::vector<core::FreeBlock> blocks;
  for (int pass = 0; pass < 12; ++pass) {
    Eigen::Vector3d law = kLaw;
    law[1] += drive(random);
    blocks.push_back(block_of(law, 0.2, pass % 2 == 0 ? -1.2 : 1.2, random));
  }
  const auto fit = fit::fit_trajectories(with_noise(blocks), kStart);
  REQUIRE(fit);
  const double sd = std::sqrt(fit->covariance(1, 1));
  // 0.004 over the root of 12 passes is 0.00115; a standard deviation of 12 is known to 21 %, and the fit weighs the
  // parts of a pass differently from a mean.
  CHECK(sd > 0.5 * 0.00115);
  CHECK(sd < 2.5 * 0.00115);
  CHECK(std::isfinite(fit->degrees));
  CHECK(deviations(*fit, 1) < 4.0);
}

TEST_CASE("four clips whose K/m scatters state the standard deviation of their mean, not a multiple of it") {
  constexpr double kScatter = 0.03;
  constexpr int kRepeats = 60, kClips = 4;
  std::mt19937 random(15);
  std::normal_distribution<double> normal;
  double squares = 0.0, variances = 0.0;
  int hold = 0;
  for (int i = 0; i < kRepeats; ++i) {
    std::vector<core::FreeBlock> blocks;
    for (int clip = 0; clip < kClips; ++clip) {
      Eigen::Vector3d law = kLaw;
      law[0] *= 1.0 + kScatter * normal(random);
      blocks.push_back(block_of(law, 0.2, -1.2, random));
    }
    const auto fit = fit::fit_trajectories(with_noise(blocks), kLaw);
    REQUIRE(fit);
    const double off = fit->parameters[0] - kLaw[0], variance = fit->covariance(0, 0);
    squares += off * off / kRepeats;
    variances += variance / kRepeats;
    hold += std::abs(off) <= core::student_t975(fit->degrees) * std::sqrt(variance);
  }
  // Each square root of a mean of 60: the errors' has a standard deviation of 9 %, that of the stated variances, with 3
  // degrees of freedom, 5 %. Three of both together.
  CHECK(std::sqrt(variances / squares) > 0.7);
  CHECK(std::sqrt(variances / squares) < 1.35);
  CHECK(hold >= 51);  // binomial, 60 of 0.95: fewer have a probability of 2e-3
}

TEST_CASE("positions that a robust fit leaves out do not count as positions without scatter") {
  std::mt19937 random(16);
  auto blocks = up_and_down(random);
  std::size_t planted = 0;
  for (core::FreeBlock& block : blocks) {
    for (std::size_t i = 2; i < block.x_m.size(); i += 5, ++planted) {
      block.x_m[i] += kNoise * (i % 2 == 0 ? 40.0 : -40.0);
    }
  }
  const auto robust = fit::fit_trajectories(with_noise(blocks), kStart, {.robust = true});
  REQUIRE(robust);
  CHECK(robust->left_out >= planted);
  CHECK(robust->points + robust->left_out == blocks[0].x_m.size() + blocks[1].x_m.size());
  // The root mean square of 544 residuals: sd 3 %. With a fifth of zeros it would be 0.89.
  CHECK(std::abs(robust->scatter - 1.0) < 0.09);
}
