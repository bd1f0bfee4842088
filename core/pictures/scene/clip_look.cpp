#include "core/pictures/scene/clip_look.h"

#include <algorithm>
#include <cmath>

#include "core/math/quantile.h"
#include "core/pictures/marker/marker_search.h"

namespace glidelab::core {
namespace {

constexpr int kPixelStep = 4;              // rows, and columns, from one counted pixel to the next
constexpr std::size_t kExposureStep = 5;   // frames, from one whose exposure counts to the next
constexpr double kBrightQuantile = 0.999;  // of the pixels, the level that is called bright
constexpr std::size_t kMostPairs = 24;
// The squares of the smaller 95 % of normal numbers have 0.759 of their variance.
constexpr double kKeptOfResiduals = 0.95, kKeptVariance = 0.759;

/// Every fourth pixel, either way.
template <class Code>
cv::Mat thinned(const cv::Mat& grey) {
  cv::Mat thin((grey.rows + kPixelStep - 1) / kPixelStep, (grey.cols + kPixelStep - 1) / kPixelStep, grey.type());
  for (int row = 0; row < thin.rows; ++row) {
    const Code* from = grey.ptr<Code>(row * kPixelStep);
    Code* to = thin.ptr<Code>(row);
    for (int column = 0; column < thin.cols; ++column) to[column] = from[column * kPixelStep];
  }
  return thin;
}

/// Squared differences of two thinned frames away from the marker.
template <class Code>
void add_differences(const cv::Mat& now, const cv::Mat& before, const MarkerSighting& marker,
                     std::vector<double>& squares) {
  const double away_px = 4.0 * marker.radius_px + 30.0;
  for (int row = 0; row < now.rows; ++row) {
    if (std::abs(row * kPixelStep - marker.v_px) < away_px) continue;  // the glider moves along rows
    // Lamps that flicker change a whole row, and, with a rolling shutter, each row by a factor of its own.
    const double light = cv::sum(before.row(row))[0], light_now = cv::sum(now.row(row))[0];
    const double gain = light > 0.0 && light_now > 0.0 ? light_now / light : 1.0;
    for (int column = 0; column < now.cols; ++column) {
      const double difference = now.at<Code>(row, column) - gain * before.at<Code>(row, column);
      squares.push_back(difference * difference);
    }
  }
}

/// The frames of another source, each shown to a watch as it is read.
class WatchedFrames final : public FrameSource {
 public:
  WatchedFrames(std::unique_ptr<FrameSource> source, std::shared_ptr<ClipWatch> watch)
      : source_(std::move(source)), watch_(std::move(watch)) {}
  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (frame) {
      watch_->add(*frame);
    } else {
      watch_->end(source_->facts());
    }
    return frame;
  }
  std::size_t stated_frames() const override { return source_->stated_frames(); }
  std::vector<Note> notes() const override { return source_->notes(); }
  FileFacts facts() const override { return source_->facts(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::shared_ptr<ClipWatch> watch_;
};

}  // namespace

void ExposureWatch::add(const Frame& frame) {
  if (frame.index % kExposureStep != 0) return;
  const cv::Mat& grey = frame.grey;
  const bool narrow = grey.depth() == CV_8U;
  if (count_.empty()) count_.resize(narrow ? 256 : 65536);
  for (int row = 0; row < grey.rows; row += kPixelStep) {
    for (int column = 0; column < grey.cols; column += kPixelStep) {
      ++count_[narrow ? grey.at<std::uint8_t>(row, column) : grey.at<std::uint16_t>(row, column)];
      ++pixels_;
    }
  }
}

Exposure ExposureWatch::result() const {
  Exposure exposure;
  if (pixels_ == 0) return exposure;
  std::size_t largest = count_.size() - 1;
  while (count_[largest] == 0) --largest;
  // 8 bits are filled, whatever the camera has. Of 16 those that the camera has, unless the codes say otherwise.
  exposure.full_code = static_cast<int>(count_.size()) - 1;
  if (count_.size() > 256 && largest < std::size_t{1} << bit_depth_) exposure.full_code = (1 << bit_depth_) - 1;
  const auto all = static_cast<double>(pixels_);
  if (largest == static_cast<std::size_t>(exposure.full_code)) {
    exposure.saturated = static_cast<double>(count_[largest]) / all;
  }
  exposure.dark = static_cast<double>(count_[0]) / all;
  std::size_t code = 0, up_to = count_[0];
  while (static_cast<double>(up_to) < kBrightQuantile * all) up_to += count_[++code];
  exposure.bright_level = static_cast<double>(code) / exposure.full_code;
  return exposure;
}

FrameOpener ClipWatches::opener() {
  return [this](const std::filesystem::path& file, const CameraSettings& camera, bool with_color,
                std::optional<cv::Size> size) -> std::unique_ptr<FrameSource> {
    auto watch = std::make_shared<ClipWatch>(camera.bit_depth);
    {
      const std::lock_guard lock(mutex_);
      watches_[file] = watch;
    }
    return std::make_unique<WatchedFrames>(open_(file, camera, with_color, size), std::move(watch));
  };
}

void ClipWatch::add(const Frame& frame) {
  size_ = frame.grey.size();
  exposure_.add(frame);
  steps_.add(frame.grey);
  const bool second = !before_.empty();
  const bool first = (frame.index + 1) % every_ == 0;
  cv::Mat thin;
  if (first || second) {
    thin = frame.grey.depth() == CV_8U ? thinned<std::uint8_t>(frame.grey) : thinned<std::uint16_t>(frame.grey);
  }
  if (second) pairs_.push_back({frame.index, std::move(before_), thin});
  before_ = first ? thin : cv::Mat{};
  if (pairs_.size() <= kMostPairs) return;
  every_ *= 2;
  std::erase_if(pairs_, [this](const Pair& pair) { return pair.frame % every_ != 0; });
  if ((frame.index + 1) % every_ != 0) before_ = cv::Mat{};
}

double ClipWatch::pixel_noise(const std::vector<MarkerSighting>& sightings) const {
  std::vector<double> squares;
  for (const Pair& pair : pairs_) {
    const auto seen = std::lower_bound(sightings.begin(), sightings.end(), pair.frame,
                                       [](const MarkerSighting& s, std::size_t frame) { return s.frame < frame; });
    if (seen == sightings.end() || seen->frame != pair.frame) continue;
    if (pair.now.depth() == CV_8U) {
      add_differences<std::uint8_t>(pair.now, pair.before, *seen, squares);
    } else {
      add_differences<std::uint16_t>(pair.now, pair.before, *seen, squares);
    }
  }
  if (squares.empty()) return 0.0;
  const double limit = quantile(squares, kKeptOfResiduals);
  double sum = 0.0, count = 0.0;
  for (const double square : squares) {
    if (square > limit) continue;
    sum += square;
    count += 1.0;
  }
  return std::sqrt(0.5 * sum / count / kKeptVariance);
}

ClipLook ClipWatch::look(const MarkerSetup& marker, const std::vector<MarkerSighting>& sightings,
                         const std::vector<MarkerFit>& fits) const {
  ClipLook look;
  look.size = size_;
  look.file = facts_;
  look.exposure = exposure_.result();
  const double full = look.exposure.full_code;
  look.pixel_noise = pixel_noise(sightings) / full;
  look.block_steps = sure_block_steps(steps_.finish());
  const SignalKind kind = signal_kind(marker);
  if (kind == SignalKind::colored || fits.empty()) return look;
  std::vector<double> contrast, level;
  for (const MarkerFit& fit : fits) {
    contrast.push_back(fit.amplitude);
    level.push_back(fit.background + fit.amplitude);
  }
  look.contrast = quantile(contrast, 0.5) / full;
  if (kind == SignalKind::bright) look.marker_level = quantile(level, 0.5) / full;
  return look;
}

}  // namespace glidelab::core
