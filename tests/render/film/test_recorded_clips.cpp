/// What a scenario's codec and clock make of a clip, read back by ffprobe and by the frame source that reads real
/// clips.
#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "render/film/render_experiment.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;
namespace fs = std::filesystem;

namespace {

/// A glider that is pushed along a level track before a small camera of 240 fps, for 100 slots.
std::string scenario_text(const std::string& sections) {
  return R"(format = 1
name = "clips"
[camera]
width_px = 160
height_px = 120
frame_rate_hz = 240.0
exposure_s = 0.001
focal_px = [240.0, 240.0]
[calibration]
inner_corners = [5, 4]
square_m = 0.12
views = 3
)" + tests::one_glider(0.0, 2.0, 0.0, {{"c", -0.3, 1.2, 0.414}}) +
         sections;
}

struct Recorded {
  tests::TempDir dir;
  fs::path clip;
  core::CameraSettings camera;
  base::CsvTable times;

  explicit Recorded(const std::string& sections) {
    base::write_file(dir / "scenario.toml", scenario_text(sections));
    fs::create_directories(dir / "e");
    fs::create_directories(dir / "e.truth");
    const Scenario scenario = read_scenario(dir / "scenario.toml");
    render_experiment(scenario, dir / "e", dir / "e.truth", {scenario.seed, 1});
    const core::Experiment experiment = core::read_experiment(dir / "e");
    camera = *experiment.camera;
    clip = experiment.clips.at(0).file;
    times = base::read_csv(dir / "e.truth/frames-c.csv", {"frame", "slot", "t_s", "stamp_s", "duplicate"}, {}, false);
  }
  std::size_t frames() const { return times.columns[0].size(); }
};

struct Probe {
  std::map<std::string, std::string> stream;
  std::vector<double> stamps_s;
  double rate_hz = 0.0;
};

std::vector<std::string> lines_of(const std::string& command) {
  std::vector<std::string> lines;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 400> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) {
    lines.emplace_back(line.data());
    while (!lines.back().empty() && (lines.back().back() == '\n' || lines.back().back() == ','))
      lines.back().pop_back();
  }
  CHECK(pclose(pipe) == 0);
  return lines;
}

/// One number for each frame of a clip; ffprobe also prints lines of a frame's side data, which are none.
std::vector<double> frame_numbers(const fs::path& clip, const std::string& entry) {
  std::vector<double> numbers;
  for (const std::string& line : lines_of("ffprobe -v error -select_streams v:0 -of csv=p=0 -show_entries frame=" +
                                          entry + " '" + clip.string() + "'")) {
    if (!line.empty() && std::isdigit(static_cast<unsigned char>(line[0])) != 0) numbers.push_back(std::stod(line));
  }
  return numbers;
}

Probe probe(const fs::path& clip) {
  Probe result;
  const std::string command = "ffprobe -v error -select_streams v:0 -of default=noprint_wrappers=1 ";
  for (const std::string& line :
       lines_of(command +
                "-count_frames -show_entries stream=codec_name,width,height,nb_read_frames,avg_frame_rate,"
                "pix_fmt,color_range,has_b_frames '" +
                clip.string() + "'")) {
    const std::size_t equals = line.find('=');
    result.stream[line.substr(0, equals)] = line.substr(equals + 1);
  }
  double above = 0.0, below = 1.0;
  char slash = 0;
  std::istringstream(result.stream["avg_frame_rate"]) >> above >> slash >> below;
  result.rate_hz = above / below;
  result.stamps_s = frame_numbers(clip, "pts_time");
  return result;
}

std::vector<core::Frame> frames_of(const Recorded& recorded) {
  std::vector<core::Frame> frames;
  const auto source = core::open_frames(recorded.clip, recorded.camera, false, std::nullopt);
  while (auto frame = source->next()) {
    frame->grey = frame->grey.clone();
    frames.push_back(*frame);
  }
  return frames;
}

/// Root mean square difference of the codes of all frames.
double difference(const std::vector<core::Frame>& a, const std::vector<core::Frame>& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(cv::norm(a[i].grey, b[i].grey), 2);
  return std::sqrt(sum / static_cast<double>(a.size()) / static_cast<double>(a[0].grey.total()));
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF) == 0.0;
}

}  // namespace

TEST_CASE("Every codec and container gives the frames, the rate and the codec that were asked for") {
  struct Case {
    const char* sections;
    const char* file;
    const char* codec;
    const char* pix_fmt;
  };
  const Case cases[] = {{"[codec]\nname = \"mjpeg\"\nquality = 90\n", "c.avi", "mjpeg", "gray"},
                        {"[codec]\nname = \"mjpeg\"\ncontainer = \"mkv\"\n", "c.mkv", "mjpeg", "gray"},
                        {"[codec]\nname = \"mjpeg\"\ncontainer = \"mp4\"\n", "c.mp4", "mjpeg", "gray"},
                        {"[codec]\nname = \"h264\"\ncrf = 20\n", "c.mp4", "h264", "yuv420p"},
                        {"[codec]\nname = \"h264\"\ncontainer = \"mkv\"\n", "c.mkv", "h264", "yuv420p"},
                        {"[codec]\nname = \"h264\"\nbitrate_kbit_s = 400\ngop = 20\n", "c.mp4", "h264", "yuv420p"}};
  const std::vector<core::Frame> lossless = frames_of(Recorded(""));
  REQUIRE(lossless.size() == 100);
  for (const Case& one : cases) {
    CAPTURE(one.sections);
    const Recorded recorded(one.sections);
    CHECK(recorded.clip.filename() == one.file);
    Probe probed = probe(recorded.clip);
    CHECK(probed.stream["codec_name"] == one.codec);
    CHECK(probed.stream["pix_fmt"] == one.pix_fmt);
    CHECK(probed.stream["width"] == "160");
    CHECK(probed.stream["height"] == "120");
    CHECK(probed.stream["nb_read_frames"] == "100");
    CHECK(std::abs(probed.rate_hz - 240.0) < 1e-3);
    // Within the tick of Matroska, 1 ms, or of MP4.
    for (std::size_t k = 0; k < 100; ++k) {
      REQUIRE(std::abs(probed.stamps_s.at(k) - static_cast<double>(k) / 240.0) < 0.00051);
    }
    const std::vector<core::Frame> frames = frames_of(recorded);
    REQUIRE(frames.size() == 100);
    CHECK(frames[99].t_s == 99.0 / 240.0);
    // Lossy, but the same image: noise of 1 to 2 codes is what the codecs leave out, and the range of video rounds.
    const double rms = difference(frames, lossless);
    CHECK(rms > 0.1);
    CHECK(rms < 4.0);
  }
}

TEST_CASE("Less quality costs more of the image and makes a smaller file") {
  const std::vector<core::Frame> lossless = frames_of(Recorded(""));
  const auto both = [&](const std::string& codec) {
    const Recorded recorded("[codec]\n" + codec);
    return std::pair(difference(frames_of(recorded), lossless), fs::file_size(recorded.clip));
  };
  for (const auto& [good, bad] :
       {std::pair("name = \"mjpeg\"\nquality = 95\n", "name = \"mjpeg\"\nquality = 40\n"),
        std::pair("name = \"h264\"\ncrf = 12\n", "name = \"h264\"\ncrf = 35\n"),
        std::pair("name = \"h264\"\nbitrate_kbit_s = 4000\n", "name = \"h264\"\nbitrate_kbit_s = 100\n")}) {
    CAPTURE(good, bad);
    const auto [good_rms, good_size] = both(good);
    const auto [bad_rms, bad_size] = both(bad);
    CHECK(good_rms < bad_rms);
    CHECK(good_size > bad_size);
  }
}

TEST_CASE("A bit rate is kept, and key frames come as often as the group of pictures says") {
  const Recorded recorded("[codec]\nname = \"h264\"\nbitrate_kbit_s = 300\ngop = 25\n");
  // 100 frames at 240 fps last 0.417 s: 15.6 kB at 300 kbit/s; the buffer of a second may give as much again.
  CHECK(static_cast<double>(fs::file_size(recorded.clip)) < 2.0 * 0.417 * 300e3 / 8.0 + 4000.0);
  std::set<std::size_t> keys;
  const std::vector<double> is_key = frame_numbers(recorded.clip, "key_frame");
  for (std::size_t k = 0; k < is_key.size(); ++k) {
    if (is_key[k] == 1.0) keys.insert(k);
  }
  CHECK(keys == std::set<std::size_t>{0, 25, 50, 75});
  CHECK(probe(recorded.clip).stream["has_b_frames"] == "0");
}

TEST_CASE("The same scenario makes the same file with every codec") {
  for (const std::string codec :
       {"name = \"mjpeg\"\n", "name = \"h264\"\n", "name = \"h264\"\nbitrate_kbit_s = 300\n"}) {
    const Recorded a("[codec]\n" + codec), b("[codec]\n" + codec);
    CHECK(base::read_file(a.clip) == base::read_file(b.clip));
  }
}

TEST_CASE("Dropped frames are missing from the file, and duplicated ones show the image before, as the truth says") {
  const Recorded recorded("[clock]\ndropped_fraction = 0.1\nduplicated_fraction = 0.1\n");
  const Recorded whole("");
  const std::vector<core::Frame> frames = frames_of(recorded);
  const std::vector<core::Frame> all = frames_of(whole);
  REQUIRE(whole.frames() == 100);
  REQUIRE(frames.size() == recorded.frames());
  CHECK(frames.size() < 98);
  const std::vector<double>& slot = recorded.times.column("slot");
  const std::vector<double>& duplicate = recorded.times.column("duplicate");
  std::size_t duplicates = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    CHECK(frames[k].t_s == static_cast<double>(k) / 240.0);  // later ones have moved up
    if (duplicate[k] == 0.0) {
      REQUIRE(same(frames[k].grey, all[static_cast<std::size_t>(slot[k])].grey));
      CHECK(recorded.times.column("t_s")[k] == slot[k] / 240.0);
    } else {
      REQUIRE(same(frames[k].grey, frames[k - 1].grey));
      CHECK(recorded.times.column("t_s")[k] == recorded.times.column("t_s")[k - 1]);
      ++duplicates;
    }
  }
  CHECK(duplicates > 2);
  const auto truth = nlohmann::json::parse(base::read_file(recorded.dir / "e.truth/truth.json"));
  CHECK(truth["clips"][0]["frames"] == recorded.frames());
  const base::CsvTable trajectory = base::read_csv(recorded.dir / "e.truth/trajectory-c.csv", {"t_s", "x_m"}, {}, true);
  CHECK(trajectory.columns[0].size() == recorded.frames());
}

TEST_CASE("A variable rate is written as real time stamps, which the frame source reads") {
  struct Case {
    const char* codec;
    double tick_s;
  };
  for (const Case& one :
       {Case{"name = \"h264\"\n", 1.0 / 90e3}, Case{"name = \"magicyuv\"\n", 1e-3}, Case{"name = \"ffv1\"\n", 1e-3},
        Case{"name = \"mjpeg\"\ncontainer = \"mp4\"\n", 1.0 / 90e3}}) {
    CAPTURE(one.codec);
    const Recorded recorded(fmt::format(
        "[codec]\n{}[clock]\nvariable = true\njitter_s = 2e-4\nrate_error_ppm = 300.0\ndropped_fraction = 0.1\n",
        one.codec));
    CHECK(recorded.camera.time == core::TimeSource::container);
    CHECK(recorded.camera.frame_rate_hz == 240.0);
    const std::vector<double>& stamps = recorded.times.column("stamp_s");
    const std::vector<double> probed = probe(recorded.clip).stamps_s;
    const std::vector<core::Frame> frames = frames_of(recorded);
    // A tick of the clock is no rate: 90000 a second are not told.
    const auto source = core::open_frames(recorded.clip, recorded.camera, false, std::nullopt);
    while (source->next()) {
    }
    CHECK(source->facts().container_rate_hz.value_or(240.0) < 300.0);
    REQUIRE(probed.size() == stamps.size());
    REQUIRE(frames.size() == stamps.size());
    for (std::size_t k = 0; k < stamps.size(); ++k) {
      // Rounded to MPEG's clock, then to the container's.
      const double rounding_s = 0.5 * one.tick_s + 0.5 / 90e3 + 1e-6;
      REQUIRE(std::abs(probed[k] - stamps[k]) <= rounding_s);
      REQUIRE(std::abs(frames[k].t_s - stamps[k]) <= rounding_s);
      // The camera's clock runs 300 ppm fast: what it calls t is t / 1.0003.
      REQUIRE(std::abs(recorded.times.column("t_s")[k] - stamps[k] / 1.0003) < 1e-9);
    }
  }
}

TEST_CASE("Clocks and codecs that make no sense are refused by their keys") {
  const tests::TempDir dir;
  const auto message = [&](const std::string& sections) -> std::string {
    base::write_file(dir / "scenario.toml", scenario_text(sections));
    try {
      read_scenario(dir / "scenario.toml");
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  CHECK_THAT(message("[clock]\njitter_s = 0.001\n"), Catch::Contains("clock.jitter_s") && Catch::Contains("overlap"));
  CHECK_THAT(message("[clock]\nvariable = true\n[codec]\nname = \"raw\"\n"), Catch::Contains("clock.variable"));
  CHECK_THAT(message("[clock]\nstamp_tick_s = 0.001\n"), Catch::Contains("stamp_tick_s"));
  CHECK_THAT(message("[clock]\ndropped_fraction = 0.6\nduplicated_fraction = 0.5\n"), Catch::Contains("a tenth"));
  CHECK_THAT(message("[codec]\nname = \"h264\"\ncrf = 20\nbitrate_kbit_s = 500\n"), Catch::Contains("one of the two"));
  CHECK_THAT(message("[codec]\nname = \"h264\"\nquality = 20\n"), Catch::Contains("unknown key"));
  CHECK_THAT(message("[codec]\nname = \"ffv1\"\ncontainer = \"mp4\"\n"), Catch::Contains("codec.container"));
  CHECK_THAT(message("[codec]\nname = \"mjpeg\"\nquality = 0\n"), Catch::Contains("codec.quality"));
  CHECK(message("[codec]\nname = \"h264\"\n[clock]\nvariable = true\nstamp_tick_s = 0.0016666666667\n") == "nothing");
}
