#include "core/analysis/clip_to_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr double kRate = 100.0, kPixelsPerMetre = 400.0, kSpeed = 300.0;  // px/s, along the image's diagonal
const cv::Size kSize(240, 200);

/// Pixels along the line of motion at a time.
cv::Point2d place(double t) {
  return cv::Point2d(30.0, 25.0) + kSpeed * t * cv::Point2d(0.8, 0.6);
}

core::Experiment experiment_of(const std::filesystem::path& clip, double line_readout_s) {
  core::Experiment experiment;
  experiment.name = "rolling";
  experiment.camera.emplace().frame_rate_hz = kRate;
  if (line_readout_s > 0.0) {
    experiment.camera->shutter = core::Shutter::rolling;
    experiment.camera->line_readout_s = line_readout_s;
  }
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 12.0 / kPixelsPerMetre;
  core::ClipSetup setup;
  setup.name = "clip";
  setup.file = clip;
  setup.mass_kg = 0.3;
  setup.group = "all";
  experiment.clips = {setup};
  return experiment;
}

}  // namespace

TEST_CASE("a rolling shutter's rows have their own times where the experiment declares it") {
  const tests::TempDir dir;
  const double line_readout_s = 4e-5;  // 8 ms for 200 rows
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 45; ++k) {
    // The row on which the marker is seen: v = v(t_k + readout (v - middle row)), solved for v.
    const double middle = 0.5 * (kSize.height - 1), slope = kSpeed * 0.6 * line_readout_s;
    const double v = (place(k / kRate).y - slope * middle) / (1.0 - slope);
    const double t = k / kRate + line_readout_s * (v - middle);
    cv::Mat image(kSize, CV_64F, cv::Scalar(60.0));
    tests::put_disc(image, place(t), 6.0, 210.0);
    frames.push_back(image);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  const auto error_of = [&](double declared_s) {
    const auto results = core::tracks_of(experiment_of(dir / "clip.mkv", declared_s), 1);
    const core::TrackData& track = results.tracks.at(0);
    REQUIRE(track.t_s.size() >= 40);
    // The origin is that of the image: x at t minus its first value is the distance travelled since.
    double worst = 0.0;
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      const double moved = kSpeed / kPixelsPerMetre * (track.t_s[i] - track.t_s[0]);
      worst = std::max(worst, std::abs(track.x_m[i] - track.x_m[0] - moved));
    }
    return worst;
  };
  // Noise of 1 of 150 leaves 0.005 px a coordinate; two positions, the largest of 45: 0.03 px.
  CHECK(error_of(line_readout_s) < 0.03 / kPixelsPerMetre);
  // Not declared: the marker goes down 79 rows, which at 40 us each is 3.2 ms, in which it moves by 0.95 px.
  CHECK(error_of(0.0) > 0.5 / kPixelsPerMetre);
}

TEST_CASE("an interlaced film is noted, whether or not anyone asks for its scene") {
  const tests::TempDir dir;
  for (const bool interlaced : {true, false}) {
    std::vector<cv::Mat> frames;
    for (int k = 0; k < 45; ++k) {
      std::array<cv::Mat, 2> fields;
      for (const int field : {0, 1}) {
        fields[field] = cv::Mat(kSize, CV_64F, cv::Scalar(60.0));
        const double late = interlaced ? 0.5 * field : 0.0;
        tests::put_disc(fields[field], place((k + late) / kRate), 6.0, 210.0);
      }
      for (int row = 1; row < kSize.height; row += 2) fields[1].row(row).copyTo(fields[0].row(row));
      frames.push_back(fields[0]);
    }
    const std::filesystem::path clip = dir / (interlaced ? "woven.mkv" : "whole.mkv");
    tests::write_video(clip, frames, kRate, 1.0);
    const auto results = core::tracks_of(experiment_of(clip, 0.0), 1);
    const auto* const note = tests::note_of<core::InterlacedFilm>(results.tracks.at(0).notes);
    REQUIRE((note != nullptr) == interlaced);
    if (note != nullptr) CHECK(note->frame_rate_hz == kRate);
  }
}

TEST_CASE("frames without the marker are noted, unless it is at the edge of the image there") {
  for (const bool from_edge : {false, true}) {
    const tests::TempDir dir;
    std::vector<cv::Mat> frames;
    for (int k = 0; k < 50; ++k) {
      cv::Mat image(kSize, CV_64F, cv::Scalar(60.0));
      const double u = (from_edge ? -50.0 : 30.0) + 3.5 * k;
      if (from_edge || k >= 12) tests::put_disc(image, {u, 100.0}, 6.0, 210.0);
      frames.push_back(image);
    }
    tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
    const auto results = core::tracks_of(experiment_of(dir / "clip.mkv", 0.0), 1);
    const auto* const lost = tests::note_of<core::MarkerLost>(results.tracks.at(0).notes);
    CHECK((lost == nullptr) == from_edge);
    if (lost == nullptr) continue;
    CHECK(lost->before == 12);
    CHECK(lost->between == 0);
    CHECK(lost->after == 0);
    CHECK(lost->frames == 50);
  }
}

namespace {

/// A card of this brightness with discs on it (where they are on the card, and how bright) moves over a grey wall.
std::filesystem::path card_clip(const tests::TempDir& dir, double card,
                                const std::vector<std::pair<cv::Point2d, double>>& discs) {
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 45; ++k) {
    cv::Mat image(kSize, CV_64F, cv::Scalar(110.0));
    const cv::Point2d at = place(k / kRate);
    tests::put_box(image, cv::Rect(cv::Point(at) - cv::Point(28, 16), cv::Size(56, 32)), card);
    for (const auto& [on_card, value] : discs) tests::put_disc(image, at + on_card, 6.0, value);
    frames.push_back(image);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  return dir / "clip.mkv";
}

core::TrackData only_track(const std::filesystem::path& clip,
                           core::MarkerSearch search = core::MarkerSearch::thorough) {
  return core::tracks_of(experiment_of(clip, 0.0), 1, base::no_progress, core::open_frames, false, nullptr, search)
      .tracks.at(0);
}

/// Largest distance of a sighting from a place on the card, in pixels.
double worst_px(const core::TrackData& track, cv::Point2d on_card) {
  double worst = 0.0;
  for (const core::MarkerSighting& seen : track.sightings) {
    const cv::Point2d true_px = place(static_cast<double>(seen.frame) / kRate) + on_card;
    worst = std::max(worst, cv::norm(cv::Point2d(seen.u_px, seen.v_px) - true_px));
  }
  return worst;
}

}  // namespace

TEST_CASE("of two gliders alike in every clip, each clip's start_px says which") {
  const tests::TempDir dir;
  const cv::Point2d one(-14.0, 0.0), other(14.0, 0.0);
  card_clip(dir, 30.0, {{one, 200.0}, {other, 200.0}});
  core::Experiment experiment = experiment_of(dir / "clip.mkv", 0.0);
  experiment.clips.push_back(experiment.clips.front());
  experiment.clips.back().name = "again";
  CHECK_THROWS_WITH(core::tracks_of(experiment, 1), Catch::Contains("start_px in the clip's [[clip]]"));
  for (const auto& [clip, on_card] : {std::pair(0, one), std::pair(1, other)}) {
    const cv::Point2d start = place(0.0) + on_card;
    experiment.clips[static_cast<std::size_t>(clip)].start_px = {start.x, start.y};
  }
  const auto tracks = core::tracks_of(experiment, 1).tracks;
  CHECK(worst_px(tracks.at(0), one) < 0.03);  // as derived below
  CHECK(worst_px(tracks.at(1), other) < 0.03);
}

TEST_CASE("a marker whose colour is not stated is found bright on dark and dark on bright, and a note says which") {
  const tests::TempDir dir;
  // 0.03 px: noise of 1 of 120 at 40 pixels of the outline is 0.005 px, and the card moves by whole pixels under it.
  const core::TrackData dark = only_track(card_clip(dir, 190.0, {{{0.0, 0.0}, 20.0}}));
  CHECK(dark.dark_marker);
  CHECK(dark.sightings.size() >= 40);
  CHECK(worst_px(dark, {0.0, 0.0}) < 0.03);
  CHECK(tests::note_of<core::DarkMarker>(dark.notes) != nullptr);
  const core::TrackData bright = only_track(card_clip(dir, 30.0, {{{0.0, 0.0}, 200.0}}));
  CHECK(!bright.dark_marker);
  CHECK(worst_px(bright, {0.0, 0.0}) < 0.03);
}

TEST_CASE("the brightness of a dark marker and of what is behind it are those of the image") {
  const tests::TempDir dir;
  const std::vector<std::pair<double, double>> cards{{190.0, 20.0}, {30.0, 200.0}};
  for (const auto& [card, marker] : cards) {
    CAPTURE(card);
    const core::Experiment experiment = experiment_of(card_clip(dir, card, {{{0.0, 0.0}, marker}}), 0.0);
    const core::ImageResults results = core::tracks_of(experiment, 1, base::no_progress, core::open_frames, true);
    REQUIRE(results.tracks[0].images);
    const std::vector<core::MarkerLook>& looks = results.tracks[0].images->marker;
    REQUIRE(looks.size() >= 40);
    // The noise of a code over a hundred pixels, and the disc's edge of half a pixel: two codes.
    for (const core::MarkerLook& look : looks) {
      CHECK(std::abs(look.background - card) < 2.0);
      CHECK(std::abs(look.background + look.amplitude - marker) < 2.0);
    }
  }
}

TEST_CASE("spots that jump about are not taken for a marker") {
  const tests::TempDir dir;
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 45; ++k) {
    cv::Mat image(kSize, CV_64F, cv::Scalar(110.0));
    // On the card's path, but ahead of it or behind it by up to 20 px, as golden sections scatter.
    const double golden = std::fmod(0.618034 * k, 1.0), other = std::fmod(0.754878 * k, 1.0);
    const cv::Point2d off(40.0 * (golden - 0.5), 40.0 * (other - 0.5));
    tests::put_disc(image, place(k / kRate) + off, 6.0, 200.0);
    frames.push_back(image);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  for (const core::MarkerSearch search : {core::MarkerSearch::thorough, core::MarkerSearch::disc}) {
    CHECK_THROWS_WITH(only_track(dir / "clip.mkv", search), Catch::Matchers::Contains("jumps about"));
  }
}

TEST_CASE("of a bright and a dark disc the bright one is the marker, and of two bright ones neither") {
  const tests::TempDir dir;
  const core::TrackData both = only_track(card_clip(dir, 110.0, {{{-14.0, 0.0}, 200.0}, {{14.0, 0.0}, 20.0}}));
  CHECK(!both.dark_marker);
  CHECK(worst_px(both, {-14.0, 0.0}) < 0.03);
  const auto clip = card_clip(dir, 110.0, {{{-20.0, 0.0}, 200.0}, {{0.0, 0.0}, 20.0}, {{20.0, 0.0}, 200.0}});
  CHECK_THROWS_WITH(only_track(clip), Catch::Contains("two markers that look and move alike"));
}

namespace {

/// A ball that falls in a portrait clip: v = 20 px + 4.9 m/s² t² at 120 px/m, slightly aslant.
cv::Point2d fallen(double t) {
  return cv::Point2d(60.3 + 3.0 * t, 20.2 + 0.5 * 9.81 * 120.0 * t * t);
}

core::Experiment falling(const std::filesystem::path& clip, std::optional<core::Downhill> downhill) {
  core::Experiment experiment = experiment_of(clip, 0.0);
  experiment.scale = core::ScaleSetup{120.0, 0.0};
  experiment.marker->diameter_m = 12.0 / 120.0;
  experiment.track.downhill = downhill;
  experiment.file = "experiment.toml";
  return experiment;
}

}  // namespace

TEST_CASE("a fall in a portrait clip counts along the image's y, downwards or upwards as downhill says") {
  const tests::TempDir dir;
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 70; ++k) {
    cv::Mat image(cv::Size(120, 330), CV_64F, cv::Scalar(60.0));
    tests::put_disc(image, fallen(k / kRate), 6.0, 210.0);
    frames.push_back(image);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  const auto track_of = [&](core::Downhill downhill) {
    return core::tracks_of(falling(dir / "clip.mkv", downhill), 1).tracks.at(0);
  };
  for (const auto& [downhill, sign] : {std::pair(core::Downhill::plus_y, 1.0), {core::Downhill::minus_y, -1.0}}) {
    const core::TrackData track = track_of(downhill);
    REQUIRE(track.t_s.size() >= 65);
    double worst = 0.0;
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      const cv::Point2d gone = fallen(track.t_s[i]) - fallen(track.t_s[0]);
      worst = std::max(worst, std::abs(sign * (track.x_m[i] - track.x_m[0]) - gone.y / 120.0));
    }
    // The line's slant of 2 px over 240 is 4e-5 of the distance; noise of 1 of 150 is 0.005 px, the largest of 70.
    CHECK(worst < (0.03 + 4e-5 * 240.0) / 120.0);
  }
  CHECK_THROWS_WITH(track_of(core::Downhill::plus_x),
                    Catch::Contains("experiment.toml: downhill: found \"+X\"") && Catch::Contains("expected \"+Y\""));
}
