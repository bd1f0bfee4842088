#include "core/pictures/marker/sphere/sphere_window.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

constexpr int kDirections = 24;
constexpr double kWindowRadii = 1.25, kWindowMargin_px = 2.5;  // those of the disc's fit (marker_fit.h)
constexpr double kOutside_px = 1.3;                            // outside the outline: from here on only background
constexpr double kStrangeSds = 4.0;            // standard deviations of the mean of a direction's pixels
constexpr double kStrangeCodes = 2.0 / 255.0;  // change of a background from frame to frame that is allowed
constexpr double kStrangeFrom = 0.6;           // of the radius: pixels of a strange direction farther out do not count

std::size_t direction_of(double du, double dv) {
  const double turn = (std::atan2(dv, du) / std::numbers::pi + 1.0) * 0.5 * kDirections;
  return static_cast<std::size_t>(std::clamp(static_cast<int>(turn), 0, kDirections - 1));
}

struct Around {
  double du, dv;
  double light;
};

/// The light of the surrounding pixels as a plane. Pixels far off it are left out.
std::optional<Eigen::Vector3d> plane_through(const std::vector<Around>& around, double noise) {
  constexpr int kRounds = 6;
  constexpr std::size_t kFewest = 12;
  std::vector<double> lights;
  for (const Around& pixel : around) lights.push_back(pixel.light);
  if (lights.size() < kFewest) return std::nullopt;
  std::nth_element(lights.begin(), lights.begin() + static_cast<std::ptrdiff_t>(lights.size() / 2), lights.end());
  Eigen::Vector3d plane(lights[lights.size() / 2], 0.0, 0.0);
  double limit = 0.05;  // of full scale, then narrower in each round
  for (int round = 0; round < kRounds; ++round, limit = std::max(0.5 * limit, 4.0 * noise)) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    std::size_t taken = 0;
    for (const Around& pixel : around) {
      const Eigen::Vector3d at(1.0, pixel.du, pixel.dv);
      if (std::abs(pixel.light - plane.dot(at)) > limit) continue;
      a += at * at.transpose();
      b += pixel.light * at;
      ++taken;
    }
    if (taken < kFewest) return std::nullopt;
    plane = base::solve_positive(a, b);
    if (!plane.allFinite()) return std::nullopt;
  }
  return plane;
}

}  // namespace

double radius_of(const cv::Vec3d& shape) {
  return 1.0 / std::sqrt(shape[0] * shape[2] - shape[1] * shape[1]);
}

SphereWindow cut_sphere_window(const cv::Mat& codes, const cv::Rect& window, const KnownBackground& background,
                               const SphereGuess& guess, Behind behind) {
  const cv::Point2d centre = guess.centre;
  const double radius = radius_of(guess.shape) * std::exp(guess.log_size);
  const double reach = kWindowRadii * radius + kWindowMargin_px;
  const cv::Point first(static_cast<int>(std::ceil(centre.x - reach)), static_cast<int>(std::ceil(centre.y - reach)));
  const cv::Point last(static_cast<int>(std::floor(centre.x + reach)), static_cast<int>(std::floor(centre.y + reach)));
  if (!window.contains(first) || !window.contains(last)) return {};
  SphereWindow cut;
  std::vector<Around> around;
  for (int v = first.y; v <= last.y; ++v) {
    for (int u = first.x; u <= last.x; ++u) {
      const double du = u - centre.x, dv = v - centre.y, distance = std::hypot(du, dv);
      if (distance >= reach) continue;
      const double code = codes.at<float>(v - window.y, u - window.x) / background.full_code;
      double known = 0.0;
      if (behind == Behind::still) {
        const cv::Point at(u - background.region.x, v - background.region.y);
        if (background.part.known.at<unsigned char>(at) == 0) continue;
        known = background.part.codes.at<float>(at) / background.full_code;
      } else if (distance > radius + kOutside_px) {
        around.push_back({du, dv, light_of_code(guess.tone, code)});
      }
      cut.pixels.push_back({static_cast<double>(u), static_cast<double>(v), code, known, 1.0});
    }
  }
  if (behind == Behind::moving) {
    const std::optional<Eigen::Vector3d> plane = plane_through(around, background.noise());
    if (!plane) return {};
    for (SpherePixel& pixel : cut.pixels) {
      const Eigen::Vector3d at(1.0, pixel.u - centre.x, pixel.v - centre.y);
      pixel.behind = std::clamp(plane->dot(at), 0.0, 1.0);
    }
  } else {
    for (SpherePixel& pixel : cut.pixels) pixel.behind = light_of_code(guess.tone, pixel.behind);
  }

  struct Direction {
    double off = 0.0;
    int count = 0;
  };
  std::array<Direction, kDirections> directions{};
  for (const SpherePixel& pixel : cut.pixels) {
    const double du = pixel.u - centre.x, dv = pixel.v - centre.y;
    if (std::hypot(du, dv) <= radius + kOutside_px) continue;
    Direction& direction = directions[direction_of(du, dv)];
    direction.off += pixel.code - code_of_light(guess.tone, pixel.behind);
    ++direction.count;
  }
  std::array<bool, kDirections> strange{};
  for (std::size_t k = 0; k < kDirections; ++k) {
    const Direction& direction = directions[k];
    if (direction.count == 0) continue;
    const double limit = kStrangeSds * background.noise() / std::sqrt(direction.count) + kStrangeCodes;
    if (std::abs(direction.off / direction.count) < limit) continue;
    strange[k] = strange[(k + 1) % kDirections] = strange[(k + kDirections - 1) % kDirections] = true;
  }
  cut.usable = static_cast<double>(std::count(strange.begin(), strange.end(), false)) / kDirections;
  std::erase_if(cut.pixels, [&](const SpherePixel& pixel) {
    const double du = pixel.u - centre.x, dv = pixel.v - centre.y;
    return strange[direction_of(du, dv)] && std::hypot(du, dv) > kStrangeFrom * radius;
  });
  return cut;
}

}  // namespace glidelab::core
