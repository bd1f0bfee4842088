#include "core/pictures/marker/marker_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/pictures/marker/marker_method.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"

using namespace glidelab;

namespace {

constexpr double kNoise = 2.0;  // grey values
constexpr double kBright = 220.0;
constexpr double kBackground = 80.0;

/// A disc on a sloping background.
cv::Mat image_of(cv::Point2d centre, double radius, double blur_px, cv::Point2d slope = {1.2, -0.7}) {
  cv::Mat image(49, 49, CV_64F);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      image.at<double>(v, u) = kBackground + slope.x * (u - 24) + slope.y * (v - 24);
    }
  }
  tests::put_disc(image, centre, radius, kBright, blur_px);
  return image;
}

core::Signal exact(const cv::Mat& image) {
  return {tests::expose(200.0 * image, 0.0, 1, CV_16U)};  // rounding error: 0.0014 of a grey value
}

/// As in a clip: blur and size are known from earlier frames, and the position to a third of a pixel.
core::MarkerGuess guess_of(cv::Point2d centre, double radius, double blur_px) {
  core::MarkerGuess guess;
  guess.centre = centre + cv::Point2d(0.3, -0.25);
  guess.radius_px = 1.03 * radius;
  guess.blur_px = std::max(blur_px, 0.15);
  return guess;
}

double squared(cv::Point2d off) {
  return off.dot(off);
}

}  // namespace

TEST_CASE("a disc's centre is found to 0.01 px without noise at any sub-pixel place, on a sloping background") {
  for (const double radius : {3.0, 5.0, 8.0, 12.0}) {
    for (const double blur_px : {0.1, 0.4, 0.8}) {
      cv::RNG random(7);
      double sum = 0.0, worst = 0.0;
      constexpr int kPlaces = 12;
      for (int k = 0; k < kPlaces; ++k) {
        const cv::Point2d centre(24.0 + random.uniform(0.0, 1.0), 24.0 + random.uniform(0.0, 1.0));
        const auto fit = core::fit_marker(exact(image_of(centre, radius, blur_px)), guess_of(centre, radius, blur_px),
                                          core::Surface::uniform);
        REQUIRE(fit);
        const double error = cv::norm(fit->centre - centre);
        sum += error * error;
        worst = std::max(worst, error);
        CHECK(std::abs(fit->radius_px - radius) < 0.05);
      }
      INFO("radius " << radius << ", blur " << blur_px << ": rms " << std::sqrt(sum / kPlaces) << ", worst " << worst);
      CHECK(worst < 0.01);
    }
  }
}

TEST_CASE("the centroid of a marker's light lies off its centre by a quarter of the shading's share of the radius") {
  // The light above the background is A (1 + k x / r), whose centroid is at k r / 4.
  constexpr double kRadius = 8.0;
  const cv::Point2d centre(24.3, 24.6);
  for (const double share : {0.0, 0.2}) {
    const cv::Mat image = tests::paint({49, 49}, [&](double u, double v) {
      const double x = (u - centre.x) / kRadius, y = (v - centre.y) / kRadius;
      return kBackground + (std::hypot(x, y) < 1.0 ? 100.0 * (1.0 + share * x) : 0.0);
    });
    const auto fit = core::fit_marker(exact(image), guess_of(centre, kRadius, 0.2), core::Surface::shaded);
    REQUIRE(fit);
    // The centre is good to 0.01 px. The 16 samples per pixel at the rim change the sum by less than that.
    CHECK(std::abs(fit->light_px.x - share * kRadius / 4.0) < 0.02);
    CHECK(std::abs(fit->light_px.y) < 0.02);
  }
}

TEST_CASE("a centroid above a threshold would be pulled by the background's slope") {
  const cv::Point2d centre(24.3, 24.6);
  const cv::Mat image = tests::paint(
      {49, 49},
      [&](double u, double v) {
        return std::hypot(u - centre.x, v - centre.y) < 8.0 ? kBright : kBackground + 3.0 * (u - 24.0);
      },
      8, 0.8);
  double sum = 0.0, moment = 0.0;
  for (int v = 12; v < 37; ++v) {
    for (int u = 12; u < 37; ++u) {
      const double w = std::max(0.0, image.at<double>(v, u) - 60.0);
      sum += w;
      moment += w * u;
    }
  }
  CHECK(moment / sum - centre.x > 0.3);
  const auto fit = core::fit_marker(exact(image), guess_of(centre, 8.0, 0.8), core::Surface::uniform);
  REQUIRE(fit);
  CHECK(std::abs(fit->centre.x - centre.x) < 0.01);
}

TEST_CASE("the noise of the centre is within 1.3 times the Cramer-Rao bound and is stated correctly") {
  for (const double radius : {3.0, 5.0, 10.0}) {
    for (const double blur_px : {0.4, 0.8}) {
      const cv::Point2d centre(24.37, 24.61);
      const cv::Mat image = image_of(centre, radius, blur_px, {0.0, 0.0});
      const auto mean = core::fit_marker(exact(image), guess_of(centre, radius, blur_px), core::Surface::uniform);
      REQUIRE(mean);
      double variance = 0.0, stated = 0.0;
      constexpr int kTrials = 300;
      for (int k = 0; k < kTrials; ++k) {
        const core::Signal noisy{tests::expose(image, kNoise, static_cast<std::uint64_t>(1000 + k))};
        const auto fit = core::fit_marker(noisy, guess_of(centre, radius, blur_px), core::Surface::uniform);
        REQUIRE(fit);
        variance += 0.5 * squared(fit->centre - mean->centre) / kTrials;
        stated += fit->sd_px * fit->sd_px / kTrials;
      }
      // Information on u: the sum over pixels of (dI/du)^2, by the difference of two images. The noise includes
      // rounding.
      const double step = 0.05;
      const cv::Mat right = image_of(centre + cv::Point2d(step, 0), radius, blur_px, {0.0, 0.0});
      const cv::Mat left = image_of(centre - cv::Point2d(step, 0), radius, blur_px, {0.0, 0.0});
      const double information = std::pow(cv::norm(right - left) / (2.0 * step), 2);
      const double bound = std::sqrt((kNoise * kNoise + 1.0 / 12.0) / information);
      INFO("radius " << radius << ", blur " << blur_px << ": noise " << std::sqrt(variance) << " px, stated "
                     << std::sqrt(stated) << ", bound " << bound);
      // 600 coordinates: the standard deviation scatters by 3 %.
      CHECK(std::sqrt(variance) < 1.3 * bound);
      CHECK(std::sqrt(variance) > 0.9 * bound);
      CHECK(std::abs(std::sqrt(stated / variance) - 1.0) < 0.2);
    }
  }
}

TEST_CASE("a sphere that is lit from one side keeps its centre if its shading is fitted") {
  const cv::Point2d centre(24.3, 24.8);
  const double radius = 7.0;
  const cv::Point2d light(0.6, -0.3);
  const cv::Mat image = tests::paint(
      {49, 49},
      [&](double u, double v) {
        const double x = (u - centre.x) / radius, y = (v - centre.y) / radius;
        const double rho2 = x * x + y * y;
        if (rho2 >= 1.0) return 60.0;
        // Lambert's law for a lamp in front and to the side, plus ambient light.
        const double facing = light.x * x + light.y * y + 0.74 * std::sqrt(1.0 - rho2);
        return 90.0 + 120.0 * std::max(0.0, facing);
      },
      8, 0.5);
  const auto uniform = core::fit_marker(exact(image), guess_of(centre, radius, 0.5), core::Surface::uniform);
  const auto shaded = core::fit_marker(exact(image), guess_of(centre, radius, 0.5), core::Surface::shaded);
  REQUIRE(uniform);
  REQUIRE(shaded);
  INFO("uniform off by " << cv::norm(uniform->centre - centre) << " px, shaded by "
                         << cv::norm(shaded->centre - centre));
  CHECK(cv::norm(uniform->centre - centre) > 0.2);
  // The quadratic surface is not exactly Lambert's. A few hundredths of a pixel are left, a seventh of a per cent of
  // the radius.
  CHECK(cv::norm(shaded->centre - centre) < 0.05);
  CHECK(shaded->bic < uniform->bic);
}

TEST_CASE("an ellipse and a streak of motion keep their centre and show their elongation") {
  const cv::Point2d centre(24.4, 23.7);
  const double angle = 0.5;
  const cv::Mat image = tests::paint(
      {49, 49},
      [&](double u, double v) {
        const double x = std::cos(angle) * (u - centre.x) + std::sin(angle) * (v - centre.y);
        const double y = -std::sin(angle) * (u - centre.x) + std::cos(angle) * (v - centre.y);
        return std::hypot(x / 7.0, y / 5.0) < 1.0 ? kBright : kBackground;
      },
      8, 0.5);
  const auto fit = core::fit_marker(exact(image), guess_of(centre, 6.0, 0.5), core::Surface::uniform);
  REQUIRE(fit);
  CHECK(cv::norm(fit->centre - centre) < 0.01);
  CHECK(std::abs(fit->elongation - 1.4) < 0.03);
  CHECK(std::abs(fit->radius_px - std::sqrt(35.0)) < 0.05);
}

TEST_CASE("the body that carries the marker hardly moves its centre") {
  // A dark glider below the lower rim of the marker, and the wall above: a step of 40 grey values, 1.2 radii below the
  // centre.
  const double radius = 6.0;
  double first = 0.0;
  for (const double phase : {0.0, 0.25, 0.5, 0.75}) {
    const cv::Point2d centre(24.0 + phase, 24.0 + phase);
    cv::Mat image = tests::paint(
        {49, 49}, [&](double, double v) { return v > centre.y + 1.2 * radius ? 40.0 : 80.0; }, 8, 0.5);
    tests::put_disc(image, centre, radius, kBright, 0.5);
    const auto fit = core::fit_marker(exact(image), guess_of(centre, radius, 0.5), core::Surface::uniform);
    REQUIRE(fit);
    // Along the glider nothing changes. Across it, a constant offset may be left, which does not vary with the phase of
    // the pixels.
    CHECK(std::abs(fit->centre.x - centre.x) < 0.01);
    CHECK(std::abs(fit->centre.y - centre.y) < 0.1);
    if (phase == 0.0) first = fit->centre.y - centre.y;
    CHECK(std::abs(fit->centre.y - centre.y - first) < 0.02);
  }
}

TEST_CASE("an object that is no marker gives no fit") {
  const cv::Mat flat(49, 49, CV_64F, cv::Scalar(90.0));
  const core::MarkerGuess guess = guess_of({24.0, 24.0}, 6.0, 0.5);
  CHECK_FALSE(core::fit_marker({tests::expose(flat, 2.0, 3)}, guess, core::Surface::uniform));
  cv::Mat edge = flat.clone();
  edge(cv::Rect(24, 0, 25, 49)).setTo(200.0);
  CHECK_FALSE(core::fit_marker({tests::expose(edge, 2.0, 3)}, guess, core::Surface::uniform));
  const cv::Mat disc = image_of({24.0, 24.0}, 6.0, 0.5);
  CHECK_FALSE(core::fit_marker({tests::expose(300.0 - disc, 2.0, 3)}, guess, core::Surface::uniform));  // dark
  core::MarkerGuess at_rim = guess;
  at_rim.centre = {4.0, 24.0};
  CHECK_FALSE(core::fit_marker({tests::expose(disc, 2.0, 3)}, at_rim, core::Surface::uniform));
  core::MarkerGuess much_larger = guess;
  much_larger.radius_px = 14.0;
  CHECK_FALSE(core::fit_marker({tests::expose(disc, 2.0, 3)}, much_larger, core::Surface::uniform));
}

TEST_CASE("the centroid of an object of any shape moves with it") {
  // A rotated rectangle of 11 x 14 px on a background without a slope. Its centroid is its middle.
  const double angle = 0.4;
  for (const double phase : {0.0, 0.3, 0.6}) {
    const cv::Point2d centre(24.0 + phase, 23.5 - phase);
    const cv::Mat image = tests::paint(
        {49, 49},
        [&](double u, double v) {
          const double x = std::cos(angle) * (u - centre.x) + std::sin(angle) * (v - centre.y);
          const double y = -std::sin(angle) * (u - centre.x) + std::cos(angle) * (v - centre.y);
          return std::abs(x) < 5.5 && std::abs(y) < 7.0 ? 180.0 : 5.0;
        },
        8, 0.7);
    const auto found = core::centroid_of_marker(exact(image), guess_of(centre, 7.0, 0.5));
    REQUIRE(found);
    // The floor cuts the blurred rim unevenly along its 50 px, which shifts the centroid by hundredths of a pixel.
    CHECK(cv::norm(found->centre - centre) < 0.03);
    CHECK(std::abs(found->radius_px - std::sqrt(154.0 / std::numbers::pi)) < 0.5);
  }
}

TEST_CASE("an object that the edge of the image cuts, or may cut, has no centroid") {
  // A disc of 7 px radius: its outermost pixel is 7 px off. Two pixels beyond it must be in the image.
  for (const auto& [clear_px, measured] : {std::pair(2.6, true), {1.4, false}, {-3.0, false}}) {
    CAPTURE(clear_px);
    const cv::Point2d from_left(7.0 + clear_px - 0.5, 24.0), from_top(24.0, 7.0 + clear_px - 0.5);
    for (const cv::Point2d centre : {from_left, from_top, cv::Point2d(48.0, 48.0) - from_left}) {
      const auto image = tests::paint(
          {49, 49}, [&](double u, double v) { return cv::norm(cv::Point2d(u, v) - centre) < 7.0 ? 180.0 : 5.0; }, 8,
          0.4);
      CHECK(core::centroid_of_marker(exact(image), guess_of(centre, 7.0, 0.5)).has_value() == measured);
    }
  }
}

namespace {

/// The centroid as its description in marker_method.h says, by loops over lists of pixels.
std::optional<core::MarkerFit> centroid_by_loops(const core::Signal& signal, const core::MarkerGuess& guess) {
  const double reach = 2.2 * guess.radius_px + 2.0;
  const cv::Point corner(cvFloor(guess.centre.x - reach), cvFloor(guess.centre.y - reach));
  const cv::Rect box =
      cv::Rect(corner, cv::Size(2 * cvCeil(reach) + 1, 2 * cvCeil(reach) + 1)) & cv::Rect({}, signal.values.size());
  std::vector<double> rim, near;
  std::vector<cv::Point> pixels;
  cv::Point seed;
  double best = -1.0;
  for (int v = box.y; v < box.br().y; ++v) {
    for (int u = box.x; u < box.br().x; ++u) {
      pixels.emplace_back(u, v);
      const double off = cv::norm(cv::Point2d(u, v) - guess.centre);
      if (off > 1.6 * guess.radius_px) rim.push_back(signal.at(u, v));
      if (off > guess.radius_px) continue;
      near.push_back(signal.at(u, v));
      if (signal.at(u, v) > best) best = signal.at(u, v), seed = {u, v};
    }
  }
  std::sort(rim.begin(), rim.end());
  std::sort(near.begin(), near.end());
  core::MarkerFit fit;
  fit.background = rim[rim.size() / 2];
  fit.amplitude = near[9 * near.size() / 10] - fit.background;
  const double floor = fit.background + 0.2 * fit.amplitude;
  if (!(fit.amplitude > 0.0) || !(best > floor)) return std::nullopt;
  std::vector<cv::Point> spot{seed};
  std::erase(pixels, seed);
  for (std::size_t k = 0; k < spot.size(); ++k) {
    const cv::Point here = spot[k];
    std::erase_if(pixels, [&](cv::Point p) {
      const bool beside = std::abs(p.x - here.x) + std::abs(p.y - here.y) == 1 && signal.at(p.x, p.y) > floor;
      if (beside) spot.push_back(p);
      return beside;
    });
  }
  double sum = 0.0, area = 0.0;
  for (const cv::Point p : spot) {
    const double weight = std::min((signal.at(p.x, p.y) - floor) / (0.8 * fit.amplitude), 1.0);
    sum += weight;
    fit.centre += weight * cv::Point2d(p);
    area += std::min(2.0 * weight, 1.0);
  }
  for (const cv::Point p : spot) {
    if (p.x < 2 || p.y < 2 || p.x + 2 >= signal.values.cols || p.y + 2 >= signal.values.rows) return std::nullopt;
  }
  fit.centre /= sum;
  fit.radius_px = std::sqrt(area / std::numbers::pi);
  if (!core::has_expected_size(fit, guess)) return std::nullopt;
  return fit;
}

}  // namespace

TEST_CASE("the centroid is that of a sum over pixels, for any depth, place and tie") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(4.0, 45.0), size(1.2, 11.0);
  std::size_t found = 0;
  for (int k = 0; k < 300; ++k) {
    const double radius = size(random);
    const cv::Point2d centre(place(random), place(random));
    cv::Mat image = image_of(centre, radius, 0.2 * radius);
    // Of 8 bits with few levels, many pixels tie for the brightest; of 16 bits, none do.
    const core::Signal signal = k % 2 == 0 ? exact(image) : core::Signal{tests::expose(0.06 * image, 0.4, 20 + k)};
    const core::MarkerGuess guess = guess_of(centre, radius, 0.5);
    const auto by_loops = centroid_by_loops(signal, guess);
    const auto centroid = core::centroid_of_marker(signal, guess);
    REQUIRE(centroid.has_value() == by_loops.has_value());
    if (!centroid) continue;
    ++found;
    CHECK(centroid->background == by_loops->background);
    CHECK(centroid->amplitude == by_loops->amplitude);
    CHECK(cv::norm(centroid->centre - by_loops->centre) < 1e-11);  // rounding of sums over 2000 pixels
    CHECK(std::abs(centroid->radius_px - by_loops->radius_px) < 1e-11);
  }
  CHECK(found > 100);
}
