#include "core/pictures/marker/pattern/marker_template.h"

#include <cmath>
#include <memory>
#include <vector>

#include "core/pictures/marker/pattern/template_look.h"
#include "core/pictures/marker/second_look.h"
#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

const cv::Size kSize(220, 72);
constexpr std::size_t kFrames = 40;
constexpr double kRadius = 7.3;
constexpr double kNoise = 1.5;  // codes

/// A motion that slows down and drops a little.
cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {24.3 + 5.6 * t - 0.031 * t * t, 41.2 + 0.173 * t};
}

/// The light at an offset from the centre, in radii; negative outside the marker.
using Look = double (*)(double, double);

bool on_plate(double x, double y) {
  return std::abs(x) < 1.9 && std::abs(y) < 1.9;
}

double ring(double x, double y) {
  const double r = std::hypot(x, y);
  return r < 1.0 && r > 0.5 ? 0.8 : on_plate(x, y) ? 0.05 : -1.0;
}

double bulls_eye(double x, double y) {
  const double r = std::hypot(x, y);
  return r < 0.33 || (r < 1.0 && r > 0.66) ? 0.8 : on_plate(x, y) ? 0.05 : -1.0;
}

double quadrants(double x, double y) {
  return std::hypot(x, y) < 1.0 && x * y < 0.0 ? 0.8 : on_plate(x, y) ? 0.05 : -1.0;
}

/// A marker in front of a striped wall. A post hides part of it in some frames.
std::vector<cv::Mat> film_look(Look look, bool post) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const cv::Point2d c = place(k);
    const auto light = [&](double u, double v) {
      if (post && std::abs(u - 120.0) < 2.5) return 0.3;
      const double own = look((u - c.x) / kRadius, (v - c.y) / kRadius);
      return own >= 0.0 ? own : 0.2 + 0.05 * std::sin(0.31 * u);
    };
    frames.push_back(tests::expose_light(kSize, light, true, kNoise, 7100 + k));
  }
  return frames;
}

/// Rough positions, off by a constant and by up to one and a half pixels from frame to frame. A fifth of the frames is
/// missing.
core::TrackedMarker rough_path(double wrong_px) {
  core::TrackedMarker rough;
  for (std::size_t k = 0; k < kFrames; ++k) {
    if (k % 5 == 3 || k < 3) continue;
    const double shake = wrong_px * std::sin(11.0 * static_cast<double>(k * k));
    const cv::Point2d at = place(k) + cv::Point2d(0.4 + shake, -0.3 - 0.7 * shake);
    core::MarkerFit fit;
    fit.centre = at;
    rough.sightings.push_back({k, at.x, at.y, 0.5, kRadius});
    rough.fits.push_back(fit);
  }
  return rough;
}

std::optional<core::TrackedMarker> by_template(const std::vector<cv::Mat>& frames, const core::TrackedMarker& rough) {
  const core::ClipAgain clip{[&] { return std::make_unique<tests::ClipInMemory>(frames); }, frames.size()};
  const core::ShapeAt circle = [](cv::Point2d, core::MarkerBody) {
    return std::optional(cv::Vec3d(1.0, 0.0, 1.0) / kRadius);
  };
  return core::look_by_template(rough, core::windows_around(rough, clip, circle), circle);
}

/// Standard deviation of the positions about the truth in px. A constant offset is allowed.
double scatter(const core::TrackedMarker& found) {
  double sum = 0.0, squares = 0.0;
  for (const core::MarkerSighting& sighting : found.sightings) {
    const double off = sighting.u_px - place(sighting.frame).x;
    sum += off;
    squares += off * off;
  }
  const auto n = static_cast<double>(found.sightings.size());
  return std::sqrt(squares / n - sum * sum / n / n);
}

}  // namespace

TEST_CASE("A ring, a bull's eye and quadrants are followed by their own look") {
  struct Case {
    const char* name;
    Look look;
  };
  for (const Case& made : {Case{"ring", ring}, Case{"bull's eye", bulls_eye}, Case{"quadrants", quadrants}}) {
    INFO(made.name);
    const auto found = by_template(film_look(made.look, false), rough_path(1.5));
    REQUIRE(found);
    CHECK(found->sightings.size() + 1 >= kFrames);  // an end may lie off the position expected from its neighbours
    // Edges of a hundred codes, 2 pi 7 px long, with a noise of 1.5 codes give 0.005 px. The grid of the look leaves
    // more.
    CHECK(scatter(*found) < 0.03);
    const double mean_sd = [&] {
      double sum = 0.0;
      for (const auto& sighting : found->sightings) sum += sighting.sd_px / static_cast<double>(kFrames);
      return sum;
    }();
    CHECK(scatter(*found) < 2.5 * mean_sd);
    CHECK(mean_sd < 0.05);
  }
}

TEST_CASE("Every frame that shows the look settles, also where two places in turn ask for each other") {
  for (const Look look : {ring, bulls_eye, quadrants}) {
    const std::vector<cv::Mat> frames = film_look(look, false);
    std::vector<core::TemplateWindow> windows;
    std::vector<std::optional<core::TemplateFit>> fits;
    for (std::size_t k = 0; k < kFrames; ++k) {
      core::TemplateWindow window;
      const cv::Rect part = cv::Rect(cvRound(place(k).x) - 18, cvRound(place(k).y) - 18, 37, 37) & cv::Rect({}, kSize);
      frames[k](part).convertTo(window.codes, CV_32F);
      window.corner = part.tl();
      window.shape = cv::Vec3d(1.0, 0.0, 1.0) / kRadius;
      window.start = place(k);
      windows.push_back(window);
      fits.emplace_back(core::TemplateFit{place(k)});
    }
    const auto made = core::MarkerTemplate::of(windows, fits);
    REQUIRE(made);
    for (std::size_t k = 4; k + 4 < kFrames; ++k) {
      for (int start = 0; start < 9; ++start) {
        windows[k].start = place(k) + cv::Point2d(0.4 * (start % 3 - 1), 0.4 * (start / 3 - 1));
        CAPTURE(k, start);
        const auto fit = made->fit(windows[k]);
        REQUIRE(fit);
        CHECK(cv::norm(fit->centre - place(k)) < 0.2);  // the robust weights let places a tenth apart settle
      }
    }
  }
}

TEST_CASE("A look that is the same after half a turn is placed at its own centre") {
  for (const Look look : {ring, bulls_eye, quadrants}) {
    const auto found = by_template(film_look(look, false), rough_path(1.0));  // which is (0.4, -0.3) px off on average
    REQUIRE(found);
    cv::Point2d off;
    for (const core::MarkerSighting& sighting : found->sightings) {
      off += (cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame)) /
             static_cast<double>(found->sightings.size());
    }
    CHECK(cv::norm(off) < 0.02);
  }
}

TEST_CASE("A post in front of the marker hardly shifts its position by the look, or hides it") {
  const auto found = by_template(film_look(quadrants, true), rough_path(1.0));
  REQUIRE(found);
  // The post lies within 1.5 radii of the marker over 27 px of the path: eight frames at 3.5 px each.
  CHECK(found->sightings.size() >= kFrames - 8);
  CHECK(scatter(*found) < 0.15);
}

TEST_CASE("Rough positions on one end of the plate in some frames and on the marker in others give the marker in all") {
  // A difference from the background shows the whole plate, and what was followed slides along it.
  const Look wide = [](double x, double y) {
    const double r = std::hypot(x, y);
    if (r < 0.33 || (r < 1.0 && r > 0.66)) return 0.05;
    return std::abs(x) < 2.9 && std::abs(y) < 1.7 ? 0.8 : -1.0;
  };
  core::TrackedMarker rough;
  for (std::size_t k = 2; k + 2 < kFrames; ++k) {
    const double shake = std::sin(11.0 * static_cast<double>(k * k)), end = k < 22 ? 0.0 : -kRadius;
    const cv::Point2d at = place(k) + cv::Point2d(end + shake, 0.3 * shake);
    core::MarkerFit fit;
    fit.centre = at;
    rough.sightings.push_back({k, at.x, at.y, 0.5, kRadius});
    rough.fits.push_back(fit);
  }
  const auto found = by_template(film_look(wide, false), rough);
  REQUIRE(found);
  CHECK(found->sightings.size() + 1 >= rough.sightings.size());
  for (const core::MarkerSighting& sighting : found->sightings)
    CHECK(cv::norm(cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame)) < 0.1);  // as above
}

namespace {

constexpr std::size_t kMany = 90;

/// A bull's eye at these places, and where a search finds it, off by `wrong_px` from frame to frame.
struct SlowFilm {
  std::vector<cv::Mat> frames;
  core::TrackedMarker rough;

  void add(cv::Point2d at, double wrong_px, bool found = true) {
    const auto light = [&](double u, double v) {
      const double own = bulls_eye((u - at.x) / kRadius, (v - at.y) / kRadius);
      return own >= 0.0 ? own : 0.2;
    };
    const std::size_t k = frames.size();
    frames.push_back(tests::expose_light(kSize, light, true, kNoise, 8100 + k));
    if (!found) return;
    const double shake = wrong_px * std::sin(11.0 * static_cast<double>(k * k));
    core::MarkerFit fit;
    fit.centre = at + cv::Point2d(0.2 + shake, -0.3 - 0.7 * shake);
    rough.sightings.push_back({k, fit.centre.x, fit.centre.y, 0.5, kRadius});
    rough.fits.push_back(fit);
  }
};

}  // namespace

TEST_CASE("Frames that the camera lost close together are steps of the path, and every other frame is found") {
  // It slows down from 1.9 px per frame. Two frames are lost with six between them, and two in a row.
  SlowFilm film;
  std::vector<cv::Point2d> places;
  for (std::size_t k = 0; k < kMany; ++k) {
    if (k == 31 || k == 38 || k == 60 || k == 61) continue;
    const double t = static_cast<double>(k);
    places.emplace_back(40.3 + 1.9 * t - 0.004 * t * t, 36.2 + 0.02 * t);
    film.add(places.back(), 0.1);
  }
  const auto found = by_template(film.frames, film.rough);
  REQUIRE(found);
  CHECK(found->sightings.size() + 1 >= film.frames.size());  // as above
  for (const core::MarkerSighting& sighting : found->sightings)
    CHECK(cv::norm(cv::Point2d(sighting.u_px, sighting.v_px) - places[sighting.frame]) < 0.1);  // as above
}

TEST_CASE("A path on a lattice of whole pixels is that of a pattern of the pixels, not of a glider") {
  // It slows down from 0.25 px per frame to rest; the search finds it in every second frame.
  for (const bool whole : {false, true}) {
    CAPTURE(whole);
    SlowFilm film;
    for (std::size_t k = 0; k < kMany; ++k) {
      const double left = 1.0 - static_cast<double>(k) / kMany, u = 60.3 + 11.25 * (1.0 - left * left);
      film.add({whole ? std::floor(u) + 0.3 : u, 36.2}, 0.1, k % 2 == 0);
    }
    CHECK(by_template(film.frames, film.rough).has_value() == !whole);
  }
}

TEST_CASE("No look is found where nothing moves along the path") {
  const auto nothing = [](double, double) { return -1.0; };
  CHECK_FALSE(by_template(film_look(nothing, false), rough_path(0.5)));
}

TEST_CASE("A disc of half the stated size is not followed by its own look") {
  const auto small = [](double x, double y) { return std::hypot(x, y) < 0.5 ? 0.8 : on_plate(x, y) ? 0.05 : -1.0; };
  CHECK_FALSE(by_template(film_look(small, false), rough_path(0.5)));
}

TEST_CASE("Sightings that jump about make no path, and those of a glider that slows down make one") {
  core::TrackedMarker steady, jumping;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const cv::Point2d at = place(k);
    steady.sightings.push_back({k, at.x, at.y, 0.01, kRadius});
    const double off = 20.0 * std::sin(13.0 * static_cast<double>(k * k));
    jumping.sightings.push_back({k, at.x + off, at.y, 0.01, kRadius});
  }
  CHECK(core::is_steady(steady));
  CHECK_FALSE(core::is_steady(jumping));
}
