#include "core/math/skipped_frames.h"

#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// A glider that slows down and turns, at the frames of a camera that loses those in `lost`, with noise.
std::vector<core::PlaceAtFrame> filmed(const std::set<std::size_t>& lost, double noise_px, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> off(0.0, noise_px);
  std::vector<core::PlaceAtFrame> places;
  for (std::size_t k = 0; k < 200; ++k) {
    if (lost.contains(k)) continue;
    const double t = static_cast<double>(k);
    places.push_back({places.size(), {30.0 + 3.0 * t - 0.01 * t * t + off(random), 40.0 + 0.1 * t + off(random)}});
  }
  return places;
}

}  // namespace

TEST_CASE("the frames that a camera lost are those by which the path steps on") {
  // Alone, seven and four frames apart, two in a row.
  const std::set<std::size_t> lost{20, 31, 38, 60, 64, 90, 91};
  for (const double noise_px : {0.0, 0.02, 0.05}) {
    CAPTURE(noise_px);
    const std::vector<core::PlaceAtFrame> places = filmed(lost, noise_px, 3);
    const std::vector<std::size_t> before = core::lost_before(places, 1e-6);
    REQUIRE(before.size() == places.size());
    for (std::size_t i = 0, k = 0; i < places.size(); ++i, ++k) {
      while (lost.contains(k)) ++k;
      CAPTURE(i);
      CHECK(places[i].frame + before[i] == k);
    }
  }
}

TEST_CASE("noise, a bounce and a frame without a sighting are no lost frames") {
  // 4 boundaries of 1000 would reach a ratio by noise, and fewer with the pattern of a loss: 2 of 20 clips at most.
  std::size_t any = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    if (core::lost_before(filmed({}, 0.3, 100 + seed), 1e-6).back() > 0) ++any;
  }
  CHECK(any <= 2);
  std::vector<core::PlaceAtFrame> bounced = filmed({}, 0.02, 5);
  for (std::size_t i = 51; i < bounced.size(); ++i) bounced[i].at[0] = 2.0 * bounced[50].at[0] - bounced[i].at[0];
  CHECK(core::lost_before(bounced, 1e-6).back() == 0);
  std::vector<core::PlaceAtFrame> unseen = filmed({}, 0.02, 6);
  unseen.erase(unseen.begin() + 70, unseen.begin() + 74);
  CHECK(core::lost_before(unseen, 1e-6).back() == 0);
}
