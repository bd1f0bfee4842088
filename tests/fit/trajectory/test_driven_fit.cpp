/// The fit of the whole motion under a recorded force, on motions that small steps made.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "fit/trajectory/trajectory_results.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kGravity = 9.80665;
constexpr double kMass_kg = 0.4, kDamping_1_s = 1.3, kMu = 0.02, kAlpha_rad = 0.012;
constexpr double kNoise_m = 5e-5, kStep_s = 0.01;
constexpr std::size_t kFrames = 600;

/// A motor's force that drives the glider to and fro, N.
double force_n(double t) {
  return 0.35 * std::cos(2.4 * t) + 0.12 * std::sin(5.1 * t + 0.4);
}

/// As recorded: the samples, and lines between them.
double recorded_n(double t) {
  const double at = t / kStep_s, before = std::floor(at);
  return force_n(before * kStep_s) + (at - before) * (force_n((before + 1.0) * kStep_s) - force_n(before * kStep_s));
}

/// Small steps, friction taking as much of the speed as it can: an error of about 1e-6 m.
core::TrackData made_track(std::mt19937& random) {
  constexpr int kParts = 2000;
  std::normal_distribution<double> normal(0.0, 1.0);
  core::TrackData track;
  track.frame_rate_hz = 1.0 / kStep_s;
  double x = 0.1, v = 0.0;
  const double h = kStep_s / kParts, grip = kMu * kGravity * std::cos(kAlpha_rad);
  for (std::size_t k = 0; k < kFrames; ++k) {
    const double t = static_cast<double>(k) * kStep_s;
    track.frame.push_back(k);
    track.t_s.push_back(t);
    track.x_m.push_back(x + kNoise_m * normal(random));
    track.force_n.push_back(force_n(t));
    for (int part = 0; part < kParts; ++part) {
      const double pull = kGravity * std::sin(kAlpha_rad) + recorded_n(t + (part + 0.5) * h) / kMass_kg;
      const double free = v + h * (pull - kDamping_1_s * v);
      const double next = std::copysign(std::max(0.0, std::abs(free) - h * grip), free);
      x += 0.5 * h * (v + next);
      v = next;
    }
  }
  track.frame_t_s = track.t_s;
  return track;
}

core::AnalysisResults analysed(const core::TrackData& track, double mass_sd_kg = 0.0) {
  core::ClipSetup setup;
  setup.name = "motor";
  setup.track = "none.csv";
  setup.mass_kg = kMass_kg;
  setup.mass_sd_kg = mass_sd_kg;
  setup.incline_rad = kAlpha_rad;
  core::AnalysisResults results;
  results.gravity_m_s2 = kGravity;
  results.clips = {core::analyze_motion(setup, track, {})};
  results.configurations = core::configurations_of_clips({setup}, results.clips, kGravity);
  return results;
}

double z_of(const core::Quantity& quantity, double truth) {
  REQUIRE(quantity.estimate);
  return (quantity.estimate->value - truth) / quantity.estimate->sd;
}

}  // namespace

TEST_CASE("the fit of the whole motion takes the recorded force, and its intervals hold the truth") {
  constexpr int kReplicates = 12;
  double squares = 0.0;
  for (int i = 0; i < kReplicates; ++i) {
    std::mt19937 random(100 + static_cast<unsigned>(i));
    const core::TrackData track = made_track(random);
    const core::ConfigurationResult found = fit::with_trajectory_fits(analysed(track)).configurations.at(0);
    const double k = z_of(found.k_over_m_1_s, kDamping_1_s), mu = z_of(found.mu, kMu);
    const double alpha = z_of(found.alpha_deg, kAlpha_rad * 57.29577951308232);
    INFO(k << " " << mu << " " << alpha << ", K/m ± " << found.k_over_m_1_s.estimate->sd);
    CHECK(std::max({std::abs(k), std::abs(mu), std::abs(alpha)}) < 4.5);
    CHECK(found.k_over_m_1_s.estimate->sd < 0.002 * kDamping_1_s);  // or it would say nothing
    squares += (k * k + mu * mu + alpha * alpha) / (3.0 * kReplicates);
  }
  // 36 squares of standard normal numbers, hardly correlated: 1 ± 0.24; three of these.
  CHECK(squares < 1.7);
}

TEST_CASE("without the recorded force the same motion gives another K/m, or none") {
  std::mt19937 random(100);
  core::AnalysisResults results = analysed(made_track(random));
  for (core::FreeBlock& block : results.clips[0].blocks) block.force = {};
  const core::Quantity found = fit::with_trajectory_fits(results).configurations.at(0).k_over_m_1_s;
  const bool holds = found.estimate && found.estimate->low95 <= kDamping_1_s && kDamping_1_s <= found.estimate->high95;
  const bool is_close = found.estimate && std::abs(found.estimate->value - kDamping_1_s) < 0.05 * kDamping_1_s;
  CHECK_FALSE((holds && is_close));
}

TEST_CASE("an uncertain mass makes K/m uncertain by its own share where a force drives the glider") {
  std::mt19937 random(100);
  const core::TrackData track = made_track(random);
  const core::ConfigurationResult exact = fit::with_trajectory_fits(analysed(track)).configurations.at(0);
  const double part = 0.02;
  const core::ConfigurationResult weighed =
      fit::with_trajectory_fits(analysed(track, part * kMass_kg)).configurations.at(0);
  // What K/m comes out as under a force that is a little larger and smaller over the mass: the shift, to first order.
  constexpr double kLittle = 1e-3;
  const auto moved = [&](double factor) {
    core::AnalysisResults other = analysed(track);
    for (core::FreeBlock& block : other.clips[0].blocks) {
      for (double& a : block.force.a_m_s2) a *= factor;
    }
    return fit::with_trajectory_fits(other).configurations.at(0).k_over_m_1_s.estimate->value;
  };
  const double shift = part * (moved(1.0 + kLittle) - moved(1.0 - kLittle)) / (2.0 * kLittle);
  CHECK(weighed.k_over_m_1_s.estimate->value == Approx(exact.k_over_m_1_s.estimate->value).epsilon(1e-9));
  // The motion turns, so that a finite change is not quite linear.
  const double by_mass =
      std::sqrt(std::pow(weighed.k_over_m_1_s.estimate->sd, 2) - std::pow(exact.k_over_m_1_s.estimate->sd, 2));
  CHECK(by_mass == Approx(std::abs(shift)).epsilon(0.03));
  CHECK(by_mass > 3.0 * exact.k_over_m_1_s.estimate->sd);  // or it would show nothing
}

TEST_CASE("a glider that a force drives to and fro is fitted in pieces of two turns at most") {
  std::mt19937 random(100);
  const std::vector<core::FreeBlock> blocks = analysed(made_track(random)).clips.at(0).blocks;
  REQUIRE(blocks.size() > 1);
  std::size_t turns = 0;
  for (const core::FreeBlock& block : blocks) {
    CHECK(block.directions.size() <= 3);
    CHECK(block.force.t_s.front() == block.t_s.front());
    CHECK(block.force.t_s.back() == block.t_s.back());
    turns += block.directions.size() - 1;
  }
  CHECK(turns > 3);
}
