/// Clips in which the marker is not found: left out, refused, or measured like the others.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/analysis/analyze.h"
#include "core/analysis/followed_wrongly.h"
#include "core/analysis/see_clip.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

const cv::Size kSize(240, 160);
constexpr std::size_t kFrames = 60;
constexpr double kRate = 50.0, kRadius = 6.0;

/// A glider that slows down.
cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {20.4 + 4.6 * t - 0.022 * t * t, 70.3};
}

void film(const std::filesystem::path& file, bool with_marker) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    frames.emplace_back(kSize, CV_64F, cv::Scalar(60.0));
    if (with_marker) tests::put_disc(frames.back(), place(k), kRadius, 210.0);
  }
  tests::write_video(file, frames, kRate, 2.0);
}

/// A folder of one clip for each letter: with the marker ('+') or without it ('-').
std::filesystem::path folder(const std::filesystem::path& at, const std::string& clips) {
  std::filesystem::create_directories(at);
  std::ofstream toml(at / "experiment.toml");
  toml << fmt::format(
      "format = 1\nname = \"tests\"\n[camera]\nframe_rate_hz = {}\nexposure_s = 0.001\nbit_depth = 8\n"
      "[scale]\npx_per_m = 400.0\n[marker]\ndiameter_m = {}\n[track]\ndownhill = \"-X\"\n",
      kRate, 2.0 * kRadius / 400.0);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    film(at / fmt::format("{}.mkv", i), clips[i] == '+');
    toml << fmt::format(
        "[[clip]]\nname = \"clip {0}\"\nfile = \"{0}.mkv\"\nmass_kg = {1}\nincline_deg = 4.0\nlaunched = \"up\"\n", i,
        0.3 + 0.1 * static_cast<double>(i));
  }
  return at;
}

/// A track of these places in frames of a clip at kRate.
core::SeenClip seen(const std::vector<std::pair<std::size_t, cv::Point2d>>& places, std::size_t frames) {
  core::SeenClip clip;
  for (std::size_t k = 0; k < frames; ++k) clip.frame_t_s.push_back(static_cast<double>(k) / kRate);
  for (const auto& [frame, at] : places) clip.marker.sightings.push_back({frame, at.x, at.y, 0.01, kRadius});
  clip.marker.fits.resize(places.size());
  return clip;
}

/// A track by `method` that scatters by this much in both coordinates.
core::TrackedMarker scattered(core::MarkerMethod method, double scatter_px, bool as_body) {
  core::TrackedMarker marker;
  marker.method = method;
  if (as_body) marker.body = core::MarkerBody::sphere;
  for (std::size_t k = 0; k < kFrames; ++k) {
    // Golden sections scatter like independent values.
    const double one = std::fmod(0.618034 * static_cast<double>(k * k), 1.0) - 0.5,
                 other = std::fmod(0.754878 * static_cast<double>(k * k), 1.0) - 0.5;
    marker.sightings.push_back(
        {k, place(k).x + scatter_px * one, place(k).y + scatter_px * other, scatter_px, kRadius});
  }
  marker.fits.resize(kFrames);
  return marker;
}

core::SeenClip clip_of(core::TrackedMarker marker, std::shared_ptr<const core::TrackedMarker> other = {}) {
  core::SeenClip clip = seen({}, kFrames);
  clip.marker = std::move(marker);
  clip.by_other_means = std::move(other);
  return clip;
}

}  // namespace

TEST_CASE("a clip without a marker is left out with its reason, and the others are analysed") {
  const tests::TempDir temp;
  core::AnalysisOptions options;
  options.without_marker = core::WithoutMarker::left_out;
  const core::AnalysisResults results = analyze({folder(temp / "three", "+-+")}, options);
  REQUIRE(results.clips.size() == 2);
  CHECK(results.clips[0].name == "clip 0");
  CHECK(results.clips[1].name == "clip 2");
  CHECK(results.clips[1].detected > kFrames / 2);
  REQUIRE(results.configurations.size() == 2);
  CHECK(results.configurations[1].mass_kg == 0.5);
  REQUIRE(results.left_out.size() == 1);
  const core::LeftOutClip& clip = results.left_out[0];
  CHECK(clip.name == "clip 1");
  CHECK(clip.experiment == "tests");
  CHECK(clip.of == 3);
  CHECK_THAT(clip.why, Contains("1.mkv") && Contains("no marker"));
  CHECK(core::of_analysed(results, std::vector<int>{10, 11, 12}) == std::vector<int>{10, 12});
}

TEST_CASE("without any marker, and where the caller asks for all clips, it is an error") {
  const tests::TempDir temp;
  core::AnalysisOptions options;
  CHECK_THROWS_WITH(analyze({folder(temp / "one", "+-")}, options), Contains("no marker"));
  options.without_marker = core::WithoutMarker::left_out;
  CHECK_THROWS_WITH(analyze({folder(temp / "none", "--")}, options), Contains("0.mkv") && Contains("no marker"));
  // A clip that cannot be read is not one without a marker.
  const auto broken = folder(temp / "broken", "++");
  std::ofstream(broken / "1.mkv") << "no video";
  CHECK_THROWS_AS(analyze({broken}, options), base::InputError);
}

TEST_CASE("a track that does not come from start_px is refused, wherever it begins") {
  core::MarkerSetup marker;
  marker.start_px = core::PixelPoint{place(0).x, place(0).y};
  core::ClipSetup clip;
  const auto track = [](std::size_t from, const auto& at) {
    std::vector<std::pair<std::size_t, cv::Point2d>> places;
    for (std::size_t k = from; k < kFrames; ++k) places.emplace_back(k, at(k));
    return seen(places, kFrames);
  };
  CHECK_FALSE(not_from_start(track(0, place), marker, clip));
  // Lost for the first frames, or at rest and not followed there.
  CHECK_FALSE(not_from_start(track(20, place), marker, clip));
  CHECK_FALSE(not_from_start(track(40, [](std::size_t k) { return place(k - 40); }), marker, clip));
  // The scene, from the first frame on and later.
  const auto scene = [](std::size_t) { return cv::Point2d(200.0, 70.0); };
  for (const std::size_t from : {0u, 42u}) {
    const auto none = not_from_start(track(from, scene), marker, clip);
    REQUIRE(none);
    CHECK_THAT(none->what(), Contains("start_px = [20.4, 70.3]") && Contains("180 px away"));
  }
  // start_px refers to the frame at start_s.
  clip.start_s = 30.0 / kRate;
  CHECK(not_from_start(track(0, place), marker, clip));
  marker.start_px = core::PixelPoint{place(30).x, place(30).y};
  CHECK_FALSE(not_from_start(track(0, place), marker, clip));
  marker.start_px.reset();
  CHECK_FALSE(not_from_start(track(42, scene), marker, clip));
}

TEST_CASE("a track far rougher than those of the other clips is not the marker's, and one somewhat rougher is") {
  using enum core::MarkerMethod;
  const auto of = [](double scatter_px) { return clip_of(scattered(uniform, scatter_px, false)); };
  core::ClipSetup clip;
  clip.file = "u1.mkv";
  // A scatter over d px has the standard deviation d / sqrt(12): 0.9, 0.2 and 0.03 px.
  const std::vector<core::SeenClip> clips{of(0.1), of(3.0), of(0.1), of(0.7)};
  const auto refused = core::far_rougher(clips, 1, clip);
  REQUIRE(refused);
  CHECK_THAT(refused->what(), Contains("u1.mkv") && Contains("the other clips"));
  CHECK_FALSE(core::far_rougher(clips, 0, clip));
  CHECK_FALSE(core::far_rougher(clips, 3, clip));
  CHECK_FALSE(core::far_rougher({of(0.1), of(3.0)}, 1, clip));  // one other may be the one that is wrong
  CHECK_FALSE(core::far_rougher({of(3.0), of(3.0), of(3.1)}, 2, clip));
}

TEST_CASE("the clips of a marker with a hue agree on the method of most frames") {
  using Method = core::MarkerMethod;
  const auto by = [](Method method) { return clip_of(scattered(method, 0.1, false)); };
  CHECK_FALSE(core::common_method({by(Method::shaded), by(Method::shaded)}));
  CHECK(core::common_method({by(Method::centroid), by(Method::shaded), by(Method::centroid)}) == Method::centroid);
  CHECK(core::common_method({by(Method::uniform), by(Method::uniform), by(Method::centroid)}) == Method::uniform);
  // A lit body is fitted to what was found by the centroid.
  const auto centroid = std::make_shared<core::TrackedMarker>(scattered(Method::centroid, 0.1, false));
  CHECK_FALSE(core::common_method({by(Method::centroid), clip_of(scattered(Method::undecided, 0.1, true), centroid)}));
}

TEST_CASE("a marker with a hue is a lit body in all clips or in none") {
  using Method = core::MarkerMethod;
  const auto both = [](double hue_px, double lit_px) {
    auto hue = scattered(Method::centroid, hue_px, false), lit = scattered(Method::undecided, lit_px, true);
    const bool as_lit = lit_px < hue_px;
    return clip_of(as_lit ? lit : hue, std::make_shared<core::TrackedMarker>(as_lit ? hue : lit));
  };
  const auto lit_clips = [](std::vector<core::SeenClip> clips) {
    measure_alike(clips);
    return std::ranges::count_if(clips, [](const core::SeenClip& clip) { return clip.marker.body.has_value(); });
  };
  CHECK(lit_clips({both(0.4, 0.1), both(0.2, 0.3), both(0.4, 0.1)}) == 3);
  CHECK(lit_clips({both(0.2, 0.4), both(0.3, 0.2), both(0.2, 0.4)}) == 0);
  // In one of the clips there is no such body.
  CHECK(lit_clips({both(0.4, 0.1), both(0.4, 0.1), clip_of(scattered(Method::centroid, 0.4, false))}) == 0);
}
