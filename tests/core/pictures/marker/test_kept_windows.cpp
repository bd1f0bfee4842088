#include "core/pictures/marker/kept_windows.h"

#include "tests/catch.h"

using namespace glidelab;

namespace {

const cv::Size kSize(200, 60);
constexpr double kRadius = 4.0;
/// 2 (ceil(1.25 r + 2.5) + 1) + 1 pixels of one byte to a side.
constexpr std::size_t kWindow = 19 * 19;

core::MarkerFit fit_at(cv::Point2d centre) {
  core::MarkerFit fit;
  fit.centre = centre;
  fit.radius_px = kRadius;
  fit.blur_px = 0.4;
  fit.shape = {1.0 / kRadius, 0.0, 1.0 / kRadius};
  return fit;
}

void keep(core::KeptWindows& windows, std::size_t frame, cv::Point2d centre) {
  static const core::Signal kSignal{cv::Mat::zeros(kSize, CV_8U)};
  core::MarkerGuess guess;
  guess.centre = centre;
  guess.radius_px = kRadius;
  windows.keep(kSignal, frame, guess, fit_at(centre));
}

/// Forty frames at rest, or at 3 px a frame.
core::MarkerPath path_from(cv::Point2d start, bool moves) {
  core::MarkerPath path;
  for (std::size_t k = 0; k < 40; ++k)
    path.push({k, fit_at(start + cv::Point2d(moves ? 3.0 * static_cast<double>(k) : 0.0, 0.0)), kRadius});
  return path;
}

/// A zigzag about a straight path: fourth differences of 16 amplitudes.
core::Places zigzag(std::size_t frames, double amplitude) {
  core::Places places;
  for (std::size_t k = 0; k < frames; ++k)
    places[k] = {static_cast<double>(k) + (k % 2 == 0 ? amplitude : -amplitude), 0.0};
  return places;
}

}  // namespace

TEST_CASE("a window that is measured again takes the place of the first, and its memory") {
  core::KeptWindows windows;
  keep(windows, 7, {50.2, 30.0});
  CHECK(windows.bytes() == kWindow);
  keep(windows, 7, {50.6, 30.0});
  CHECK(windows.bytes() == kWindow);
  REQUIRE(windows.around(7, {50.5, 30.0}, kRadius) != nullptr);
  CHECK(windows.around(7, {50.5, 30.0}, kRadius)->guess.centre.x + windows.around(7, {50.5, 30.0}, kRadius)->corner.x ==
        Approx(50.6));
  keep(windows, 7, {90.0, 30.0});  // another object
  keep(windows, 8, {50.6, 30.0});
  CHECK(windows.bytes() == 3 * kWindow);
  CHECK(windows.around(9, {50.6, 30.0}, kRadius) == nullptr);
}

TEST_CASE("a window for whose successor memory is too small stays") {
  core::KeptWindows windows;
  keep(windows, 7, {2.0, 2.0});  // cut by the image's corner: smaller than a whole one
  const std::size_t cut = windows.bytes();
  windows.limit(cut + 1);
  keep(windows, 7, {3.0, 3.0});
  CHECK(windows.bytes() == cut);
  REQUIRE(windows.around(7, {2.0, 2.0}, kRadius) != nullptr);
  windows.limit(2 * cut);
  keep(windows, 7, {3.0, 3.0});
  CHECK(windows.bytes() > cut);
  CHECK(windows.bytes() < 2 * cut);
}

TEST_CASE("objects that sleep, ended at rest or were given up make room for the windows of others") {
  core::KeptWindows windows;
  std::vector<core::MarkerPath> paths{path_from({30.0, 30.0}, true), path_from({30.0, 12.0}, false),
                                      path_from({90.0, 12.0}, false), path_from({30.0, 48.0}, true)};
  paths[1].asleep = true;
  paths[2].ended = true;
  paths[3].ended = true;  // it moved: it may be the first piece of the marker's path
  windows.limit(4 * 40 * kWindow);
  for (const core::MarkerPath& path : paths) {
    for (const core::MarkerSeen& seen : path.seen) keep(windows, seen.frame, seen.fit.centre);
  }
  const std::size_t all = windows.bytes();
  CHECK(windows.should_free());
  windows.free_all_but({paths[0], paths[1], paths[2], paths[3]});
  CHECK(windows.bytes() == all / 2);
  CHECK_FALSE(windows.should_free());  // not again until there is something to free
  for (std::size_t k = 0; k < 40; ++k) {
    CHECK(windows.around(k, paths[0].seen[k].fit.centre, kRadius) != nullptr);
    CHECK(windows.around(k, paths[1].seen[k].fit.centre, kRadius) == nullptr);
    CHECK(windows.around(k, paths[2].seen[k].fit.centre, kRadius) == nullptr);
    CHECK(windows.around(k, paths[3].seen[k].fit.centre, kRadius) != nullptr);
  }
  windows.free_all_but({paths[0]});
  CHECK(windows.bytes() == all / 4);
}

TEST_CASE("sightings are left out if the correction of the others gains more than their number loses") {
  // n / s²: with errors of 0.8 of those before, variances of 0.64, up to 36 % of the positions may go.
  const core::Places by_codes = zigzag(100, 0.1), corrected = zigzag(100, 0.08);
  const auto without_last = [&](std::size_t left) {
    return core::Places(corrected.begin(), std::next(corrected.begin(), static_cast<std::ptrdiff_t>(100 - left)));
  };
  CHECK(core::tells_more(without_last(1), by_codes));
  CHECK(core::tells_more(without_last(35), by_codes));
  CHECK_FALSE(core::tells_more(without_last(37), by_codes));
  CHECK_FALSE(core::tells_more(by_codes, corrected));
  CHECK_FALSE(core::tells_more(without_last(97), by_codes));  // too few to know their scatter
}
