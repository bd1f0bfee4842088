#include "core/analysis/preview.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/result/results.h"
#include "core/track/bare_track.h"

namespace glidelab::core {
namespace {

namespace fs = std::filesystem;

constexpr double kPlaybackHz = 30.0;         // a rate that every screen and player supports
constexpr std::size_t kMostFrames = 360;     // 12 s of it
constexpr std::size_t kMostBytes = 1 << 20;  // small enough for a page to hold a few
constexpr std::size_t kPathDots = 60;
const cv::Scalar kMarkerColor(0, 140, 255);  // orange in BGR: visible on black, grey and white
const cv::Scalar kPathColor(255, 170, 60);   // light blue

/// Small images in colour, of even size as H.264's 4:2:0 needs.
class Shrinker {
 public:
  Shrinker(cv::Size size, int width_px, int bit_depth) : bit_depth_(bit_depth) {
    scale_ = std::min(1.0, static_cast<double>(width_px) / size.width);
    const auto even = [this](int length) {
      return std::max(2, 2 * static_cast<int>(std::lround(length * scale_ / 2)));
    };
    size_ = {even(size.width), even(size.height)};
  }
  cv::Mat operator()(const Frame& frame) const {
    cv::Mat image = frame.color.empty() ? frame.grey : frame.color;
    if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 255.0 / ((1 << bit_depth_) - 1));
    cv::Mat small;
    cv::resize(image, small, size_, 0.0, 0.0, cv::INTER_AREA);
    if (small.channels() == 1) cv::cvtColor(small, small, cv::COLOR_GRAY2BGR);
    return small;
  }
  /// A position in the image, in sixteenths of a pixel of the small image; centres of first pixels are (0, 0) in both.
  cv::Point place(double u_px, double v_px) const {
    const auto fixed = [this](double p) { return static_cast<int>(std::lround(((p + 0.5) * scale_ - 0.5) * 16.0)); };
    return {fixed(u_px), fixed(v_px)};
  }
  double scale() const { return scale_; }
  cv::Size size() const { return size_; }

 private:
  int bit_depth_;
  double scale_ = 1.0;
  cv::Size size_;
};

void circle_marker(cv::Mat& image, const MarkerSighting& sighting, const Shrinker& shrink) {
  const double radius = std::max(sighting.radius_px * shrink.scale() + 2.5, 5.0);
  cv::circle(image, shrink.place(sighting.u_px, sighting.v_px), static_cast<int>(std::lround(radius * 16.0)),
             kMarkerColor, 1, cv::LINE_AA, 4);
}

void dot_path(cv::Mat& image, const std::vector<MarkerSighting>& sightings, const Shrinker& shrink) {
  const std::size_t step = std::max<std::size_t>(1, sightings.size() / kPathDots);
  for (std::size_t i = 0; i < sightings.size(); i += step) {
    cv::circle(image, shrink.place(sightings[i].u_px, sightings[i].v_px), 16, kPathColor, cv::FILLED, cv::LINE_AA, 4);
  }
}

std::string jpeg_of(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 88});
  return {bytes.begin(), bytes.end()};
}

/// The sightings whose frames are shown: spread evenly from the first to the last.
std::vector<std::size_t> frames_to_show(const std::vector<MarkerSighting>& sightings, int count) {
  std::vector<std::size_t> frames;
  if (sightings.empty() || count <= 0) return frames;
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = n == 1 ? 0 : i * (sightings.size() - 1) / (n - 1);
    if (frames.empty() || sightings[at].frame != frames.back()) frames.push_back(sightings[at].frame);
  }
  return frames;
}

/// Encodes the frames given to it; whether a browser-playable encoder exists shows at the first frame.
class VideoFile {
 public:
  void add(const cv::Mat& image) {
    if (failed_) return;
    if (!writer_.isOpened()) {
      const int h264 = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
      failed_ = !writer_.open(file().string(), cv::CAP_FFMPEG, h264, kPlaybackHz, image.size());
      if (failed_) return;
    }
    writer_.write(image);
  }
  /// The file's bytes, or the reason why there are none.
  std::pair<std::string, std::optional<NoVideo>> finish() {
    writer_.release();
    std::error_code error;
    const auto size = fs::file_size(file(), error);
    if (failed_ || error || size == 0) return {"", NoVideo{}};
    if (size > kMostBytes) return {"", NoVideo{size}};
    return {base::read_file(file()), std::nullopt};
  }

 private:
  fs::path file() const { return folder_ / "clip.mp4"; }
  base::TemporaryFolder folder_{"preview"};
  cv::VideoWriter writer_;
  bool failed_ = false;
};

const MarkerSighting* sighting_of(const std::vector<MarkerSighting>& sightings, std::size_t frame) {
  const auto found = std::lower_bound(sightings.begin(), sightings.end(), frame,
                                      [](const MarkerSighting& s, std::size_t f) { return s.frame < f; });
  return found != sightings.end() && found->frame == frame ? &*found : nullptr;
}

}  // namespace

Preview make_preview(const Experiment& experiment, const ClipSetup& setup, const ClipResult& result,
                     const PreviewOptions& options) {
  Preview preview;
  if (setup.file.empty() || !experiment.camera) return preview;
  const std::vector<std::size_t> shown = frames_to_show(result.sightings, options.frames);
  if (shown.empty() && !options.video) return preview;
  const std::unique_ptr<FrameSource> source = open_frames(setup.file, *experiment.camera, true, std::nullopt);
  const std::size_t step = std::max<std::size_t>(1, (result.frames + kMostFrames - 1) / kMostFrames);
  std::optional<Shrinker> shrink;
  std::optional<VideoFile> video;
  if (options.video) video.emplace();
  std::size_t next_shown = 0;
  while (std::optional<Frame> frame = source->next()) {
    const bool show = next_shown < shown.size() && frame->index == shown[next_shown];
    const bool film = video && frame->index % step == 0;
    if (!show && !film) continue;
    if (!shrink) shrink.emplace(frame->grey.size(), options.width_px, experiment.camera->bit_depth);
    cv::Mat image = (*shrink)(*frame);
    if (const MarkerSighting* sighting = sighting_of(result.sightings, frame->index)) {
      circle_marker(image, *sighting, *shrink);
    }
    if (film) video->add(image);
    if (show) {
      dot_path(image, result.sightings, *shrink);
      preview.frames.push_back({frame->index, frame->t_s, jpeg_of(image)});
      ++next_shown;
    }
    if (!video && next_shown == shown.size()) break;
  }
  if (video) {
    std::tie(preview.mp4, preview.no_video) = video->finish();
    preview.slow_motion = experiment.camera->frame_rate_hz / (kPlaybackHz * static_cast<double>(step));
  }
  return preview;
}

namespace {

constexpr int kVideos = 2;  // more would make the page heavy

}  // namespace

std::vector<Preview> previews_of(const std::vector<std::filesystem::path>& folders, const AnalysisResults& results,
                                 const base::Progress& progress, const TrackFileOptions& bare) {
  std::vector<Preview> previews;
  int videos = 0;
  std::size_t place = 0;
  for (const std::filesystem::path& folder : folders) {
    const Experiment experiment = read_tracks(folder, bare);
    for (const ClipSetup& setup : experiment.clips) {
      if (std::ranges::count(results.left_out, place++, &LeftOutClip::place) > 0) continue;
      if (!setup.file.empty())
        progress("preparing images", static_cast<double>(previews.size()) / static_cast<double>(results.clips.size()));
      PreviewOptions options;
      options.video = !setup.file.empty() && videos < kVideos;
      if (options.video) ++videos;
      if (!options.video) options.frames = 1;
      previews.push_back(make_preview(experiment, setup, results.clips.at(previews.size()), options));
    }
  }
  return previews;
}

}  // namespace glidelab::core
