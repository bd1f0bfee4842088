#include "core/analysis/repeats_left_out.h"

#include <cmath>
#include <memory>

#include "tests/catch.h"
#include "tests/core/notes.h"

using namespace glidelab;

namespace {

constexpr double kFile_hz = 30.0;

/// A marker that slows down along a slanted line: 24 images a second in a file of 30 frames a second. `px`: of its
/// first step.
core::SeenClip converted(double px) {
  core::SeenClip seen;
  seen.images = std::make_shared<core::ImageRecord>();
  seen.notes = {core::RepeatedFrames{3, 90}, core::LastFramesUnstamped{}};
  for (std::size_t f = 0; f < 90; ++f) {
    const double t_s = std::floor(0.8 * static_cast<double>(f) + 0.1) / 24.0;
    const double s_px = px * (24.0 * t_s - 2.0 * t_s * t_s);
    seen.frame_t_s.push_back(static_cast<double>(f) / kFile_hz);
    core::MarkerSighting sighting{};
    sighting.frame = f;
    sighting.u_px = 400.0 - 0.8 * s_px;
    sighting.v_px = 100.0 + 0.6 * s_px;
    seen.marker.sightings.push_back(sighting);
    core::MarkerFit fit{};
    fit.centre = {sighting.u_px, sighting.v_px};
    seen.marker.fits.push_back(fit);
    core::MarkerLook look{};
    look.frame = f;
    look.t_s = seen.frame_t_s.back();
    seen.images->marker.push_back(look);
  }
  return seen;
}

}  // namespace

TEST_CASE("a film that a converter brought to a higher rate gets the camera's times, and loses its repeats") {
  core::SeenClip seen = converted(5.0);
  core::leave_out_repeats(seen);
  REQUIRE(seen.marker.sightings.size() == 72);
  REQUIRE(seen.marker.fits.size() == 72);
  REQUIRE(seen.images->marker.size() == 72);
  CHECK(seen.marker.left_out == 18);
  CHECK(seen.frame_t_s.size() == 90);
  const double start_s = seen.frame_t_s[seen.marker.sightings.front().frame];
  double worst_s = 0.0;
  for (std::size_t i = 0; i < 72; ++i) {
    const core::MarkerSighting& at = seen.marker.sightings[i];
    const double t_s = seen.frame_t_s[at.frame];
    worst_s = std::max(worst_s, std::abs(t_s - start_s - static_cast<double>(i) / 24.0));
    CHECK(seen.marker.fits[i].centre.x == at.u_px);
    CHECK(seen.images->marker[i].frame == at.frame);
    CHECK(seen.images->marker[i].t_s == t_s);
  }
  CHECK(worst_s < 1e-12);
  for (std::size_t f = 1; f < 90; ++f) CHECK(seen.frame_t_s[f] > seen.frame_t_s[f - 1]);
  const auto* const note = tests::note_of<core::RepeatsLeftOut>(seen.notes);
  REQUIRE(note != nullptr);
  CHECK(note->repeats == 18);
  CHECK(note->camera_hz == Approx(24.0).epsilon(1e-12));
  CHECK(tests::note_of<core::RepeatedFrames>(seen.notes) == nullptr);
  CHECK(tests::note_of<core::LastFramesUnstamped>(seen.notes) != nullptr);
}

TEST_CASE(
    "a marker slower than a pixel a frame may be left where it was by a codec, so none of its frames is left out") {
  core::SeenClip seen = converted(0.9);
  core::leave_out_repeats(seen);
  CHECK(seen.marker.sightings.size() == 90);
  CHECK(seen.frame_t_s[50] == 50.0 / kFile_hz);
  CHECK(tests::note_of<core::RepeatsLeftOut>(seen.notes) == nullptr);
}

TEST_CASE(
    "a file that states uneven times is taken at its word, and a clip without a marker has nothing to leave out") {
  core::SeenClip seen = converted(5.0);
  seen.frame_t_s.back() += 0.3 / kFile_hz;
  core::leave_out_repeats(seen);
  CHECK(seen.marker.sightings.size() == 90);
  core::SeenClip empty;
  core::leave_out_repeats(empty);
  CHECK(empty.notes.empty());
}
