#include "core/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <set>

#include "base/errors.h"
#include "core/picture.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& file, std::string key, std::string found, std::string expected) {
  throw base::InputError(base::Issue{file.string(), 0, std::move(key), std::move(found), std::move(expected)});
}

std::string show(cv::Size size) {
  return fmt::format("{} x {} pixels", size.width, size.height);
}

/// All frames measure the same, and what was asked for.
class SizeCheck {
 public:
  explicit SizeCheck(std::optional<cv::Size> size) : size_(size), given_(size) {}
  void operator()(const cv::Mat& frame, std::size_t index, const fs::path& file) {
    if (!size_) size_ = frame.size();
    if (frame.size() == *size_) return;
    fail(file, fmt::format("frame {}", index), show(frame.size()),
         show(*size_) + (given_ ? ", as the pattern's views" : ", as the frames before"));
  }

 private:
  std::optional<cv::Size> size_;
  bool given_;
};

/// Counts frames that are the picture before them once more, bit by bit: noise does not repeat itself.
class RepeatCounter {
 public:
  void operator()(const cv::Mat& grey) {
    if (!before_.empty() && same_bits(grey)) ++repeated_;
    before_ = grey;
    ++count_;
  }
  std::size_t repeated() const { return repeated_; }
  void tell(std::vector<std::string>& notes) const {
    if (repeated_ == 0) return;
    notes.push_back(fmt::format(
        "{} of {} frames are the very picture before them once more: duplicates (a camera or converter that "
        "repeats frames), or a scene at rest without any noise",
        repeated_, count_));
  }

 private:
  bool same_bits(const cv::Mat& grey) const {
    if (grey.size() != before_.size() || grey.type() != before_.type()) return false;
    const std::size_t bytes = static_cast<std::size_t>(grey.cols) * grey.elemSize();
    for (int row = 0; row < grey.rows; ++row) {
      if (std::memcmp(grey.ptr(row), before_.ptr(row), bytes) != 0) return false;
    }
    return true;
  }

  cv::Mat before_;
  std::size_t repeated_ = 0;
  std::size_t count_ = 0;
};

/// By the four letters that FFmpeg gives; nothing for others.
std::optional<bool> is_lossy(std::string codec) {
  std::transform(codec.begin(), codec.end(), codec.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::set<std::string> kLossy{"mjpg", "h264", "avc1", "x264", "hevc", "hvc1", "hev1", "vp80",
                                            "vp90", "vp09", "av01", "mp4v", "fmp4", "xvid", "divx", "mpg1",
                                            "mpg2", "apcn", "apch", "apcs", "ap4h", "wmv3", "dvsd"};
  static const std::set<std::string> kLossless{"ffv1", "i420", "yv12", "y800", "grey", "huffyuv",
                                               "hfyu", "ffvh", "ulrg", "uly0", "uly2", "dib ",
                                               "raw ", "bgr0", "rgb0", "bgra", "yuy2"};
  if (kLossy.contains(codec)) return true;
  if (kLossless.contains(codec)) return false;
  return std::nullopt;
}

Frame make_frame(const cv::Mat& picture, bool with_color, std::size_t index) {
  Frame frame;
  frame.index = index;
  frame.grey = to_grey(picture);
  if (!with_color || picture.channels() == 1) return frame;
  if (picture.depth() == CV_8U) {
    frame.color = picture;
  } else {
    picture.convertTo(frame.color, CV_8U, 1.0 / 256.0);
  }
  return frame;
}

class VideoFrames final : public FrameSource {
 public:
  VideoFrames(const fs::path& file, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)
      : file_(file), camera_(camera), with_color_(with_color), check_size_(size) {
    std::error_code error;
    if (fs::file_size(file, error) == 0) fail(file, "", "an empty file", "a video");
    if (!capture_.open(file.string(), cv::CAP_FFMPEG)) fail(file, "", "no video that can be opened", "a video");
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (count > 0.0 && count < 1e9) stated_ = static_cast<std::size_t>(std::lround(count));
    stated_rate_hz_ = capture_.get(cv::CAP_PROP_FPS);
  }

  std::optional<Frame> next() override {
    if (ended_) return std::nullopt;
    cv::Mat picture;
    if (!read(picture)) {
      ended_ = true;
      check_length();
      return std::nullopt;
    }
    check_size_(picture, count_, file_);
    Frame frame = make_frame(picture, with_color_, count_);
    repeats_(frame.grey);
    const double stamp_s = capture_.get(cv::CAP_PROP_POS_MSEC) * 1e-3;
    if (count_ == 0) first_stamp_s_ = stamp_s;
    // OpenCV says 0 of a frame without a stamp: the last ones of a clip, which it gets by emptying the decoder.
    if (count_ > 0 && stamp_s == 0.0) {
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

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    // Rates are stated rounded (239.76 as 240), 0.1 %; what is further off plays at another speed than it was filmed.
    if (stated_rate_hz_ > 0.0 && std::abs(stated_rate_hz_ / camera_.frame_rate_hz - 1.0) > 1.5e-3) {
      notes.push_back(fmt::format(
          "the container says {:.6g} frames per second, the experiment {:.6g}; {}", stated_rate_hz_,
          camera_.frame_rate_hz,
          camera_.time == TimeSource::rate ? "the stated rate counts" : "the container's stamps count, as asked"));
    }
    if (unstamped_ > 0 && camera_.time == TimeSource::container) {
      notes.emplace_back("the last frames have no time stamp and are left out");
    }
    repeats_.tell(notes);
    if (irregular_ > 0) {
      notes.push_back(fmt::format(
          "the container's time stamps are irregular: {} of {} steps differ from the median step of {:.4g} ms, the "
          "longest is {:.4g} ms{}",
          irregular_, stamps_s_.size() - 1, median_step_s_ * 1e3, longest_step_s_ * 1e3,
          camera_.time == TimeSource::rate ? " (frames may be missing; the stated rate counts)" : ""));
    }
    return notes;
  }

  FileFacts facts() const override {
    FileFacts facts;
    const auto letters = static_cast<unsigned>(std::lround(capture_.get(cv::CAP_PROP_FOURCC)));
    for (unsigned shift = 0; shift < 32; shift += 8) facts.codec.push_back(static_cast<char>(letters >> shift & 255U));
    facts.lossy = is_lossy(facts.codec);
    if (stated_rate_hz_ > 0.0) facts.container_rate_hz = stated_rate_hz_;
    facts.stamps_missing = missing_;
    facts.irregular_steps = irregular_;
    facts.repeated = repeats_.repeated();
    facts.drift_frames = drift_frames_;
    return facts;
  }

 private:
  bool read(cv::Mat& picture) {  // as cv::VideoCapture wants it
    try {
      return capture_.read(picture) && !picture.empty();
    } catch (const cv::Exception& exception) {
      fail(file_, fmt::format("frame {}", count_),
           "a frame that cannot be decoded (" + std::string(exception.err) + ")", "a picture");
    }
  }

  void check_length() {
    if (count_ == 0) fail(file_, "", "no frame", "a clip with frames");
    // Where the container tells its length and not its number of frames, frames that were dropped are in the stated
    // number; the last stamp then shows that the clip is whole.
    const double by_stamps = stamps_s_.empty() ? 0.0 : stamps_s_.back() * stated_rate_hz_ + 1.0;
    const double missing = static_cast<double>(stated_) - std::max(static_cast<double>(count_), by_stamps) -
                           static_cast<double>(unstamped_);
    if (missing > std::max(2.0, 0.01 * static_cast<double>(stated_))) {
      fail(file_, fmt::format("frame {}", count_), fmt::format("the end of the clip after {} frames", count_),
           fmt::format("{} frames, as the container says (is the file truncated?)", stated_));
    }
    find_irregular_steps();
  }

  void look_at_stamp(double stamp_s) {
    if (!stamps_s_.empty() && camera_.time == TimeSource::container && stamp_s <= stamps_s_.back()) {
      fail(file_, fmt::format("frame {}", count_), fmt::format("a time stamp of {:.6g} s", stamp_s),
           fmt::format("one after that of the frame before, {:.6g} s", stamps_s_.back()));
    }
    stamps_s_.push_back(stamp_s);
  }

  void find_irregular_steps() {
    std::vector<double> steps;
    for (std::size_t i = 1; i < stamps_s_.size(); ++i) steps.push_back(stamps_s_[i] - stamps_s_[i - 1]);
    if (steps.size() < 2) return;
    std::vector<double> sorted = steps;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    median_step_s_ = sorted[sorted.size() / 2];
    longest_step_s_ = *std::max_element(steps.begin(), steps.end());
    if (longest_step_s_ <= 0.0) return;  // a container without stamps
    // Matroska rounds stamps to 1 ms, so that a regular clip's steps differ by up to that.
    const double tolerance_s = std::max(1.05e-3, 0.05 * median_step_s_);
    for (const double step : steps) {
      const double slots = step / median_step_s_;
      // Whole frame times, as a slot that was left out makes them; a camera that films slower makes any.
      if (slots > 1.5 && std::abs(slots - std::round(slots)) < 0.1 + 1.05e-3 / median_step_s_) {
        missing_ += static_cast<std::size_t>(std::lround(slots)) - 1;
      }
    }
    irregular_ = static_cast<std::size_t>(std::count_if(
        steps.begin(), steps.end(), [&](double step) { return std::abs(step - median_step_s_) > tolerance_s; }));
    find_drift();
  }

  /// The stamps against a straight line through them; a rate that merely plays slowly leaves none.
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
  cv::VideoCapture capture_;
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

class FolderFrames final : public FrameSource {
 public:
  FolderFrames(const fs::path& folder, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)
      : camera_(camera), with_color_(with_color), check_size_(size) {
    static const std::set<std::string> kPictures{".png", ".tif", ".tiff", ".pgm", ".bmp", ".jpg", ".jpeg"};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with('.') || !entry.is_regular_file()) continue;
      std::string ending = entry.path().extension().string();
      std::transform(ending.begin(), ending.end(), ending.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      if (kPictures.contains(ending)) {
        files_.push_back(entry.path());
      } else {
        ++others_;
      }
    }
    if (files_.empty()) fail(folder, "", "a folder without pictures", "a folder of frames (PNG, in order)");
    if (camera.time == TimeSource::container) {
      fail(folder, "", "a folder of frames, which has no time stamps",
           "a video, or time = \"rate\" in [camera] of experiment.toml");
    }
    std::sort(files_.begin(), files_.end(),
              [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
  }

  std::optional<Frame> next() override {
    if (count_ == files_.size()) return std::nullopt;
    const cv::Mat picture = read_picture(files_[count_]);
    check_size_(picture, count_, files_[count_]);
    Frame frame = make_frame(picture, with_color_, count_);
    frame.t_s = static_cast<double>(count_) / camera_.frame_rate_hz;
    ++count_;
    return frame;
  }

  std::size_t stated_frames() const override { return files_.size(); }

  std::vector<std::string> notes() const override {
    if (others_ == 0) return {};
    return {fmt::format("{} files in the folder of frames are no pictures and were left out", others_)};
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

bool natural_less(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    std::size_t i_end = i;
    std::size_t j_end = j;
    while (i_end < a.size() && is_digit(a[i_end])) ++i_end;
    while (j_end < b.size() && is_digit(b[j_end])) ++j_end;
    if (i_end - i != j_end - j) return i_end - i < j_end - j;
    const int order = a.compare(i, i_end - i, b, j, j_end - j);
    if (order != 0) return order < 0;
    i = i_end;
    j = j_end;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

std::unique_ptr<FrameSource> open_frames(const fs::path& file, const CameraSettings& camera, bool with_color,
                                         std::optional<cv::Size> size) {
  silence_opencv();
  std::error_code error;
  if (fs::is_directory(file, error)) return std::make_unique<FolderFrames>(file, camera, with_color, size);
  if (!fs::is_regular_file(file, error)) fail(file, "", "no file", "a video or a folder of frames");
  return std::make_unique<VideoFrames>(file, camera, with_color, size);
}

}  // namespace glidelab::core
