#include "core/pictures/frames/frame_source.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/file_names.h"
#include "core/pictures/frames/read_image.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::TempDir;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFrames = 40;
constexpr double kRate = 200.0;

std::vector<cv::Mat> some_frames(cv::Size size = {96, 64}, int type = CV_64F) {
  std::vector<cv::Mat> frames;
  cv::RNG random(9);
  for (std::size_t k = 0; k < kFrames; ++k) {
    cv::Mat frame(size, type);
    random.fill(frame, cv::RNG::UNIFORM, 0.0, 255.0);
    frames.push_back(frame);
  }
  return frames;
}

core::CameraSettings camera(core::TimeSource time = core::TimeSource::rate) {
  core::CameraSettings settings;
  settings.frame_rate_hz = kRate;
  settings.time = time;
  return settings;
}

std::size_t count_frames(const fs::path& path, std::optional<cv::Size> size = std::nullopt) {
  const auto source = core::open_frames(path, camera(), false, size);
  std::size_t count = 0;
  while (source->next()) ++count;
  return count;
}

/// The error's message; empty where there is none.
std::string error_of(const fs::path& path, std::optional<cv::Size> size = std::nullopt) {
  try {
    count_frames(path, size);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void truncate_to(const fs::path& path, double share) {
  fs::resize_file(path, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(path))));
}

}  // namespace

TEST_CASE("an 8-bit grey FFV1 clip comes out bit by bit, frame k at k over the rate") {
  const TempDir dir;
  const auto frames = some_frames();
  tests::write_video(dir / "a.mkv", frames, kRate, 0.0);
  const auto source = core::open_frames(dir / "a.mkv", camera(), false, std::nullopt);
  CHECK(source->stated_frames() == kFrames);
  for (std::size_t k = 0; k < kFrames; ++k) {
    const auto frame = source->next();
    REQUIRE(frame);
    REQUIRE(frame->grey.type() == CV_8U);
    CHECK(cv::norm(frame->grey, tests::expose(frames[k], 0.0, 1), cv::NORM_INF) == 0.0);
    CHECK(frame->color.empty());
    CHECK(frame->index == k);
    CHECK(frame->t_s == static_cast<double>(k) / kRate);
  }
  CHECK_FALSE(source->next());
  CHECK_FALSE(source->next());
  CHECK(source->notes().empty());
}

TEST_CASE("a clip in colour keeps its colours where they are asked for") {
  const TempDir dir;
  const auto frames = some_frames({96, 64}, CV_64FC3);
  tests::write_video(dir / "a.avi", frames, kRate, 0.0, "MJPG");
  const auto with = core::open_frames(dir / "a.avi", camera(), true, std::nullopt);
  const auto without = core::open_frames(dir / "a.avi", camera(), false, std::nullopt);
  CHECK(with->next()->color.type() == CV_8UC3);
  CHECK(without->next()->color.empty());
}

TEST_CASE("a folder of 16-bit frames comes out bit by bit in the order that people number files") {
  const TempDir dir;
  const fs::path folder = dir / "frames";
  fs::create_directories(folder);
  for (const int k : {10, 2, 1, 9, 0}) {
    cv::imwrite((folder / (std::to_string(k) + ".png")).string(), cv::Mat(8, 12, CV_16U, cv::Scalar(4000 + k)));
  }
  base::write_file(folder / ".hidden", "x");
  base::write_file(folder / "notes.txt", "x");
  const auto source = core::open_frames(folder, camera(), false, std::nullopt);
  CHECK(source->stated_frames() == 5);
  for (const int k : {0, 1, 2, 9, 10}) {
    const auto frame = source->next();
    REQUIRE(frame);
    REQUIRE(frame->grey.type() == CV_16U);
    CHECK(frame->grey.at<std::uint16_t>(3, 3) == 4000 + k);
  }
  CHECK_FALSE(source->next());
  const std::vector<core::Note> notes = source->notes();
  REQUIRE(notes.size() == 1);
  const auto* const skipped = tests::note_of<core::FilesSkipped>(notes);
  REQUIRE(skipped != nullptr);
  CHECK(skipped->files == 1);
}

TEST_CASE("names are ordered as people number files") {
  CHECK(core::natural_less("2.png", "10.png"));
  CHECK_FALSE(core::natural_less("10.png", "2.png"));
  CHECK(core::natural_less("a9b", "a10a"));
  CHECK(core::natural_less("000009", "000010"));
  CHECK_FALSE(core::natural_less("a", "a"));
  CHECK(core::natural_less("a1", "a1b"));
}

TEST_CASE("a container that plays at another rate is noted, and the stated rate counts") {
  const TempDir dir;
  tests::write_video(dir / "a.mkv", some_frames(), 29.97, 0.0);
  const auto source = core::open_frames(dir / "a.mkv", camera(), false, std::nullopt);
  source->next();
  CHECK(source->next()->t_s == 1.0 / kRate);
  while (source->next()) {
  }
  const std::vector<core::Note> notes = source->notes();
  REQUIRE(notes.size() == 1);
  const auto* const other = tests::note_of<core::ContainerOfOtherRate>(notes);
  REQUIRE(other != nullptr);
  CHECK(other->container_hz == Approx(29.97).epsilon(1e-3));  // a fraction of whole numbers
  CHECK(other->stated_hz == 200.0);
  CHECK(other->by_rate);
}

TEST_CASE("the container's time stamps count where that is asked") {
  const TempDir dir;
  tests::write_video(dir / "a.mkv", some_frames(), 50.0, 0.0);
  const auto source = core::open_frames(dir / "a.mkv", camera(core::TimeSource::container), false, std::nullopt);
  source->next();
  const auto second = source->next();
  // Matroska keeps milliseconds: 20 ms exactly.
  CHECK(std::abs(second->t_s - 0.020) < 1e-9);
  const fs::path folder = dir / "frames";
  tests::write_folder(folder, some_frames(), 0.0, CV_8U);
  CHECK_THROWS_WITH(core::open_frames(folder, camera(core::TimeSource::container), false, std::nullopt),
                    Catch::Contains("no time stamps"));
}

TEST_CASE("frames that are written twice are reported, and frames that are not are not") {
  const TempDir dir;
  std::vector<cv::Mat> frames = some_frames();
  frames[7] = frames[6];
  frames[20] = frames[19];
  frames[21] = frames[19];
  tests::write_video(dir / "a.mkv", frames, kRate, 0.0);
  const auto source = core::open_frames(dir / "a.mkv", camera(), false, std::nullopt);
  while (source->next()) {
  }
  REQUIRE(source->notes().size() == 1);
  const std::vector<core::Note> notes = source->notes();
  const auto* const repeated = tests::note_of<core::RepeatedFrames>(notes);
  REQUIRE(repeated != nullptr);
  CHECK(repeated->repeated == 3);
  CHECK(repeated->frames == 40);
}

TEST_CASE("stamps with dropped frames give their own times, and are reported") {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    WARN("skipped: no ffmpeg program");
    return;
  }
  const TempDir dir;
  tests::write_video(dir / "whole.mkv", some_frames(), 50.0, 0.0);
  // Frames 10 and 11, and 25, are taken out; the others keep their stamps.
  const std::string command = "ffmpeg -v error -i '" + (dir / "whole.mkv").string() +
                              "' -vf \"select='not(between(n,10,11)+eq(n,25))'\" -vsync vfr -c:v ffv1 '" +
                              (dir / "dropped.mkv").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  core::CameraSettings settings = camera(core::TimeSource::container);
  settings.frame_rate_hz = 50.0;
  const auto source = core::open_frames(dir / "dropped.mkv", settings, false, std::nullopt);
  std::vector<double> times;
  while (const auto frame = source->next()) times.push_back(frame->t_s);
  REQUIRE(times.size() >= kFrames - 4);  // the last one may come without a stamp
  double expected = 0.0;
  for (std::size_t k = 0, n = 0; k < times.size(); ++k, ++n) {
    if (n == 10) n = 12;
    if (n == 25) n = 26;
    expected = static_cast<double>(n) / 50.0;
    CHECK(std::abs(times[k] - expected) < 1.1e-3);  // Matroska's millisecond
  }
  const std::vector<core::Note> notes = source->notes();
  const auto* const irregular = tests::note_of<core::IrregularStamps>(notes);
  REQUIRE(irregular != nullptr);
  CHECK(irregular->irregular == 2);
  CHECK(irregular->steps == times.size() - 1);
  CHECK(std::abs(irregular->median_step_s - 0.020) < 1.1e-3);  // Matroska's millisecond
  CHECK(std::abs(irregular->longest_step_s - 0.060) < 1.1e-3);
  CHECK_FALSE(irregular->by_rate);
}

TEST_CASE("clips that cannot be used are errors that name the file and the frame") {
  const TempDir dir;
  tests::write_video(dir / "whole.mkv", some_frames(), kRate, 0.0);
  REQUIRE(count_frames(dir / "whole.mkv") == kFrames);

  fs::copy_file(dir / "whole.mkv", dir / "cut.mkv");
  truncate_to(dir / "cut.mkv", 0.6);
  CHECK(contains(error_of(dir / "cut.mkv"), "cut.mkv: frame 2"));  // 60 % of 40 frames, give or take a few
  CHECK(contains(error_of(dir / "cut.mkv"), "truncated"));

  base::write_file(dir / "empty.mkv", "");
  CHECK(contains(error_of(dir / "empty.mkv"), "empty.mkv: found an empty file"));
  base::write_file(dir / "text.mkv", "this is a text, not a video\n");
  CHECK(contains(error_of(dir / "text.mkv"), "text.mkv: found no video"));
  CHECK(contains(error_of(dir / "none.mkv"), "none.mkv: found no file"));
  CHECK(contains(error_of(dir / "whole.mkv", cv::Size(800, 600)),
                 "whole.mkv: frame 0: found 96 x 64 pixels, expected 800 x 600"));

  fs::create_directories(dir / "nothing");
  CHECK(contains(error_of(dir / "nothing"), "nothing: found a folder without images"));
  const fs::path folder = dir / "frames";
  tests::write_folder(folder, some_frames(), 0.0, CV_8U);
  REQUIRE(count_frames(folder) == kFrames);
  cv::imwrite((folder / "000020.png").string(), cv::Mat(64, 90, CV_8U, cv::Scalar(1)));
  CHECK(contains(error_of(folder), "frame 20: found 90 x 64 pixels"));
  base::write_file(folder / "000010.png", "no picture");
  CHECK(contains(error_of(folder), "000010.png: found no image"));
}

TEST_CASE("a clip that lacks one or two of the frames its container says is accepted") {
  // Containers count the last frames differently; the limit is two frames or 1 %.
  const TempDir dir;
  tests::write_video(dir / "a.mkv", some_frames(), kRate, 0.0);
  const auto whole = static_cast<double>(fs::file_size(dir / "a.mkv"));
  // The index at the end (cues) is a few hundred bytes; one frame is about 6 kB.
  truncate_to(dir / "a.mkv", 1.0 - 7000.0 / whole);
  CHECK(count_frames(dir / "a.mkv") >= kFrames - 2);
}

TEST_CASE("grey of three equal channels is exactly their value") {
  cv::Mat image(16, 16, CV_8UC3);
  for (int i = 0; i < 256; ++i) image.at<cv::Vec3b>(i / 16, i % 16) = cv::Vec3b::all(static_cast<uchar>(i));
  const cv::Mat grey = core::to_grey(image);
  for (int i = 0; i < 256; ++i) CHECK(grey.at<uchar>(i / 16, i % 16) == i);
}

TEST_CASE("a time stamp of the container that is far off is an error that names its frame, where the stamps count") {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    WARN("skipped: no ffmpeg program");
    return;
  }
  const TempDir dir;
  tests::write_video(dir / "whole.mkv", some_frames(), 50.0, 0.0);
  const std::string command = "ffmpeg -v error -i '" + (dir / "whole.mkv").string() +
                              "' -vf \"setpts=PTS+gte(N\\,20)*1000000/TB\" -vsync vfr -c:v ffv1 '" +
                              (dir / "far.mkv").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  const auto read = [&](core::TimeSource time) {
    core::CameraSettings settings = camera(time);
    settings.frame_rate_hz = 50.0;
    const auto source = core::open_frames(dir / "far.mkv", settings, false, std::nullopt);
    while (source->next()) {
    }
  };
  // 20 ms apart, so that 2000 s are the most.
  CHECK_THROWS_WITH(read(core::TimeSource::container), Catch::Contains("far.mkv: frame 20: found a time stamp of") &&
                                                           Catch::Contains("expected one at most 2000 s after it"));
  CHECK_NOTHROW(read(core::TimeSource::rate));
}
