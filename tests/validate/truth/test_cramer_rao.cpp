#include "validate/truth/cramer_rao.h"

#include <Eigen/LU>

#include <cmath>
#include <numbers>

#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

constexpr double kGravity = 9.80665;
constexpr double kRad = std::numbers::pi / 180.0;

struct Law {
  double k = 2.0, mu = 0.006, alpha_rad = 1.5 * kRad;
};

TrueConfiguration configuration_of(const Law& law, std::vector<std::string> clips) {
  TrueConfiguration configuration;
  configuration.name = "m1";
  configuration.k_over_m_1_s = law.k;
  configuration.mu = law.mu;
  configuration.alpha_deg = law.alpha_rad / kRad;
  configuration.clips = std::move(clips);
  return configuration;
}

double x_of(double k, double drive, double friction, double x0, double v0, double t) {
  return sim::viscous_coulomb_motion({drive, friction, friction}, k, x0, v0, t).x_m;
}

TrueClip clip_of(const std::string& name, const Law& law, double x0, double v0, double seconds) {
  TrueClip clip;
  clip.name = name;
  clip.configuration = "m1";
  const sim::DryTrack track = sim::dry_track(law.alpha_rad, law.mu, law.mu, kGravity);
  for (int i = 0; i * 0.01 < seconds; ++i) {
    const sim::State state = sim::viscous_coulomb_motion(track, law.k, x0, v0, i * 0.01);
    clip.t_s.push_back(i * 0.01);
    clip.x_m.push_back(state.x_m);
    clip.v_m_s.push_back(state.v_m_s);
    clip.a_m_s2.push_back(state.a_m_s2);
  }
  return clip;
}

/// Fisher's information of all parameters together (k, alpha, mu, and x0, v0 of each clip) by central differences of
/// the closed form; nothing is projected out.
Eigen::MatrixXd whole_covariance(const Law& law, const std::vector<TrueClip>& clips, double noise) {
  const auto size = static_cast<Eigen::Index>(3 + 2 * clips.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    for (const double t : clips[c].t_s) {
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
      for (Eigen::Index p = 0; p < 5; ++p) {
        const double step = p == 2 ? 1e-7 : 1e-6;
        double x[2];
        for (const int side : {0, 1}) {
          double at[5] = {law.k, law.alpha_rad, law.mu, clips[c].x_m.front(), clips[c].v_m_s.front()};
          at[p] += side == 0 ? -step : step;
          x[side] = x_of(at[0], kGravity * std::sin(at[1]), at[2] * kGravity * std::cos(at[1]), at[3], at[4], t);
        }
        gradient[p < 3 ? p : p + static_cast<Eigen::Index>(2 * c)] = (x[1] - x[0]) / (2.0 * step);
      }
      information += gradient * gradient.transpose() / (noise * noise);
    }
  }
  return information.fullPivLu().inverse();
}

Truth truth_of(const Law& law, std::vector<TrueClip> clips) {
  Truth truth;
  std::vector<std::string> names;
  for (const TrueClip& clip : clips) names.push_back(clip.name);
  truth.configurations = {configuration_of(law, names)};
  truth.clips = std::move(clips);
  return truth;
}

// Central differences with a step of 1e-6 of a motion of the size 1: 1e-10 of rounding beside derivatives above 1e-2,
// amplified by the condition of the information (its root is below 1e3).
constexpr double kTolerance = 1e-4;

}  // namespace

TEST_CASE("the bound of a clip that turns and one that does not is the inverse of the whole information") {
  const Law law;
  const std::vector<TrueClip> clips = {clip_of("up", law, 0.5, -1.0, 2.0), clip_of("down", law, -0.5, 0.8, 1.6)};
  const double noise = 5e-5;
  const Eigen::MatrixXd covariance = whole_covariance(law, clips, noise);
  const auto least = least_sds(truth_of(law, clips), {noise, noise}, kGravity);
  REQUIRE(least.size() == 1);
  REQUIRE((least[0].k_over_m_1_s && least[0].mu && least[0].alpha_deg && least[0].v_lim_m_s));
  CHECK(std::abs(*least[0].k_over_m_1_s / std::sqrt(covariance(0, 0)) - 1.0) < kTolerance);
  CHECK(std::abs(*least[0].alpha_deg * kRad / std::sqrt(covariance(1, 1)) - 1.0) < kTolerance);
  CHECK(std::abs(*least[0].mu / std::sqrt(covariance(2, 2)) - 1.0) < kTolerance);
  // v_lim = g (sin alpha - mu cos alpha) / k
  const double sine = std::sin(law.alpha_rad), cosine = std::cos(law.alpha_rad);
  const Eigen::Vector3d gradient(-kGravity * (sine - law.mu * cosine) / (law.k * law.k),
                                 kGravity * (cosine + law.mu * sine) / law.k, -kGravity * cosine / law.k);
  const double sd = std::sqrt(gradient.dot(covariance.topLeftCorner(3, 3) * gradient));
  CHECK(std::abs(*least[0].v_lim_m_s / sd - 1.0) < kTolerance);
}

TEST_CASE("the bound is proportional to the noise, and to one over the root of the number of equal clips") {
  const Law law;
  const TrueClip up = clip_of("up", law, 0.5, -1.0, 2.0);
  const auto one = least_sds(truth_of(law, {up}), {1e-5}, kGravity)[0];
  const auto noisy = least_sds(truth_of(law, {up}), {3e-5}, kGravity)[0];
  const auto four = least_sds(truth_of(law, {up, up, up, up}), {1e-5, 1e-5, 1e-5, 1e-5}, kGravity)[0];
  REQUIRE((one.mu && noisy.mu && four.mu));
  CHECK(std::abs(*noisy.mu / *one.mu - 3.0) < 1e-6);  // the same sums, scaled
  CHECK(std::abs(*four.mu / *one.mu - 0.5) < 1e-6);
}

TEST_CASE("motion in one direction bounds K/m and v_lim, and leaves mu and alpha without") {
  const Law law;
  const auto least = least_sds(truth_of(law, {clip_of("down", law, -0.5, 0.8, 1.6)}), {1e-5}, kGravity)[0];
  CHECK(least.k_over_m_1_s);
  CHECK(least.v_lim_m_s);
  CHECK_FALSE(least.mu);
  CHECK_FALSE(least.alpha_deg);
}

TEST_CASE("a fall that goes up and down again bounds K/m and v_lim, and neither mu nor alpha") {
  for (const double deg : {80.0, 89.0, 90.0}) {
    INFO(deg);
    const Law fall{.k = 2.0, .mu = 0.0, .alpha_rad = deg * kRad};
    const auto least = least_sds(truth_of(fall, {clip_of("thrown", fall, 0.5, -2.0, 0.8)}), {1e-5}, kGravity)[0];
    CHECK(least.k_over_m_1_s);
    CHECK(least.v_lim_m_s);
    CHECK_FALSE(least.mu);
    CHECK_FALSE(least.alpha_deg);
  }
}

TEST_CASE("a law that is not equation (8) has no bound, and a noise of nothing is refused") {
  const Law law;
  Truth truth = truth_of(law, {clip_of("up", law, 0.5, -1.0, 2.0)});
  CHECK_THROWS_AS(least_sds(truth, {0.0}, kGravity), std::invalid_argument);
  CHECK_THROWS_AS(least_sds(truth, {}, kGravity), std::invalid_argument);
  truth.configurations[0].mu.reset();
  CHECK_FALSE(least_sds(truth, {1e-5}, kGravity)[0].k_over_m_1_s);
}

TEST_CASE("a bound is asked for by the quantity's name, and another name is a mistake") {
  const LeastSd least{"m1", 1.0, 2.0, 3.0, std::nullopt};
  CHECK(least_sd_of(least, "k_over_m_1_s") == 1.0);
  CHECK(least_sd_of(least, "mu") == 2.0);
  CHECK(least_sd_of(least, "alpha_deg") == 3.0);
  CHECK_FALSE(least_sd_of(least, "v_lim_m_s"));
  CHECK_THROWS_AS(least_sd_of(least, "v_lim"), std::logic_error);
}
