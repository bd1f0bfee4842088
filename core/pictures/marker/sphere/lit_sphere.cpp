#include "core/pictures/marker/sphere/lit_sphere.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math/dense.h"
#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {
namespace {

enum { kCentreU, kCentreV, kLogSize, kLampX, kLampY, kLampZ, kAmbient };
constexpr int kSphereParameters = kAmbient + 1;
using Parameters = Eigen::Matrix<double, kSphereParameters, 1>;
using Equations = NormalEquations<kSphereParameters>;

constexpr int kSamples = 4;        // samples of the surface along a side of a pixel at the rim
constexpr double kRim_px = 0.85;   // about the outline, where a pixel may be partly covered; half its diagonal is 0.71
constexpr double kRimBlurs = 4.0;  // and so many standard deviations of the edge
constexpr double kBent_px = 2.0;   // inside the outline, where the surface curves within a pixel
constexpr double kSoft_px = 0.25;  // half the width over which a sample's weight falls at the outline
constexpr double kLampPrior = 0.02;  // codes per unit of light: holds a lamp that no pixel shows
constexpr double kFlatPrior = 1e3;   // the same for a disc, which has no L_z
constexpr int kMostIterations = 25;
constexpr int kToneNodes = 4096;

const std::array<double, kToneNodes + 2> kCodes = [] {
  std::array<double, kToneNodes + 2> codes{};
  for (int i = 0; i < kToneNodes + 2; ++i)
    codes[static_cast<std::size_t>(i)] = code_of_light(ToneCurve::srgb, i / double{kToneNodes});
  return codes;
}();

struct Code {
  double value;
  double slope;  ///< over the light
};

/// The code and its slope. sRGB is interpolated linearly between nodes, to 2e-5.
Code tone_of(ToneCurve tone, double light) {
  if (light >= 1.0) return {1.0, 0.0};
  if (light <= 0.0) return {0.0, 0.0};
  if (tone == ToneCurve::linear) return {light, 1.0};
  const double at = light * kToneNodes;
  const auto node = static_cast<std::size_t>(at);
  const double rise = kCodes[node + 1] - kCodes[node];
  return {kCodes[node] + (at - static_cast<double>(node)) * rise, rise * kToneNodes};
}

struct Surface4 {
  double light;
  double x, y, z;  ///< its derivatives with respect to the lamp
};

/// A disc that is lit unevenly: its light is a plane.
Surface4 flat_at(double x, double y, const Parameters& p) {
  return {p[kAmbient] + p[kLampX] * x + p[kLampY] * y, x, y, 0.0};
}

Surface4 surface_at(double x, double y, const Parameters& p) {
  const double square = x * x + y * y;
  double z = 0.0;
  if (square < 1.0) {
    z = std::sqrt(1.0 - square);
  } else {
    const double scale = 1.0 / std::sqrt(square);
    x *= scale;
    y *= scale;
  }
  const double lit = p[kLampX] * x + p[kLampY] * y + p[kLampZ] * z;
  if (lit <= 0.0) return {p[kAmbient], 0.0, 0.0, 0.0};
  return {p[kAmbient] + lit, x, y, z};
}

/// The covered part of a pixel, and the mean surface that covers it.
struct Seen {
  double covered;
  Surface4 surface;
};

class Sphere {
 public:
  Sphere(const SphereGuess& guess, const Parameters& p) : p_(p), blur_(guess.blur_px), flat_(guess.flat) {
    const double scale = std::exp(-p[kLogSize]);
    m_ = guess.shape * scale;
    radius_ = 1.0 / std::sqrt(m_[0] * m_[2] - m_[1] * m_[1]);
    rim_ = kRim_px + kRimBlurs * blur_;
  }

  Seen seen_by(const SpherePixel& pixel) const {
    const double du = pixel.u - p_[kCentreU], dv = pixel.v - p_[kCentreV];
    const double x = m_[0] * du + m_[1] * dv, y = m_[1] * du + m_[2] * dv;
    const double rho = std::hypot(x, y);
    const double off_px = (1.0 - rho) * radius_;  // roughly
    if (off_px < -rim_) return {0.0, {}};
    if (off_px > std::max(rim_, kBent_px)) return {1.0, surface(x, y)};
    if (off_px > rim_) return {1.0, mean_surface(x, y, 2)};
    const double nu = m_[0] * x + m_[1] * y, nv = m_[1] * x + m_[2] * y;  // M^2 d
    const double steep = std::hypot(nu, nv);
    if (!(steep > 0.0)) return {1.0, surface(x, y)};
    const double inside_px = rho * (1.0 - rho) / steep;
    const double covered = pixel_edge(inside_px, nu / steep, nv / steep, blur_).value;
    return {covered, mean_surface(x, y, kSamples)};
  }

 private:
  Surface4 surface(double x, double y) const { return flat_ ? flat_at(x, y, p_) : surface_at(x, y, p_); }

  Surface4 mean_surface(double x, double y, int samples) const {
    Surface4 sum{0.0, 0.0, 0.0, 0.0};
    double weights = 0.0;
    const double step = 1.0 / samples;
    for (int i = 0; i < samples; ++i) {
      const double ou = (i + 0.5) * step - 0.5;
      for (int j = 0; j < samples; ++j) {
        const double ov = (j + 0.5) * step - 0.5;
        const double sx = x + m_[0] * ou + m_[1] * ov, sy = y + m_[1] * ou + m_[2] * ov;
        const double inside_px = (1.0 - std::sqrt(sx * sx + sy * sy)) * radius_;
        const double weight = std::clamp(0.5 + 0.5 * inside_px / kSoft_px, 1e-3, 1.0);
        const Surface4 here = surface(sx, sy);
        weights += weight;
        sum.light += weight * here.light;
        sum.x += weight * here.x;
        sum.y += weight * here.y;
        sum.z += weight * here.z;
      }
    }
    const double per = 1.0 / weights;
    return {sum.light * per, sum.x * per, sum.y * per, sum.z * per};
  }

  const Parameters& p_;
  double blur_;
  bool flat_;
  cv::Vec3d m_;
  double radius_ = 0.0, rim_ = 0.0;
};

double light_in(const SpherePixel& pixel, const Seen& seen) {
  return pixel.behind + seen.covered * (seen.surface.light - pixel.behind);
}

constexpr double kStep_px = 2e-3, kSizeStep = 3e-4;

/// The normal equations of the pixels and the priors. Empty if the size is off by more than a factor of 2.
std::optional<Equations> equations_at(const std::vector<SpherePixel>& pixels, const SphereGuess& guess,
                                      const Parameters& p, double log_size_sd) {
  if (!p.allFinite() || std::abs(p[kLogSize] - guess.log_size) > 0.7) return std::nullopt;
  Equations equations;
  const Sphere sphere(guess, p);
  const std::array<double, 3> steps{kStep_px, kStep_px, kSizeStep};
  std::array<Parameters, 6> moved;
  for (std::size_t k = 0; k < 3; ++k) {
    moved[2 * k] = moved[2 * k + 1] = p;
    moved[2 * k][static_cast<Eigen::Index>(k)] += steps[k];
    moved[2 * k + 1][static_cast<Eigen::Index>(k)] -= steps[k];
  }
  const std::array<Sphere, 6> shifted{Sphere(guess, moved[0]), Sphere(guess, moved[1]), Sphere(guess, moved[2]),
                                      Sphere(guess, moved[3]), Sphere(guess, moved[4]), Sphere(guess, moved[5])};
  for (const SpherePixel& pixel : pixels) {
    if (pixel.weight <= 0.0) continue;
    const Seen seen = sphere.seen_by(pixel);
    const Code code = tone_of(guess.tone, light_in(pixel, seen));
    Parameters jacobian = Parameters::Zero();
    if (seen.covered > 0.0) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double up = light_in(pixel, shifted[2 * k].seen_by(pixel));
        const double down = light_in(pixel, shifted[2 * k + 1].seen_by(pixel));
        jacobian[static_cast<Eigen::Index>(k)] = code.slope * (up - down) / (2.0 * steps[k]);
      }
      const double share = code.slope * seen.covered;
      jacobian[kLampX] = share * seen.surface.x;
      jacobian[kLampY] = share * seen.surface.y;
      jacobian[kLampZ] = share * seen.surface.z;
      jacobian[kAmbient] = share;
    }
    equations.add(jacobian, code.value - pixel.code, pixel.weight);
  }
  const auto hold = [&](int parameter, double off, double strength) {
    Parameters jacobian = Parameters::Zero();
    jacobian[parameter] = strength;
    equations.add(jacobian, strength * off, 1.0);
  };
  hold(kLogSize, p[kLogSize] - guess.log_size, guess.noise / log_size_sd);
  for (const int k : {kLampX, kLampY}) hold(k, p[k], kLampPrior);
  hold(kLampZ, p[kLampZ], guess.flat ? kFlatPrior : kLampPrior);
  return equations;
}

/// The light by linear least squares over the pixels inside, for a lamp without the edge of a shadow.
SphereLight light_inside(const std::vector<SpherePixel>& pixels, const SphereGuess& guess) {
  constexpr double kInside = 0.85;
  Eigen::Matrix4d a = Eigen::Matrix4d::Identity() * 0.05;
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  std::vector<double> lights;
  const cv::Vec3d m = guess.shape * std::exp(-guess.log_size);
  for (const SpherePixel& pixel : pixels) {
    const double du = pixel.u - guess.centre.x, dv = pixel.v - guess.centre.y;
    const double x = m[0] * du + m[1] * dv, y = m[1] * du + m[2] * dv, square = x * x + y * y;
    if (square > kInside * kInside) continue;
    const double light = light_of_code(guess.tone, pixel.code);
    const Eigen::Vector4d n(x, y, std::sqrt(1.0 - square), 1.0);
    a += n * n.transpose();
    b += light * n;
    lights.push_back(light);
  }
  if (guess.flat) return {{0.0, 0.0, 0.0}, quantile(std::move(lights), 0.5)};
  const Eigen::Vector4d found = base::solve_positive(a, b);
  constexpr double kDarkest = 0.05;  // quantile of the pixels, taken as the ambient light
  return {{found[0], found[1], found[2]}, quantile(std::move(lights), kDarkest)};
}

}  // namespace

std::optional<SphereFit> fit_lit_sphere(const std::vector<SpherePixel>& pixels, const SphereGuess& guess) {
  if (pixels.size() < 3 * kSphereParameters) return std::nullopt;
  SphereLight light = guess.light ? *guess.light : light_inside(pixels, guess);
  if (guess.flat) light.lamp = {0.0, 0.0, 0.0};
  Parameters start;
  start << guess.centre.x, guess.centre.y, guess.log_size, light.lamp[0], light.lamp[1], light.lamp[2], light.ambient;
  Parameters step;
  step << 5e-4, 5e-4, 5e-4, 2e-3, 2e-3, 2e-3, 2e-3;
  const auto found = fit_least_squares<kSphereParameters>(
      [&](const Parameters& p) { return equations_at(pixels, guess, p, guess.log_size_sd); }, start, step,
      kMostIterations, [](const auto&, const auto&) { return false; });
  // A kink (the edge of the shadow between pixels) may keep the last thousandth of a pixel from settling.
  if (!base::is_settled(found.stop) && found.stop != base::FitStop::no_descent &&
      found.stop != base::FitStop::iterations) {
    return std::nullopt;
  }
  const Parameters& p = found.parameters;
  const double radius =
      std::exp(p[kLogSize]) / std::sqrt(guess.shape[0] * guess.shape[2] - guess.shape[1] * guess.shape[1]);
  if (std::hypot(p[kCentreU] - guess.centre.x, p[kCentreV] - guess.centre.y) > radius) return std::nullopt;
  std::optional<Equations> equations = equations_at(pixels, guess, p, guess.log_size_sd);
  if (!equations) return std::nullopt;
  equations->complete();
  SphereFit fit;
  fit.centre = {p[kCentreU], p[kCentreV]};
  fit.log_size = p[kLogSize];
  fit.light = {{p[kLampX], p[kLampY], p[kLampZ]}, p[kAmbient]};
  const Sphere sphere(guess, p);
  double added = 0.0, covered = 0.0;
  for (const SpherePixel& pixel : pixels) {
    fit.weight += pixel.weight;
    const Seen seen = sphere.seen_by(pixel);
    const double change = tone_of(guess.tone, light_in(pixel, seen)).value - tone_of(guess.tone, pixel.behind).value;
    added += change * change;
    covered += seen.covered;
  }
  fit.contrast = std::sqrt(added / std::max(covered, 1.0));
  const double freedom = fit.weight - kSphereParameters;
  if (!(freedom > 0.0)) return std::nullopt;
  fit.rms = std::sqrt(equations->cost / freedom);
  const Equations::Matrix inverse = base::inverse_positive(equations->jtj);
  const double variance = fit.rms * fit.rms;
  fit.sd_px = std::sqrt(0.5 * variance * (inverse(kCentreU, kCentreU) + inverse(kCentreV, kCentreV)));
  const double held = guess.noise / guess.log_size_sd;
  const double information = 1.0 / inverse(kLogSize, kLogSize) - held * held;
  fit.log_size_sd = information > 0.0 ? fit.rms / std::sqrt(information) : 1.0;
  return fit;
}

double lit_sphere_code(const SpherePixel& pixel, const SphereGuess& guess, const SphereFit& fit) {
  Parameters p;
  p << fit.centre.x, fit.centre.y, fit.log_size, fit.light.lamp[0], fit.light.lamp[1], fit.light.lamp[2],
      fit.light.ambient;
  return tone_of(guess.tone, light_in(pixel, Sphere(guess, p).seen_by(pixel))).value;
}

}  // namespace glidelab::core
