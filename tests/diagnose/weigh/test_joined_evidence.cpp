#include "diagnose/weigh/joined_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.h"

using namespace glidelab;

namespace {

double normal(double x, double mean, double sd) {
  return std::exp(-0.5 * std::pow((x - mean) / sd, 2)) / (sd * std::sqrt(2.0 * std::numbers::pi));
}

diagnose::ImageFinding finding(const std::string& id, double log_evidence) {
  diagnose::ImageFinding one;
  one.id = id;
  one.log_evidence = log_evidence;
  one.seen = log_evidence > 3.0;
  one.parameters = {{"size", 1.0, 0.1}};
  return one;
}

/// The explanation of just these effects; null where there is none.
const diagnose::Hypothesis* of(const diagnose::Comparison& comparison, std::vector<std::string> ids, bool unnamed) {
  for (const auto& hypothesis : comparison.all) {
    std::set<std::size_t> wanted;
    for (const auto& id : ids) wanted.insert(diagnose::effect_index(id));
    if (hypothesis.unnamed == unnamed &&
        std::set<std::size_t>(hypothesis.effects.begin(), hypothesis.effects.end()) == wanted) {
      return &hypothesis;
    }
  }
  return nullptr;
}

/// Nothing, a drag and something unnamed, as tracks would have weighed them, without fits.
diagnose::Comparison weighed() {
  diagnose::Comparison comparison;
  comparison.all.push_back({{}, false, 0.0, 0.0, 0.0, -1});
  comparison.all.push_back({{diagnose::effect_index("quadratic_drag")}, false, 9.0, 5.0, 0.0, -1});
  comparison.all.push_back({{}, true, 4.0, 2.0, 0.0, -1});
  return comparison;
}

}  // namespace

TEST_CASE("two measurements of one size agree as the integral over that size says") {
  for (const auto& [images, tracks] : std::vector<std::pair<diagnose::Measured, diagnose::Measured>>{
           {{3.0, 0.5}, {2.5, 0.8}}, {{0.2, 1.0}, {4.0, 0.1}}, {{-1.0, 0.3}, {1.0, 0.3}}}) {
    // The trapezoidal rule on a Gaussian is exact to rounding with steps of half a standard deviation and less.
    double integral = 0.0;
    const double step = 0.05;
    for (double size = -20.0; size < 20.0; size += step) {
      integral += step * normal(images.value, size, images.sd) * normal(size, tracks.value, tracks.sd);
    }
    const double expected = std::log(integral / normal(images.value, 0.0, images.sd));
    CHECK(std::abs(diagnose::agreement(images, tracks) - expected) < 1e-9);
  }
}

TEST_CASE("what images show joins every explanation with its own log evidence, and competes with none") {
  diagnose::Comparison comparison = weighed();
  diagnose::ImageEvidence images;
  images.findings = {finding("light_flicker", 11.0)};
  diagnose::join_images({}, images, {}, comparison);
  REQUIRE(comparison.all.size() == 6);
  for (const bool unnamed : {false, true}) {
    const auto *without = of(comparison, {}, unnamed), *with = of(comparison, {"light_flicker"}, unnamed);
    REQUIRE(without != nullptr);
    REQUIRE(with != nullptr);
    CHECK(with->log_evidence == without->log_evidence + 11.0);  // sums of whole numbers: exact
    CHECK(without->of_images == 0.0);
    CHECK(with->of_images == 11.0);
  }
  REQUIRE(of(comparison, {"quadratic_drag", "light_flicker"}, false) != nullptr);
  CHECK(of(comparison, {"quadratic_drag", "light_flicker"}, false)->log_evidence == 16.0);
  CHECK(of(comparison, {"quadratic_drag"}, false)->log_evidence == 5.0);
  CHECK(comparison.in_images == std::set<std::size_t>{diagnose::effect_index("light_flicker")});
}

TEST_CASE("two findings join one another, what images speak against joins nothing, and what is left out neither") {
  diagnose::Comparison comparison = weighed();
  diagnose::ImageEvidence images;
  images.findings = {finding("light_flicker", 11.0), finding("light_gradient", 7.0), finding("camera_motion", -40.0)};
  diagnose::join_images({}, images, {}, comparison);
  const auto* both = of(comparison, {"light_flicker", "light_gradient"}, false);
  REQUIRE(both != nullptr);
  CHECK(both->log_evidence == 18.0);
  CHECK(of(comparison, {"camera_motion"}, false) == nullptr);
  CHECK(comparison.all.size() == 12);

  diagnose::Comparison fewer = weighed();
  diagnose::join_images({}, images, {diagnose::effect_index("light_gradient")}, fewer);
  CHECK(of(fewer, {"light_gradient"}, false) == nullptr);
  CHECK(fewer.all.size() == 6);
}

TEST_CASE("an explanation that holds the effect already is raised or lowered by what the images show of it") {
  for (const double log_evidence : {9.0, -9.0}) {
    diagnose::Comparison comparison = weighed();
    comparison.all.push_back({{diagnose::effect_index("camera_motion")}, false, 20.0, 14.0, 0.0, -1});
    diagnose::ImageEvidence images;
    images.findings = {finding("camera_motion", log_evidence)};
    diagnose::join_images({}, images, {}, comparison);
    CHECK(of(comparison, {"camera_motion"}, false)->log_evidence == 14.0 + log_evidence);
    CHECK(of(comparison, {"camera_motion"}, false)->of_images == log_evidence);
    CHECK(std::count_if(comparison.all.begin(), comparison.all.end(), [](const auto& h) {
            return h.effects == std::vector<std::size_t>{diagnose::effect_index("camera_motion")} && !h.unnamed;
          }) == 1);
  }
}

TEST_CASE("a smeared marker that scatters more at speed is one effect, not two") {
  diagnose::Comparison comparison = weighed();
  comparison.frames = {{diagnose::effect_index("heavy_tailed_noise"), 20.0, 13.0, 0.05, 0.01}};
  comparison.all.push_back({{diagnose::effect_index("heavy_tailed_noise")}, false, 20.0, 13.0, 0.0, -1});
  diagnose::ImageEvidence images;
  images.findings = {finding("exposure_blur", 70.0)};
  diagnose::join_images({}, images, {}, comparison);
  CHECK(of(comparison, {"exposure_blur"}, false)->log_evidence == 83.0);
  CHECK(of(comparison, {"exposure_blur", "heavy_tailed_noise"}, false)->log_evidence == 83.0);
}
