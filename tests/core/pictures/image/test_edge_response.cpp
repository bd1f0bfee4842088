#include "core/pictures/image/edge_response.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;
using core::EdgeResponse;

namespace {

/// An edge across a window of 9 x 9 pixels, with the normal distribution's profile; its contrast and level are fitted.
struct Edge {
  double offset, angle, blur = 0.5;

  double bright(cv::Point pixel, double narrower_px2) const {
    const double s = std::cos(angle) * (pixel.x - 4.0) + std::sin(angle) * (pixel.y - 4.0) - offset;
    return 0.5 * std::erfc(-s / std::sqrt(2.0 * (blur * blur - narrower_px2)));
  }
};

core::FittedWindow window_of(const Edge& edge, const EdgeResponse& truth, double noise_sd, std::mt19937& engine) {
  constexpr double kLevel = 40.0, kContrast = 120.0;
  core::FittedWindow window;
  window.contrast = kContrast;
  window.at = [edge](cv::Point pixel, double narrower_px2) {
    const double bright = edge.bright(pixel, narrower_px2);
    return core::ModelPixel{kLevel + kContrast * bright, bright};
  };
  for (int v = 0; v < 9; ++v) {
    for (int u = 0; u < 9; ++u) window.pixels.emplace_back(u, v);
  }
  const auto count = static_cast<Eigen::Index>(window.pixels.size());
  window.weight.setOnes(count);
  window.model.resize(count);
  window.jacobian.resize(count, 2);
  window.light.resize(count);
  std::normal_distribution<double> noise(0.0, noise_sd);
  for (Eigen::Index i = 0; i < count; ++i) {
    const cv::Point here = window.pixels[static_cast<std::size_t>(i)];
    const auto at = [&](int u, int v) { return window.at(here + cv::Point(u, v), 0.0).light; };
    const double light = at(0, 0), bright = edge.bright(here, 0.0);
    window.model[i] = light;
    window.jacobian.row(i) << 1.0, bright;
    const double* const mask = truth.terms.data() + std::ptrdiff_t{3} * (2 * (here.y % 2) + here.x % 2);
    window.light[i] = light + mask[0] * (0.5 * (at(-1, 0) + at(1, 0)) - light) +
                      mask[1] * (0.5 * (at(0, -1) + at(0, 1)) - light) +
                      mask[2] * (0.25 * (at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1)) - light) +
                      kContrast * bright * (1.0 - bright) * (truth.curvature() + truth.twist() * (2.0 * bright - 1.0)) +
                      noise(engine);
  }
  return window;
}

std::vector<core::FittedWindow> windows_with(const EdgeResponse& truth, double noise_sd) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<core::FittedWindow> windows;
  for (int k = 0; k < 40; ++k) {
    windows.push_back(window_of({2.0 * part(engine) - 1.0, 6.28 * part(engine)}, truth, noise_sd, engine));
  }
  return windows;
}

std::optional<EdgeResponse> found_in(const std::vector<core::FittedWindow>& windows) {
  return core::edge_response_of(windows.size(), false, [&](std::size_t i, core::ToneCurve, const EdgeResponse*) {
    return std::optional(windows[i]);
  });
}

}  // namespace

TEST_CASE("the masks of a mosaic and a curved tone are found, and taken off to the last code") {
  EdgeResponse truth;
  truth.terms << 0.59, 0.0, 0.11, 0.3, 0.11, 0.0, 0.11, 0.3, 0.0, 0.59, 0.0, 0.3, 0.4, 0.1;
  const std::vector<core::FittedWindow> windows = windows_with(truth, 0.0);
  const auto found = found_in(windows);
  REQUIRE(found);
  // What a term takes from another is held to a ten-thousandth of the best seen one; the light itself is what counts:
  // a hundredth of a code of a contrast of 120.
  double largest = 0.0;
  for (const core::FittedWindow& window : windows) {
    const Eigen::VectorXd rest = window.light - window.model - core::added_by(*found, window);
    // The window's own two parameters may take up a part.
    const Eigen::MatrixXd j = window.jacobian;
    const Eigen::VectorXd own = (j.transpose() * j).ldlt().solve(j.transpose() * rest);
    largest = std::max(largest, (rest - j * own).cwiseAbs().maxCoeff());
  }
  CHECK(largest < 0.05);
  CHECK(std::abs(found->curvature() - 0.4) < 0.04);
  CHECK(std::abs(found->twist() - 0.1) < 0.04);
}

TEST_CASE("pixels that answer as the model says have no response") {
  CHECK_FALSE(found_in(windows_with({}, 1.0)));
}

TEST_CASE("a response in noise far above it is found if the windows show it beyond chance") {
  // Noise of a fifteenth of the contrast: the response takes 5 % of the residuals' squares.
  EdgeResponse truth;
  truth.terms[EdgeResponse::kCurvature] = 0.25;
  const auto found = found_in(windows_with(truth, 8.0));
  REQUIRE(found);
  CHECK(std::abs(found->curvature() - 0.25) < 0.1);
}

TEST_CASE("a response with which the fits leave more and more is none") {
  EdgeResponse truth;
  truth.terms[EdgeResponse::kCurvature] = 0.4;
  const std::vector<core::FittedWindow> windows = windows_with(truth, 1.0);
  const auto fit = [&](std::size_t i, core::ToneCurve, const EdgeResponse* known) {
    core::FittedWindow window = windows[i];
    if (known != nullptr) window.light += 3.0 * (window.light - window.model).reverse();
    return std::optional(window);
  };
  CHECK_FALSE(core::edge_response_of(windows.size(), false, fit));
}

TEST_CASE("the light of codes is the sRGB curve's, at 8 and at 16 bits") {
  const cv::Mat shallow = (cv::Mat_<unsigned char>(1, 3) << 0, 128, 255);
  const cv::Mat deep = (cv::Mat_<unsigned short>(1, 3) << 0, 32896, 65535);
  for (const cv::Mat& codes : {shallow, deep}) {
    const cv::Mat light = core::light_of(codes, core::ToneCurve::srgb);
    CHECK(light.at<unsigned short>(0, 0) == 0);
    // IEC 61966-2-1, of 128 / 255
    CHECK(std::abs(light.at<unsigned short>(0, 1) - 65535.0 * 0.21586) < 1.0);
    CHECK(light.at<unsigned short>(0, 2) == 65535);
    CHECK(core::light_of(codes, core::ToneCurve::linear).data == codes.data);
  }
}
