#include "validate/truth/cramer_rao.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/experiment/clip_setup.h"
#include "core/result/quantity.h"
#include "sim/sensitivity/sensitivity.h"

namespace glidelab::validate {
namespace {

// Reciprocal condition number of the scaled information below which only rounding distinguishes the parameters.
constexpr double kDetermined = 1e-11;

/// Information on k, d, f; or on k and a0 = d - direction f if the motion is in one direction only.
struct Information {
  Eigen::MatrixXd of_three = Eigen::MatrixXd::Zero(3, 3);
  bool up = false, down = false;
};

void add_clip(const TrueClip& clip, const sim::TrackLaw& law, double noise_sd_m, Information& information) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < clip.t_s.size(); ++i) {
    const bool again = i > 0 && !(clip.t_s[i] > clip.t_s[i - 1]);
    if (!again) times_s.push_back(clip.t_s[i] - clip.t_s.front());
  }
  const auto states = sim::simulate_sensitive(law, clip.x_m.front(), clip.v_m_s.front(), times_s);
  const auto moving = static_cast<Eigen::Index>(
      std::count_if(states.begin(), states.end(), [](const auto& state) { return state.mode != sim::Mode::stick; }));
  if (moving < 3) return;
  Eigen::MatrixXd common(moving, 3), start(moving, 2);
  Eigen::Index row = 0;
  for (const sim::SensitiveState& state : states) {
    if (state.mode == sim::Mode::stick) continue;
    (state.mode == sim::Mode::slide_down ? information.down : information.up) = true;
    common.row(row) = state.by_parameter.row(0).head(3);
    start.row(row) = state.by_parameter.row(0).tail(2);
    ++row;
  }
  const Eigen::MatrixXd own = common - base::product(start, base::least_squares(start, common));
  information.of_three += base::transposed_product(own, own) / (noise_sd_m * noise_sd_m);
}

/// Empty if it does not determine all its parameters.
std::optional<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& information) {
  if (!(information.diagonal().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  if (!(base::symmetric_eigen(scaled).values[0] > kDetermined)) return std::nullopt;
  return scale.asDiagonal() * base::inverse_positive(scaled) * scale.asDiagonal();
}

double sd_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& gradient) {
  return std::sqrt(base::transposed_product(gradient, base::product(covariance, gradient))(0, 0));
}

/// v_lim = a0 / k.
std::optional<double> sd_of_limit(const Eigen::MatrixXd& covariance, double k, double a0,
                                  const Eigen::VectorXd& by_a0) {
  if (!(k > 0.0) || !(a0 > 0.0)) return std::nullopt;
  Eigen::VectorXd gradient = by_a0 / k;
  gradient[0] = -a0 / (k * k);
  return sd_of(covariance, gradient);
}

LeastSd least_sd(const TrueConfiguration& configuration, const std::vector<const TrueClip*>& clips,
                 const std::vector<double>& noise_sd_m, double gravity_m_s2) {
  LeastSd least;
  least.configuration = configuration.name;
  if (!configuration.k_over_m_1_s || !configuration.mu || !configuration.alpha_deg) return least;
  const double k = *configuration.k_over_m_1_s;
  const double alpha = *configuration.alpha_deg / base::kDegreesPerRad;
  const double drive = gravity_m_s2 * std::sin(alpha);
  const double friction = *configuration.mu * gravity_m_s2 * std::cos(alpha);
  const sim::TrackLaw law(k, drive, friction);
  Information information;
  for (std::size_t c = 0; c < clips.size(); ++c) add_clip(*clips[c], law, noise_sd_m[c], information);
  if (!information.up && !information.down) return least;
  if (information.up != information.down) {
    // One direction only: d and f act only through a0 = d - direction f, whose derivative is that by d.
    const auto covariance = covariance_of(information.of_three.topLeftCorner(2, 2));
    if (!covariance) return least;
    least.k_over_m_1_s = std::sqrt((*covariance)(0, 0));
    if (information.down) least.v_lim_m_s = sd_of_limit(*covariance, k, drive - friction, Eigen::Vector2d(0.0, 1.0));
    return least;
  }
  const auto covariance = covariance_of(information.of_three);
  if (!covariance) return least;
  least.k_over_m_1_s = std::sqrt((*covariance)(0, 0));
  least.v_lim_m_s = sd_of_limit(*covariance, k, drive - friction, Eigen::Vector3d(0.0, 1.0, -1.0));
  if (core::is_fall(alpha)) return least;
  const double level = gravity_m_s2 * std::cos(alpha);
  least.alpha_deg = std::sqrt((*covariance)(1, 1)) / level * base::kDegreesPerRad;
  least.mu = sd_of(*covariance, Eigen::Vector3d(0.0, *configuration.mu * std::tan(alpha) / level, 1.0 / level));
  return least;
}

}  // namespace

std::vector<LeastSd> least_sds(const Truth& truth, const std::vector<double>& noise_sd_m, double gravity_m_s2) {
  if (noise_sd_m.size() != truth.clips.size()) throw std::invalid_argument("least_sds: one noise for each clip");
  std::vector<LeastSd> all;
  for (const TrueConfiguration& configuration : truth.configurations) {
    std::vector<const TrueClip*> clips;
    std::vector<double> noise;
    for (std::size_t c = 0; c < truth.clips.size(); ++c) {
      if (truth.clips[c].configuration != configuration.name || truth.clips[c].t_s.empty()) continue;
      if (!(noise_sd_m[c] > 0.0)) throw std::invalid_argument("least_sds: a noise above 0");
      clips.push_back(&truth.clips[c]);
      noise.push_back(noise_sd_m[c]);
    }
    all.push_back(least_sd(configuration, clips, noise, gravity_m_s2));
  }
  return all;
}

std::optional<double> least_sd_of(const LeastSd& least, std::string_view quantity) {
  const std::size_t place = core::place_of(quantity);
  if (place == core::kQuantities.size()) throw std::logic_error("no quantity: " + std::string(quantity));
  return core::value_of(least, core::kQuantities[place].which);
}

}  // namespace glidelab::validate
