#include "validate/film/film_studio.h"

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "core/analysis/analyze.h"
#include "render/film/render_experiment.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

// A glider that crosses a small image once in each direction, on a slope that brings it back.
const std::string kScenario = R"(
format = 1
name = "small"
[camera]
width_px = 320
height_px = 200
frame_rate_hz = 200.0
exposure_s = 0.001
focal_px = [480.0, 480.0]
position_m = [0.0, 0.05, 2.0]
distortion = { k1 = -0.08 }
[calibration]
inner_corners = [7, 4]
square_m = 0.05
views = 6
[marker]
diameter_m = 0.04
)" + tests::one_glider(3.0, 1.5, 0.006, {{"m1-up", 0.4, -0.9, 1.2}, {"m1-down", -0.4, 0.5, 1.0}});

}  // namespace

TEST_CASE("Frames in memory are those of the lossless file, and an analysis of them gives the same to the last bit") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", kScenario);
  const render::Scenario scenario = render::read_scenario(dir / "s.toml");
  std::filesystem::create_directories(dir / "e");
  std::filesystem::create_directories(dir / "e.truth");
  render::render_experiment(scenario, dir / "e", dir / "e.truth", {.seed = 4, .jobs = 2});
  const auto set = std::make_shared<const render::ClipSet>(scenario, 2);

  const core::Experiment experiment = core::read_experiment(dir / "e");
  const auto file = core::open_frames(experiment.clips[0].file, *experiment.camera, false, std::nullopt);
  const auto memory = validate::rendered_frames(set, 0, 4);
  CHECK(memory->stated_frames() == file->stated_frames());
  std::size_t frames = 0;
  while (const auto from_file = file->next()) {
    const auto from_memory = memory->next();
    REQUIRE(from_memory);
    CHECK(from_memory->index == from_file->index);
    CHECK(from_memory->t_s == from_file->t_s);
    REQUIRE(from_memory->grey.size() == from_file->grey.size());
    CHECK(cv::countNonZero(from_memory->grey != from_file->grey) == 0);
    ++frames;
  }
  CHECK_FALSE(memory->next());
  CHECK(frames == set->frames(0, 4));

  core::AnalysisOptions options;
  options.jobs = 2;
  const core::AnalysisResults by_file = core::analyze({dir / "e"}, options);
  // The clips' files are gone but for their names.
  for (const core::ClipSetup& clip : experiment.clips) base::write_file(clip.file, "");
  options.open = validate::rendered_opener(set, 4);
  const core::AnalysisResults by_memory = core::analyze({dir / "e"}, options);
  REQUIRE(by_memory.clips.size() == by_file.clips.size());
  for (std::size_t i = 0; i < by_file.clips.size(); ++i) {
    const core::ClipResult& a = by_file.clips[i];
    const core::ClipResult& b = by_memory.clips[i];
    CHECK(a.detected == b.detected);
    REQUIRE(a.motion.size() == b.motion.size());
    for (std::size_t k = 0; k < a.motion.size(); ++k) {
      CHECK(a.motion[k].t_s == b.motion[k].t_s);
      CHECK(a.motion[k].measured_m == b.motion[k].measured_m);
      CHECK(a.motion[k].a_m_s2 == b.motion[k].a_m_s2);
    }
    REQUIRE(a.segments.size() == b.segments.size());
    for (std::size_t k = 0; k < a.segments.size(); ++k) {
      CHECK(a.segments[k].k_over_m_1_s.value == b.segments[k].k_over_m_1_s.value);
    }
  }
  // A file of which the scenario knows nothing.
  CHECK_THROWS_AS(options.open(dir / "other.mkv", *experiment.camera, false, std::nullopt), base::InputError);
}

TEST_CASE("a frame in parts holds what was looked at, as in the whole frame, also when later frames were given") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", kScenario);
  const auto set = std::make_shared<const render::ClipSet>(render::read_scenario(dir / "s.toml"), 2);
  const auto whole = validate::rendered_frames(set, 0, 4), parts = validate::rendered_frames(set, 0, 4);
  std::vector<core::Frame> expected, partial;
  for (int k = 0; k < 12; ++k) {
    expected.push_back(*whole->next());
    partial.push_back(*parts->next_in_parts());
    CHECK_FALSE(expected.back().draw);
    REQUIRE(partial.back().draw);
  }
  const cv::Rect all(0, 0, 320, 200);
  for (const cv::Rect& part : {cv::Rect(100, 60, 41, 33), cv::Rect(310, 190, 10, 10), cv::Rect(120, 70, 60, 60), all}) {
    for (std::size_t k = partial.size(); k-- > 0;) {
      partial[k].draw(part);
      CHECK(cv::countNonZero(partial[k].grey(part) != expected[k].grey(part)) == 0);
      // Nobody looked at this corner yet: it was not drawn.
      if (part != all) CHECK(cv::countNonZero(partial[k].grey(cv::Rect(0, 0, 64, 48))) == 0);
    }
  }
}

TEST_CASE("frames in memory are refused where the codec would change them") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml", kScenario + "\n[codec]\nname = \"mjpeg\"\n");
  const auto set = std::make_shared<const render::ClipSet>(render::read_scenario(dir / "scenario.toml"), 2);
  CHECK_THROWS_AS(validate::rendered_frames(set, 0, 1), base::InputError);
}

TEST_CASE("the frames of a clip are the same on canvases that another clip was drawn on") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", kScenario);
  const auto set = std::make_shared<const render::ClipSet>(render::read_scenario(dir / "s.toml"), 2);
  const auto pool = std::make_shared<validate::CanvasPool>();
  for (const std::uint64_t seed : {4u, 5u}) {
    const auto fresh = validate::rendered_frames(set, 0, seed),
               used = validate::rendered_frames(set, 0, seed, false, pool);
    const cv::Rect part(100, 60, 41, 33);
    for (int k = 0; k < 6; ++k) {
      const core::Frame expected = *fresh->next_in_parts(), frame = *used->next_in_parts();
      expected.draw(part);
      frame.draw(k % 2 == 0 ? part : cv::Rect(0, 0, 320, 200));
      CHECK(cv::countNonZero(frame.grey(part) != expected.grey(part)) == 0);
      if (k % 2 == 0) CHECK(cv::countNonZero(frame.grey != expected.grey) == 0);
    }
  }
}
