#include "core/pictures/frames/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "base/errors.h"
#include "core/experiment/file_names.h"
#include "core/math/quantile.h"
#include "core/math/time_gap.h"
#include "core/pictures/frames/read_image.h"
#include "core/pictures/frames/video_decoder.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

std::string show(cv::Size size) {
  return fmt::format("{} x {} pixels", size.width, size.height);
}

}  // namespace

void fail_frames(const fs::path& file, std::string key, std::string found, std::string expected) {
  throw base::InputError(base::Issue{file.string(), 0, std::move(key), std::move(found), std::move(expected)});
}

void SizeCheck::operator()(const cv::Mat& frame, std::size_t index, const fs::path& file) {
  if (!size_) size_ = frame.size();
  if (frame.size() == *size_) return;
  fail_frames(file, fmt::format("frame {}", index), show(frame.size()),
              show(*size_) + (given_ ? ", as the views of the pattern" : ", as the frames before"));
}

void RepeatCounter::operator()(const cv::Mat& grey) {
  if (!before_.empty() && same_bits(grey)) ++repeated_;
  before_ = grey;
  ++count_;
}

void RepeatCounter::tell(std::vector<Note>& notes) const {
  if (repeated_ == 0) return;
  notes.emplace_back(RepeatedFrames{repeated_, count_});
}

bool RepeatCounter::same_bits(const cv::Mat& grey) const {
  if (grey.size() != before_.size() || grey.type() != before_.type()) return false;
  const std::size_t bytes = static_cast<std::size_t>(grey.cols) * grey.elemSize();
  for (int row = 0; row < grey.rows; ++row) {
    if (std::memcmp(grey.ptr(row), before_.ptr(row), bytes) != 0) return false;
  }
  return true;
}

Frame make_frame(const cv::Mat& image, bool with_color, std::size_t index) {
  Frame frame;
  frame.index = index;
  frame.grey = to_grey(image);
  if (!with_color || image.channels() == 1) return frame;
  if (image.depth() == CV_8U) {
    frame.color = image;
  } else {
    image.convertTo(frame.color, CV_8U, 1.0 / 256.0);
  }
  return frame;
}

namespace fs = std::filesystem;

namespace {

class FolderFrames final : public FrameSource {
 public:
  FolderFrames(const fs::path& folder, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)
      : camera_(camera), with_color_(with_color), check_size_(size) {
    static const std::set<std::string> kImageEndings{".png", ".tif", ".tiff", ".pgm", ".bmp", ".jpg", ".jpeg"};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with('.') || !entry.is_regular_file()) continue;
      if (kImageEndings.contains(lower_extension(entry.path()))) {
        files_.push_back(entry.path());
      } else {
        ++others_;
      }
    }
    if (files_.empty()) fail_frames(folder, "", "a folder without images", "a folder of frames (PNG, in order)");
    if (camera.time == TimeSource::container) {
      fail_frames(folder, "", "a folder of frames, which has no time stamps",
                  "a video, or time = \"rate\" in [camera] of experiment.toml");
    }
    std::sort(files_.begin(), files_.end(),
              [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
  }

  std::optional<Frame> next() override {
    if (count_ == files_.size()) return std::nullopt;
    const cv::Mat image = read_image(files_[count_], camera_.most_pixels);
    check_size_(image, count_, files_[count_]);
    Frame frame = make_frame(image, with_color_, count_);
    frame.t_s = static_cast<double>(count_) / camera_.frame_rate_hz;
    ++count_;
    return frame;
  }

  std::size_t stated_frames() const override { return files_.size(); }

  std::vector<Note> notes() const override {
    if (others_ == 0) return {};
    return {FilesSkipped{others_}};
  }

 private:
  CameraSettings camera_;
  bool with_color_;
  SizeCheck check_size_;
  std::vector<fs::path> files_;
  std::size_t others_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_frame_folder(const fs::path& folder, const CameraSettings& camera, bool with_color,
                                               std::optional<cv::Size> size) {
  return std::make_unique<FolderFrames>(folder, camera, with_color, size);
}

namespace fs = std::filesystem;

namespace {

// Matroska rounds stamps to 1 ms, so that a regular clip's steps differ by up to that.
constexpr double kStampRounding_s = 1.05e-3;

/// From the four letters of the container; empty for others.
std::optional<bool> is_lossy(const std::string& letters) {
  const std::string codec = lower(letters);
  static const std::set<std::string> kLossy{"mjpg", "h264", "avc1", "x264", "hevc", "hvc1", "hev1", "vp80",
                                            "vp90", "vp09", "av01", "mp4v", "fmp4", "xvid", "divx", "mpg1",
                                            "mpg2", "apcn", "apch", "apcs", "ap4h", "wmv3", "dvsd"};
  static const std::set<std::string> kLossless{"ffv1", "m8g0", "m8rg", "m8ra", "m8y0", "m8y2", "m8y4", "m8ya",
                                               "i420", "yv12", "y800", "grey", "hfyu", "ffvh", "ulrg", "uly0",
                                               "uly2", "dib ", "raw ", "bgr0", "rgb0", "bgra", "yuy2"};
  if (kLossy.contains(codec)) return true;
  if (kLossless.contains(codec)) return false;
  return std::nullopt;
}

/// Whether a lossy codec predicts images from earlier ones; the others code each image by itself.
std::optional<bool> does_predict(const std::string& letters) {
  static const std::set<std::string> kEachByItself{"mjpg", "apcn", "apch", "apcs", "ap4h", "dvsd"};
  const std::optional<bool> lossy = is_lossy(letters);
  if (!lossy) return std::nullopt;
  return *lossy && !kEachByItself.contains(lower(letters));
}

class VideoFrames final : public FrameSource {
 public:
  VideoFrames(const fs::path& file, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)
      : file_(file), camera_(camera), with_color_(with_color), check_size_(size) {
    std::error_code error;
    if (fs::file_size(file, error) == 0) fail_frames(file, "", "an empty file", "a video");
    decoder_ = std::make_unique<VideoDecoder>(file, camera.most_pixels);
    stated_ = decoder_->stated_frames();
    stated_rate_hz_ = decoder_->rate_hz();
  }

  std::optional<Frame> next() override {
    if (ended_) return std::nullopt;
    const auto decoded = decoder_->next(!with_color_);
    if (!decoded) {
      ended_ = true;
      check_length();
      return std::nullopt;
    }
    check_size_(decoded->image, count_, file_);
    Frame frame = make_frame(decoded->image, with_color_, count_);
    repeats_(frame.grey);
    const double stamp_s = decoded->stamp_s.value_or(0.0);
    if (count_ == 0) first_stamp_s_ = stamp_s;
    if (count_ > 0 && !decoded->stamp_s) {
      ++unstamped_;
      if (camera_.time == TimeSource::container) {
        ended_ = true;
        check_length();
        return std::nullopt;
      }
    } else {
      look_at_stamp(stamp_s - first_stamp_s_);
    }
    frame.t_s = camera_.time == TimeSource::container ? stamp_s - first_stamp_s_
                                                      : static_cast<double>(count_) / camera_.frame_rate_hz;
    ++count_;
    return frame;
  }

  std::size_t stated_frames() const override { return stated_; }

  std::vector<Note> notes() const override {
    std::vector<Note> notes;
    if (stated_rate_hz_ > 0.0 && std::abs(stated_rate_hz_ / camera_.frame_rate_hz - 1.0) > kRateRounding) {
      notes.emplace_back(
          ContainerOfOtherRate{stated_rate_hz_, camera_.frame_rate_hz, camera_.time == TimeSource::rate});
    }
    if (unstamped_ > 0 && camera_.time == TimeSource::container) {
      notes.emplace_back(LastFramesUnstamped{});
    }
    repeats_.tell(notes);
    if (irregular_ > 0) {
      notes.emplace_back(IrregularStamps{irregular_, stamps_s_.size() - 1, median_step_s_, longest_step_s_,
                                         camera_.time == TimeSource::rate});
    }
    return notes;
  }

  FileFacts facts() const override {
    FileFacts facts;
    facts.codec = decoder_->codec();
    facts.lossy = is_lossy(facts.codec);
    facts.predicts = does_predict(facts.codec);
    if (stated_rate_hz_ > 0.0) facts.container_rate_hz = stated_rate_hz_;
    facts.stamps_missing = missing_;
    facts.irregular_steps = irregular_;
    facts.repeated = repeats_.repeated();
    facts.drift_frames = drift_frames_;
    return facts;
  }

 private:
  void check_length() {
    if (count_ == 0) fail_frames(file_, "", "no frame", "a clip with frames");
    // Where the container tells its length and not its number of frames, frames that were dropped are in the stated
    // number; the last stamp then shows that the clip is whole.
    const double by_stamps = stamps_s_.empty() ? 0.0 : stamps_s_.back() * stated_rate_hz_ + 1.0;
    const double missing = static_cast<double>(stated_) - std::max(static_cast<double>(count_), by_stamps) -
                           static_cast<double>(unstamped_);
    if (missing > std::max(2.0, 0.01 * static_cast<double>(stated_))) {
      fail_frames(file_, fmt::format("frame {}", count_), fmt::format("the end of the clip after {} frames", count_),
                  fmt::format("{} frames, as the container says (is the file truncated?)", stated_));
    }
    if (camera_.time == TimeSource::container) check_gaps();
    find_irregular_steps();
  }

  void check_gaps() const {
    const std::optional<TimeGap> gap = too_long_gap(stamps_s_);
    if (!gap) return;
    fail_frames(
        file_, fmt::format("frame {}", gap->after),
        fmt::format("a time stamp of {:.6g} s, {:.6g} s after that of the frame before", stamps_s_[gap->after],
                    gap->gap_s),
        fmt::format("one at most {:.6g} s after it, {:.0f} times the median step", gap->longest_s, kLongestGapSteps));
  }

  void look_at_stamp(double stamp_s) {
    if (!stamps_s_.empty() && camera_.time == TimeSource::container && stamp_s <= stamps_s_.back()) {
      fail_frames(file_, fmt::format("frame {}", count_), fmt::format("a time stamp of {:.6g} s", stamp_s),
                  fmt::format("one after that of the frame before, {:.6g} s", stamps_s_.back()));
    }
    stamps_s_.push_back(stamp_s);
  }

  void find_irregular_steps() {
    std::vector<double> steps;
    for (std::size_t i = 1; i < stamps_s_.size(); ++i) steps.push_back(stamps_s_[i] - stamps_s_[i - 1]);
    if (steps.size() < 2) return;
    median_step_s_ = median_of(steps);
    longest_step_s_ = *std::max_element(steps.begin(), steps.end());
    if (longest_step_s_ <= 0.0) return;  // a container without stamps
    const double tolerance_s = std::max(kStampRounding_s, 0.05 * median_step_s_);
    for (const double step : steps) {
      const double slots = step / median_step_s_;
      // Whole frame times, as a slot that was left out makes them; a camera that films slower makes any.
      if (slots > 1.5 && std::abs(slots - std::round(slots)) < 0.1 + kStampRounding_s / median_step_s_) {
        missing_ += static_cast<std::size_t>(std::lround(slots)) - 1;
      }
    }
    irregular_ = static_cast<std::size_t>(std::count_if(
        steps.begin(), steps.end(), [&](double step) { return std::abs(step - median_step_s_) > tolerance_s; }));
    find_drift();
  }

  /// The residuals of the stamps about a straight line; a rate that is merely played slowly leaves none.
  void find_drift() {
    const double n = static_cast<double>(stamps_s_.size());
    double sum = 0.0, moment = 0.0;
    for (std::size_t k = 0; k < stamps_s_.size(); ++k) {
      const double place = static_cast<double>(k) - 0.5 * (n - 1.0);
      sum += stamps_s_[k];
      moment += place * stamps_s_[k];
    }
    const double step_s = 12.0 * moment / (n * (n * n - 1.0));
    if (step_s <= 0.0) return;
    for (std::size_t k = 0; k < stamps_s_.size(); ++k) {
      const double place = static_cast<double>(k) - 0.5 * (n - 1.0);
      drift_frames_ = std::max(drift_frames_, std::abs(stamps_s_[k] - sum / n - step_s * place) / step_s);
    }
  }

  fs::path file_;
  CameraSettings camera_;
  bool with_color_;
  SizeCheck check_size_;
  std::unique_ptr<VideoDecoder> decoder_;
  std::size_t stated_ = 0;
  double stated_rate_hz_ = 0.0;
  std::size_t count_ = 0;
  bool ended_ = false;
  double first_stamp_s_ = 0.0;
  std::vector<double> stamps_s_;
  RepeatCounter repeats_;
  std::size_t unstamped_ = 0;
  std::size_t irregular_ = 0;
  std::size_t missing_ = 0;
  double median_step_s_ = 0.0;
  double longest_step_s_ = 0.0;
  double drift_frames_ = 0.0;
};

}  // namespace

std::unique_ptr<FrameSource> open_video(const fs::path& file, const CameraSettings& camera, bool with_color,
                                        std::optional<cv::Size> size) {
  return std::make_unique<VideoFrames>(file, camera, with_color, size);
}

namespace fs = std::filesystem;

std::unique_ptr<FrameSource> open_frames(const fs::path& file, const CameraSettings& camera, bool with_color,
                                         std::optional<cv::Size> size) {
  silence_opencv();
  std::error_code error;
  if (fs::is_directory(file, error)) return open_frame_folder(file, camera, with_color, size);
  if (!fs::is_regular_file(file, error)) fail_frames(file, "", "no file", "a video or a folder of frames");
  return open_video(file, camera, with_color, size);
}

}  // namespace glidelab::core
