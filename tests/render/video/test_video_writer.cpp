#include "render/video/video_writer.h"

#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "base/errors.h"
#include "render/random/random_numbers.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

/// Frames of noise, which no predictor can guess.
template <typename Code>
std::vector<Code> noise_frame(int width, int height, std::uint32_t number, Code most) {
  std::vector<Code> frame(static_cast<std::size_t>(width) * height);
  for (std::size_t i = 0; i < frame.size(); ++i) {
    frame[i] = static_cast<Code>(philox({static_cast<std::uint32_t>(i), number, 0, 9}, {1, 2})[0] % (most + 1u));
  }
  return frame;
}

/// Lets files grow to so many bytes only, and lets writes fail instead of ending the process.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

void write_noise(const std::filesystem::path& path, const VideoFormat& format, std::uint32_t frames) {
  const auto writer = open_video(path, format);
  for (std::uint32_t k = 0; k < frames; ++k) {
    const auto frame = noise_frame<std::uint8_t>(format.width, format.height, k, 255);
    writer->write(std::span<const std::uint8_t>(frame));
  }
  writer->finish();
}

}  // namespace

TEST_CASE("Clips of 8 bits read back bit for bit, with their number of frames and their rate") {
  const tests::TempDir dir;
  for (const Codec codec : {Codec::magicyuv, Codec::ffv1, Codec::raw}) {
    for (const auto& [width, height] : {std::pair{160, 120}, {161, 121}, {98, 34}}) {
      for (const double rate : {200.0, 240.0, 29.97}) {
        const VideoFormat format{codec, width, height, rate, 1};
        const auto path = dir / file_name_of(codec, "clip");
        write_noise(path, format, 25);
        cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
        CAPTURE(path.string(), width, height, rate);
        REQUIRE(capture.isOpened());
        CHECK(std::abs(capture.get(cv::CAP_PROP_FPS) - rate) < 1e-4 * rate);
        cv::Mat frame;
        int count = 0;
        while (capture.read(frame)) {
          REQUIRE(frame.cols == width);
          REQUIRE(frame.rows == height);
          cv::Mat grey;
          cv::extractChannel(frame, grey, 0);
          const auto expected = noise_frame<std::uint8_t>(width, height, static_cast<std::uint32_t>(count), 255);
          const cv::Mat wanted(height, width, CV_8U, const_cast<std::uint8_t*>(expected.data()));
          REQUIRE(cv::norm(grey, wanted, cv::NORM_INF) == 0.0);
          // Matroska's stamps have a tick of 1 ms.
          CHECK(std::abs(capture.get(cv::CAP_PROP_POS_MSEC) - 1000.0 * count / rate) <= 0.6);
          ++count;
        }
        CHECK(count == 25);
      }
    }
  }
}

TEST_CASE("Frames of more than 8 bits are a folder of 16-bit images in order") {
  const tests::TempDir dir;
  const VideoFormat format{Codec::png, 70, 40, 100.0, 1};
  const auto writer = open_video(dir / "clip", format);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const auto frame = noise_frame<std::uint16_t>(70, 40, k, 4095);
    writer->write(std::span<const std::uint16_t>(frame));
  }
  writer->finish();
  for (std::uint32_t k = 0; k < 3; ++k) {
    const cv::Mat read =
        cv::imread((dir / "clip" / ("00000" + std::to_string(k) + ".png")).string(), cv::IMREAD_UNCHANGED);
    REQUIRE(read.type() == CV_16U);
    const auto expected = noise_frame<std::uint16_t>(70, 40, k, 4095);
    CHECK(cv::norm(read, cv::Mat(40, 70, CV_16U, const_cast<std::uint16_t*>(expected.data())), cv::NORM_INF) == 0.0);
  }
  CHECK_FALSE(std::filesystem::exists(dir / "clip" / "000003.png"));
}

TEST_CASE("The same frames make the same file") {
  const tests::TempDir dir;
  for (const Codec codec : {Codec::magicyuv, Codec::ffv1, Codec::raw}) {
    const VideoFormat format{codec, 64, 48, 200.0, 1};
    write_noise(dir / "a", format, 5);
    write_noise(dir / "b", format, 5);
    std::ifstream a(dir / "a", std::ios::binary), b(dir / "b", std::ios::binary);
    CHECK(std::string(std::istreambuf_iterator<char>(a), {}) == std::string(std::istreambuf_iterator<char>(b), {}));
  }
}

TEST_CASE("A full disk is an error that names the file") {
  const tests::TempDir dir;
  for (const Codec codec : {Codec::magicyuv, Codec::ffv1, Codec::raw, Codec::png}) {
    // Room for the header and a frame or two; at the very end only the trailer may not fit.
    for (const rlim_t bytes : {rlim_t{300}, rlim_t{30'000}, rlim_t{150'000}}) {
      const auto path = dir / file_name_of(codec, "full");
      const FileSizeLimit limit(codec == Codec::png ? bytes / 20 : bytes);
      bool named = false;
      try {
        write_noise(path, {codec, 160, 120, 200.0, 1}, 20);
      } catch (const base::EnvironmentError& error) {
        named = std::string(error.what()).find("full") != std::string::npos;
      }
      CAPTURE(path.string(), bytes);
      CHECK(named);
    }
  }
}

TEST_CASE("A place that cannot be written is an error that names it") {
  const tests::TempDir dir;
  for (const Codec codec : {Codec::magicyuv, Codec::ffv1, Codec::raw}) {
    const auto path = dir / "no-such-folder" / "clip";
    CHECK_THROWS_WITH(open_video(path, {codec, 64, 48, 200.0, 1}), Catch::Contains(path.string()));
    CHECK_THROWS_AS(open_video(path, {codec, 64, 48, 200.0, 1}), base::EnvironmentError);
  }
  CHECK_THROWS_AS(write_png(dir / "no-such-folder" / "a.png", cv::Mat::zeros(4, 4, CV_8U)), base::EnvironmentError);
  std::ofstream(dir / "file") << "x";
  CHECK_THROWS_AS(open_video(dir / "file" / "clip", {Codec::png, 64, 48, 200.0, 1}), base::EnvironmentError);
}
