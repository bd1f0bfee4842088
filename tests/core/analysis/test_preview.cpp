#include "core/analysis/preview.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr int kWidth = 800;
constexpr int kHeight = 600;
constexpr int kFrames = 50;

double marker_u(int frame) {
  return 50.0 + 14.0 * frame;
}

/// A folder of frames in which a white disc of 10 px radius moves to the right at half height, and what was found of
/// it.
struct MadeClip {
  explicit MadeClip(const tests::TempDir& temp, int depth, double white) {
    setup.name = result.name = "made";
    setup.file = temp / "clip";
    std::filesystem::create_directories(setup.file);
    experiment.camera.emplace();
    experiment.camera->frame_rate_hz = 240.0;
    experiment.camera->bit_depth = depth == CV_16U ? 12 : 8;
    result.frames = result.detected = kFrames;
    for (int k = 0; k < kFrames; ++k) {
      cv::Mat frame(kHeight, kWidth, CV_MAKETYPE(depth, 1), cv::Scalar(0.2 * white));
      cv::circle(frame, cv::Point(static_cast<int>(marker_u(k)), kHeight / 2), 10, cv::Scalar(white), cv::FILLED);
      cv::imwrite((setup.file / (std::to_string(1000 + k) + ".png")).string(), frame);
      result.sightings.push_back({static_cast<std::size_t>(k), marker_u(k), kHeight / 2.0, 0.02, 10.0});
    }
  }
  core::Experiment experiment;
  core::ClipSetup setup;
  core::ClipResult result;
};

cv::Mat decoded(const std::string& jpeg) {
  const std::vector<unsigned char> bytes(jpeg.begin(), jpeg.end());
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

}  // namespace

TEST_CASE("a preview shows the first, the middle and the last sighting, with the marker circled where it is") {
  const tests::TempDir temp;
  const int depth = GENERATE(CV_8U, CV_16U);
  const MadeClip clip(temp, depth, depth == CV_8U ? 255.0 : 4095.0);  // 12 bits in 16
  core::PreviewOptions no_video;
  no_video.video = false;
  const core::Preview preview = core::make_preview(clip.experiment, clip.setup, clip.result, no_video);
  CHECK(preview.mp4.empty());
  REQUIRE(preview.frames.size() == 3);
  CHECK(preview.frames[0].frame == 0);
  CHECK(preview.frames[1].frame == 24);
  CHECK(preview.frames[2].frame == 49);
  CHECK(std::abs(preview.frames[2].t_s - 49.0 / 240.0) < 1e-12);
  const cv::Mat image = decoded(preview.frames[1].jpeg);
  REQUIRE(image.cols == 400);
  REQUIRE(image.rows == 300);
  // White at the marker's place, half as far as in the clip; orange on the circle around it (radius 10/2 + 2.5 px).
  // The last path dot within the disc leaves most of it white: take a point 3 px above the centre.
  const auto at = [&](double u, double v) { return image.at<cv::Vec3b>(cv::Point(cvRound(u), cvRound(v))); };
  const double u = (marker_u(24) + 0.5) / 2.0 - 0.5;
  const double v = (kHeight / 2.0 + 0.5) / 2.0 - 0.5;
  CHECK(at(u, v - 3.0)[0] > 200);
  const cv::Vec3b circle = at(u, v - 7.5);
  CHECK(int(circle[2]) - int(circle[0]) > 60);  // more red than blue, whatever JPEG does to the colour
  CHECK(at(10.0, 10.0)[0] < 80);
}

TEST_CASE("the video of a clip is H.264 with every frame, small, and says how slow it plays") {
  const tests::TempDir temp;
  const MadeClip clip(temp, CV_8U, 255.0);
  const core::Preview preview = core::make_preview(clip.experiment, clip.setup, clip.result, {});
  if (preview.mp4.empty()) {
    REQUIRE(preview.no_video);
    CHECK_FALSE(preview.no_video->bytes);
    WARN("no H.264 encoder here: the video itself was not tested");
    return;
  }
  CHECK_FALSE(preview.no_video);
  CHECK(preview.slow_motion == 8.0);
  CHECK(preview.mp4.size() < 1'000'000);
  base::write_file(temp / "clip.mp4", preview.mp4);
  cv::VideoCapture video((temp / "clip.mp4").string(), cv::CAP_FFMPEG);
  REQUIRE(video.isOpened());
  const int code = static_cast<int>(video.get(cv::CAP_PROP_FOURCC));
  CHECK((code == cv::VideoWriter::fourcc('a', 'v', 'c', '1') || code == cv::VideoWriter::fourcc('h', '2', '6', '4')));
  int frames = 0;
  for (cv::Mat frame; video.read(frame); ++frames) {
    CHECK(frame.size() == cv::Size(400, 300));
  }
  CHECK(frames == kFrames);
}

TEST_CASE("a track has no preview, and a clip that is gone is an input error") {
  const tests::TempDir temp;
  MadeClip clip(temp, CV_8U, 255.0);
  std::filesystem::remove_all(clip.setup.file);
  CHECK_THROWS_AS(core::make_preview(clip.experiment, clip.setup, clip.result, {}), base::InputError);
  clip.setup.file.clear();
  clip.setup.track = temp / "track.csv";
  const core::Preview preview = core::make_preview(clip.experiment, clip.setup, clip.result, {});
  CHECK(preview.frames.empty());
  CHECK(preview.mp4.empty());
  CHECK_FALSE(preview.no_video);
}
