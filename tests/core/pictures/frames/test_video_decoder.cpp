#include "core/pictures/frames/video_decoder.h"

#include <cmath>
#include <cstdlib>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/permissions.h"
#include "core/pictures/frames/read_image.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::TempDir;
namespace fs = std::filesystem;

namespace {

std::vector<cv::Mat> some_frames(cv::Size size, int channels) {
  std::vector<cv::Mat> frames;
  cv::RNG random(9);
  for (int k = 0; k < 12; ++k) {
    cv::Mat frame(size, CV_64FC(channels));
    random.fill(frame, cv::RNG::UNIFORM, 0.0, 255.0);
    frames.push_back(frame);
  }
  return frames;
}

/// The message of the InputError; empty where there is none.
std::string error_of(const fs::path& file, std::size_t most_pixels = core::kMostPixels) {
  try {
    core::VideoDecoder decoder(file, most_pixels);
    while (decoder.next()) {
    }
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

/// Frame by frame as OpenCV's own reader has it.
void check_against_opencv(const fs::path& file) {
  INFO(file.filename().string());
  core::VideoDecoder decoder(file, core::kMostPixels);
  cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG);
  REQUIRE(capture.isOpened());
  CHECK(decoder.rate_hz() == capture.get(cv::CAP_PROP_FPS));
  CHECK(static_cast<double>(decoder.stated_frames()) == capture.get(cv::CAP_PROP_FRAME_COUNT));
  cv::Mat wanted;
  double first_s = 0.0, wanted_first_s = 0.0;
  int frames = 0;
  for (; capture.read(wanted); ++frames) {
    const auto got = decoder.next();
    REQUIRE(got);
    REQUIRE(got->image.size() == wanted.size());
    CHECK(cv::norm(got->image, wanted, cv::NORM_INF) == 0.0);
    const double wanted_s = capture.get(cv::CAP_PROP_POS_MSEC) * 1e-3;
    if (frames == 0) {
      first_s = got->stamp_s.value_or(0.0);
      wanted_first_s = wanted_s;
    }
    // OpenCV gives a frame without a stamp the time 0.
    if (wanted_s > 0.0) CHECK(std::abs((got->stamp_s.value() - first_s) - (wanted_s - wanted_first_s)) < 1e-9);
  }
  CHECK(frames == 12);
  CHECK_FALSE(decoder.next());
}

}  // namespace

TEST_CASE("frames, times and counts are those of OpenCV's reader, for each container and codec that people bring") {
  const TempDir dir;
  tests::write_video(dir / "grey.mkv", some_frames({96, 64}, 1), 50.0, 0.0, "FFV1");
  tests::write_video(dir / "colour.mkv", some_frames({96, 64}, 3), 50.0, 0.0, "FFV1");
  tests::write_video(dir / "colour.avi", some_frames({96, 64}, 3), 200.0, 0.0, "MJPG");
  tests::write_video(dir / "colour.mp4", some_frames({96, 64}, 3), 240.0, 0.0, "mp4v");
  for (const char* name : {"grey.mkv", "colour.mkv", "colour.avi", "colour.mp4"}) check_against_opencv(dir / name);
  CHECK(core::VideoDecoder(dir / "grey.mkv", core::kMostPixels).codec() == "FFV1");
  CHECK(core::VideoDecoder(dir / "colour.avi", core::kMostPixels).codec() == "MJPG");
}

TEST_CASE("grey of a frame without colours is the grey of its colours, bit by bit, and a coloured frame keeps them") {
  const TempDir dir;
  std::vector<cv::Mat> grey = some_frames({98, 66}, 1), equal;
  for (const cv::Mat& frame : grey) {
    cv::Mat channels;
    cv::merge(std::vector<cv::Mat>(3, frame), channels);
    equal.push_back(channels);
  }
  tests::write_video(dir / "grey.mkv", grey, 50.0, 0.0, "FFV1");    // one plane
  tests::write_video(dir / "equal.mp4", equal, 50.0, 0.0, "avc1");  // luma, and chroma that says grey
  tests::write_video(dir / "colour.mp4", some_frames({98, 66}, 3), 50.0, 0.0, "mp4v");
  for (const char* name : {"grey.mkv", "equal.mp4", "colour.mp4"}) {
    INFO(name);
    core::VideoDecoder decoder(dir / name, core::kMostPixels), by_colours(dir / name, core::kMostPixels);
    int frames = 0;
    while (const auto frame = decoder.next(true)) {
      const auto wanted = by_colours.next();
      REQUIRE(wanted);
      CHECK(wanted->image.channels() == 3);
      CHECK(frame->image.channels() == (std::string(name) == "colour.mp4" ? 3 : 1));
      CHECK(cv::norm(core::to_grey(frame->image), core::to_grey(wanted->image), cv::NORM_INF) == 0.0);
      ++frames;
    }
    CHECK(frames == 12);
  }
}

TEST_CASE("a clip that a phone filmed on its side stands upright, and its sound is passed over") {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    WARN("skipped: no ffmpeg program");
    return;
  }
  const TempDir dir;
  tests::write_video(dir / "lying.mp4", some_frames({96, 64}, 3), 50.0, 0.0, "mp4v");
  const std::string command = "ffmpeg -v error -i '" + (dir / "lying.mp4").string() +
                              "' -f lavfi -i sine=duration=0.2 -c:v copy -c:a aac -metadata:s:v:0 rotate=90 '" +
                              (dir / "turned.mov").string() + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  // ffmpeg turns frames as players do.
  REQUIRE(std::system(("ffmpeg -v error -i '" + (dir / "turned.mov").string() + "' -c:v rawvideo -pix_fmt bgr24 '" +
                       (dir / "upright.avi").string() + "'")
                          .c_str()) == 0);
  core::VideoDecoder turned(dir / "turned.mov", core::kMostPixels), upright(dir / "upright.avi", core::kMostPixels);
  int frames = 0;
  while (const auto frame = turned.next()) {
    const auto wanted = upright.next();
    REQUIRE(wanted);
    REQUIRE(frame->image.size() == cv::Size(64, 96));
    // Two conversions to colours that round differently; a frame that is turned the other way is off by 255.
    CHECK(cv::norm(frame->image, wanted->image, cv::NORM_L1) / (3.0 * 64.0 * 96.0) < 10.0);
    ++frames;
  }
  CHECK(frames == 12);
}

TEST_CASE("a playlist or a text is refused by what it is, whatever its name, and nothing that it names is opened") {
  const TempDir dir;
  tests::write_video(dir / "real.mkv", some_frames({96, 64}, 1), 50.0, 0.0, "FFV1");
  const std::string real = (dir / "real.mkv").string();
  const std::string hls =
      "#EXTM3U\n#EXT-X-TARGETDURATION:10\n#EXT-X-MEDIA-SEQUENCE:0\n#EXTINF:10,\n" + real + "\n#EXT-X-ENDLIST\n";
  const std::string concat = "ffconcat version 1.0\nfile '" + real + "'\n";
  const std::string dash =
      "<?xml version=\"1.0\"?>\n<MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" type=\"static\" "
      "mediaPresentationDuration=\"PT1S\" profiles=\"urn:mpeg:dash:profile:isoff-on-demand:2011\"><Period>"
      "<AdaptationSet mimeType=\"video/mp4\"><Representation id=\"1\" bandwidth=\"1\"><BaseURL>" +
      real + "</BaseURL></Representation></AdaptationSet></Period></MPD>\n";
  for (const std::string& text : {hls, concat, dash}) {
    for (const char* name : {"clip.m3u8", "clip.mpd", "clip.mp4", "clip.avi", "clip.ffconcat", "clip"}) {
      INFO(name << ": " << text);
      base::write_file(dir / name, text);
      CHECK_THAT(error_of(dir / name), Catch::Contains(name) && Catch::Contains("a playlist that names other files") &&
                                           Catch::Contains("expected the video itself"));
    }
  }
  base::write_file(dir / "clip.ans", "\x1b[31mHello\x1b[0m\n");
  CHECK_THAT(error_of(dir / "clip.ans"), Catch::Contains("a text"));
  base::write_file(
      dir / "clip.wav",
      std::string("RIFF\x24\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x40\x1f\0\0\x40\x1f\0\0\1\0\x08\0data\0\0\0\0", 44));
  CHECK_THAT(error_of(dir / "clip.wav"), Catch::Contains("no video"));
}

TEST_CASE(
    "a video whose frames have more pixels than permitted is refused by its header, and the limit can be raised") {
  const TempDir dir;
  tests::write_video(dir / "a.mkv", some_frames({96, 64}, 1), 50.0, 0.0, "FFV1");
  CHECK_THAT(error_of(dir / "a.mkv", 96 * 64 - 1),
             Catch::Contains("a.mkv: found 96 x 64 pixels") && Catch::Contains("--max-megapixels"));
  CHECK(error_of(dir / "a.mkv", 96 * 64) == "");
}
