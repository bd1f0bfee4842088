/// Files from a stranger that would make a reader open other files, ask the network, fill the memory or work without an
/// end: each is refused with one message and status 1, soon, and nothing is left.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr double kRate = 100.0;

std::string experiment_with(const std::string& clip, const std::string& scale) {
  return "format = 1\nname = \"from elsewhere\"\n[camera]\nframe_rate_hz = 100\nexposure_s = 0.001\n" + scale +
         "[marker]\ndiameter_m = 0.08\n[track]\ndownhill = \"+X\"\n[[clip]]\nname = \"one\"\nfile = \"" + clip +
         "\"\nmass_kg = 0.3\nincline_deg = 3.0\nlaunched = \"released\"\n";
}

const std::string kScale = "[scale]\npx_per_m = 200\n";
const std::string kPattern =
    "[calibration]\npattern = \"chessboard\"\ninner_corners = [9, 6]\nsquare_m = 0.03\nviews = \"views/*.png\"\nplane "
    "= \"views/a.png\"\n";

/// A bright disc that slides to the right, ever faster.
void write_clip(const fs::path& file) {
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 60; ++k) {
    const double t_s = k / kRate;
    frames.emplace_back(64, 240, CV_64F, cv::Scalar(40.0));
    tests::put_disc(frames.back(), {20.0 + 60.0 * t_s + 0.5 * 600.0 * t_s * t_s, 31.7}, 8.0, 200.0);
  }
  tests::write_video(file, frames, kRate);
}

void write_bytes_at(const fs::path& file, std::size_t at, const std::string& bytes) {
  base::write_file(file, base::read_file(file).replace(at, bytes.size(), bytes));
}

tests::ProcessResult analyse(const fs::path& folder, const std::string& name) {
  return tests::glidelab({"analyze", name, "-q", "--json", "--out", "out"}, folder);
}

}  // namespace

TEST_CASE("hostile clips and images end with one message and status 1, soon, and leave nothing") {
  constexpr double kMostSeconds = 60.0;  // each takes less than one; a busy machine takes its time
  const tests::TempDir temp;
  write_clip(temp / "elsewhere.mkv");
  const std::string other = (temp / "elsewhere.mkv").string();
  const std::string hls =
      "#EXTM3U\n#EXT-X-TARGETDURATION:10\n#EXT-X-MEDIA-SEQUENCE:0\n#EXTINF:10,\n" + other + "\n";  // and has no end
  const std::string dash =
      "<?xml version=\"1.0\"?>\n<MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" type=\"static\" "
      "mediaPresentationDuration=\"PT1S\" "
      "profiles=\"urn:mpeg:dash:profile:isoff-on-demand:2011\"><Period><AdaptationSet "
      "mimeType=\"video/mp4\"><Representation id=\"1\" "
      "bandwidth=\"1\"><BaseURL>" +
      other + "</BaseURL></Representation></AdaptationSet></Period></MPD>\n";
  const std::string concat = "ffconcat version 1.0\nfile '" + other + "'\n";
  const std::string playlist = "a playlist that names other files";

  struct Case {
    std::string clip, text, says;
  };
  for (const Case& hostile : std::vector<Case>{{"clip.m3u8", hls, playlist},
                                               {"clip.mp4", hls, playlist},
                                               {"clip.avi", hls, playlist},
                                               {"clip.mkv", hls, playlist},
                                               {"clip.mpd", dash, playlist},
                                               {"clip.mov", dash, playlist},
                                               {"clip.txt", concat, playlist},
                                               {"clip.mpg", concat, playlist},
                                               {"clip.ans", "\x1b[31mHello\x1b[0m\n", "a text"}}) {
    INFO(hostile.clip << ": " << hostile.text);
    const fs::path folder = temp / "hostile";
    fs::create_directories(folder);
    base::write_file(folder / hostile.clip, hostile.text);
    base::write_file(folder / "experiment.toml", experiment_with(hostile.clip, kScale));
    const auto start = std::chrono::steady_clock::now();
    const tests::ProcessResult result = analyse(temp.path(), "hostile");
    INFO(result.err);
    CHECK(result.status == 1);
    CHECK_THAT(result.err, Catch::Contains(hostile.clip) && Catch::Contains(hostile.says));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(temp / "out"));
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < kMostSeconds);
    fs::remove_all(folder);
  }

  // A frame, and a view of the pattern, that state more than they hold: 30,000 pixels each way, 16 bits and colour.
  for (const bool pattern : {false, true}) {
    INFO((pattern ? "a view of the pattern" : "a frame"));
    const fs::path folder = temp / "images";
    fs::create_directories(folder / (pattern ? "views" : "clip"));
    const fs::path image = folder / (pattern ? "views/a.png" : "clip/a.png");
    cv::imwrite(image.string(), cv::Mat(4, 4, CV_16UC3, cv::Scalar::all(9)));
    // Width, height, depth, colour, and the check sum of it all.
    write_bytes_at(image, 16, std::string("\0\0\x75\x30\0\0\x75\x30\x10\x02\0\0\0\xB9\xD5\xB3\xAE", 17));
    if (pattern) write_clip(folder / "clip.mkv");
    base::write_file(folder / "experiment.toml",
                     experiment_with(pattern ? "clip.mkv" : "clip", pattern ? kPattern : kScale));
    const auto start = std::chrono::steady_clock::now();
    for (const char* command : {"analyze", "diagnose"}) {
      const tests::ProcessResult result = tests::glidelab({command, "images", "-q", "--out", "out"}, temp.path());
      INFO(command << ": " << result.err);
      CHECK(result.status == 1);
      CHECK_THAT(result.err, Catch::Contains("a.png: found 30000 x 30000 pixels, 900 megapixels, expected at most 100 "
                                             "megapixels (--max-megapixels permits more)"));
      CHECK_FALSE(fs::exists(temp / "out"));
    }
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < kMostSeconds);
    fs::remove_all(folder);
  }
}

TEST_CASE("a named pipe in place of a text file is refused, not waited for") {
  const tests::TempDir temp;
  fs::create_directories(temp / "folder");
  REQUIRE(::mkfifo((temp / "folder/experiment.toml").c_str(), 0600) == 0);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"analyze", "folder"}, {"simulate", "folder/experiment.toml"}}) {
    std::vector<std::string> words = command;
    words.insert(words.end(), {"-q", "--out", "out"});
    const tests::ProcessResult result = tests::glidelab(words, temp.path());
    CHECK(result.status == 1);
    CHECK_THAT(result.err, Catch::Contains("experiment.toml: found a named pipe"));
    CHECK_FALSE(fs::exists(temp / "out"));
  }
}

TEST_CASE("a clip whose name is longer than a file's is analysed") {
  const tests::TempDir temp;
  fs::create_directories(temp / "long");
  std::string track = "t_s,x_m\n";
  for (int i = 0; i < 120; ++i)
    track += fmt::format("{:.3f},{:.6f}\n", 0.01 * i, 0.5 * 0.01 * i + 0.1 * std::sin(0.1 * i));
  base::write_file(temp / "long/track.csv", track);
  const std::string name(300, 'n');
  base::write_file(
      temp / "long/experiment.toml",
      fmt::format(
          "format = 1\nname = \"long\"\n[[clip]]\nname = \"{}\"\ntrack = \"track.csv\"\nmass_kg = 0.3\nincline_deg = "
          "2.0\n"
          "launched = \"down\"\n[[clip]]\nname = \"{}2\"\ntrack = \"track.csv\"\nmass_kg = 0.3\nincline_deg = 2.0\n"
          "launched = \"down\"\n",
          name, name));
  const tests::ProcessResult result = tests::glidelab({"analyze", "long", "-q", "--out", "out"}, temp.path());
  INFO(result.err);
  CHECK(result.status == 0);
  CHECK(fs::exists(temp / "out" / fmt::format("phase-{}.csv", name.substr(0, 100))));
  CHECK(fs::exists(temp / "out" / fmt::format("phase-{}-2.csv", name.substr(0, 100))));  // the other, cut alike
}

TEST_CASE("a table of thousands of unknown columns gets a page of errors, not thousands") {
  const tests::TempDir temp;
  std::string header = "a";
  for (int i = 0; i < 50'000; ++i) header += fmt::format(",c{}", i);
  base::write_file(temp / "wide.csv", header + "\n" + std::string(100'000, ','));
  const tests::ProcessResult result = tests::glidelab({"analyze", "wide.csv", "-q", "--out", "out"}, temp.path());
  CHECK(result.status == 1);
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') <= 21);
  CHECK(result.err.size() < 4000);
}

TEST_CASE("an image that takes a thousand times as much as its file is read within the limit alone") {
  const tests::TempDir temp;
  fs::create_directories(temp / "bomb/clip");
  for (const char* name : {"bomb/clip/0.png", "bomb/clip/1.png"}) {
    cv::imwrite((temp / name).string(), cv::Mat(3000, 3000, CV_8U, cv::Scalar(0)));
  }
  REQUIRE(fs::file_size(temp / "bomb/clip/0.png") < 30'000);
  base::write_file(temp / "bomb/experiment.toml", experiment_with("clip", kScale));
  const auto with = [&](const char* limit) {
    return tests::glidelab({"analyze", "bomb", "-q", "--max-megapixels", limit, "--out", "out"}, temp.path());
  };
  const tests::ProcessResult refused = with("8.9");
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, Catch::Contains("0.png: found 3000 x 3000 pixels, 9 megapixels, expected at most 8.9"));
  const tests::ProcessResult read = with("9");  // nothing moves there
  CHECK(read.status == 1);
  CHECK_THAT(read.err, !Catch::Contains("megapixels"));
  CHECK(with("nan").status == 2);
  CHECK(with("0").status == 2);
}

TEST_CASE("a folder whose name looks like a protocol's or a pattern's is a folder") {
  const tests::TempDir temp;
  fs::create_directories(temp / "plain");
  write_clip(temp / "plain/clip%02d.mkv");
  base::write_file(temp / "plain/experiment.toml", experiment_with("clip%02d.mkv", kScale));
  const tests::ProcessResult plain = analyse(temp.path(), "plain");
  INFO(plain.err);
  REQUIRE(plain.status == 0);
  fs::remove_all(temp / "out");
  for (const char* name : {"a:b", "2024-01-01T12:30", "http:", "concat:x|y", "file:", "%03d", "[ab]*?"}) {
    INFO(name);
    fs::copy(temp / "plain", temp / name);
    const tests::ProcessResult result = analyse(temp.path(), name);
    INFO(result.err);
    CHECK(result.status == 0);
    CHECK(result.out == plain.out);
    fs::remove_all(temp / "out");
  }
}
