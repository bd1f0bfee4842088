#include "core/motion/codec_drag.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kRate = 90.0, kMetresPerPixel = 0.0026;
constexpr int kFrames = 180;

/// Pixels after t, from v (pixels a frame) to the limit of one pixel a frame: the worst speed, on the codec's grid.
double travelled(double v, int frame) {
  constexpr double kFade = 30.0;  // frames
  return frame + (v - 1.0) * kFade * (1.0 - std::exp(-frame / kFade));
}

struct Made {
  std::vector<core::ClipSetup> setups;
  std::vector<core::TrackData> tracks;
  std::vector<std::vector<double>> error_px;  ///< the codec's
};

/// A marker that moves along (cosine, sine) in the image. The codec's place is that of the frame before moved by
/// quarters of a pixel along the path, and off by `dead_px` at most; noise of 0.01 px.
Made made(double dead_px, double cosine = 1.0, double sine = 0.0,
          const std::vector<double>& speeds = {6.0, 3.7, 2.2, 0.2}) {
  Made all;
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (const double v : speeds) {
    core::ClipSetup setup;
    setup.mass_kg = 0.3;
    core::TrackData track;
    track.frame_rate_hz = kRate;
    std::vector<double> off;
    double last = 0.0;
    for (int k = 0; k < kFrames; ++k) {
      const double place = travelled(v, k);
      const double predicted = k == 0 ? place : last + 0.25 * std::round(4.0 * (place - last));
      off.push_back(std::clamp(predicted - place, -dead_px, dead_px));
      last = place + off.back();
      const double seen = last + noise(random);
      track.t_s.push_back(k / kRate);
      track.x_m.push_back(kMetresPerPixel * seen);
      track.frame.push_back(static_cast<std::size_t>(k));
      track.sightings.push_back({static_cast<std::size_t>(k), 20.0 + cosine * seen, 30.0 + sine * seen, 0.01, 4.0});
    }
    track.frame_t_s = track.t_s;
    all.setups.push_back(setup);
    all.tracks.push_back(track);
    all.error_px.push_back(off);
  }
  return all;
}

std::optional<core::CodecDrag> drag_of(const Made& all, bool predicts) {
  std::vector<core::DragTrack> tracks;
  for (std::size_t i = 0; i < all.tracks.size(); ++i) tracks.push_back({&all.setups[i], &all.tracks[i]});
  return core::find_codec_drag(tracks, predicts);
}

double square(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double mean = 0.0, sum = 0.0;
  for (const double value : values) mean += value / n;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

}  // namespace

TEST_CASE("what a codec's quarter pixels do to a motion is found without a law of motion, along a row and a column") {
  for (const auto& [cosine, sine] : {std::pair(1.0, 0.0), std::pair(0.0, -1.0)}) {
    const Made all = made(0.025, cosine, sine);
    const auto drag = drag_of(all, true);
    REQUIRE(drag);
    CHECK(drag->log_evidence > 10.0);
    double before = 0.0, after = 0.0;
    for (std::size_t i = 0; i < all.tracks.size(); ++i) {
      std::vector<double> left;
      for (std::size_t k = 0; k < all.error_px[i].size(); ++k) {
        left.push_back(all.error_px[i][k] - drag->drag_m[i][k] / kMetresPerPixel);
      }
      before += square(all.error_px[i]);
      after += square(left);
    }
    // Eight waves of a sawtooth leave a tenth of its square, what noise of 0.01 px leaves open of them as much again,
    // and where the speed changes quickly the error is not its own limit.
    CHECK(after < 0.5 * before);
  }
}

TEST_CASE("positions without a codec's error give no evidence of one, and as good as none is taken off") {
  const Made all = made(0.0);
  const auto drag = drag_of(all, false);
  REQUIRE(drag);
  CHECK(drag->log_evidence < 3.0);
  CHECK(drag->rms_px < 0.002);  // a fifth of the noise
}

TEST_CASE("a drag that never recurs is taken off only behind a codec that is known to make one") {
  const Made slow = made(0.025, 1.0, 0.0, {1.8, 1.5, 0.5, 0.2});
  const auto known = drag_of(slow, true);
  REQUIRE(known);
  CHECK(known->log_evidence > 10.0);
  CHECK(!drag_of(slow, false));
  CHECK(drag_of(made(0.025), false));  // up to six pixels per frame
}

TEST_CASE("a codec's drag is not looked for in a marker that rests or in too few positions") {
  Made rest = made(0.0);
  for (core::TrackData& track : rest.tracks) {
    for (core::MarkerSighting& sighting : track.sightings) sighting.u_px = 20.0;
  }
  CHECK(!drag_of(rest, true));
  Made few = made(0.0);
  few.tracks.resize(1);
  few.setups.resize(1);
  core::TrackData& track = few.tracks[0];
  track.t_s.resize(40);
  track.x_m.resize(40);
  track.frame.resize(40);
  track.frame_t_s.resize(40);
  track.sightings.resize(40);
  CHECK(!drag_of(few, true));
}
