#include "core/characterize/flat_field_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

// If this fraction of the pixels differs from the most frequent code, many pixels lie near a boundary between two
// codes, and any noise at all makes two frames differ.
constexpr double kSpreadThatShowsNoise = 0.1;

[[noreturn]] void fail(const fs::path& file, std::string found, std::string expected) {
  throw base::InputError(base::Issue{file.string(), 0, "", std::move(found), std::move(expected)});
}

std::string bits(int depth) {
  return depth == CV_8U ? "8 bits" : "16 bits";
}

/// Grey codes; a colour file counts as grey if its three channels are equal.
cv::Mat read_codes(const fs::path& file, std::size_t most_pixels) {
  const cv::Mat image = read_image(file, most_pixels);
  if (image.channels() == 1) return image;
  std::vector<cv::Mat> channels;
  cv::split(image, channels);
  if (cv::norm(channels[0], channels[1], cv::NORM_INF) > 0.0 ||
      cv::norm(channels[0], channels[2], cv::NORM_INF) > 0.0) {
    fail(file, "an image with colours", "a grey image: raw codes (a mosaic is fine), or one channel of them");
  }
  return channels[0];
}

/// Fraction of the pixels that do not have the most frequent code.
double spread(const cv::Mat& codes) {
  cv::Mat wide;
  codes.convertTo(wide, CV_16U);
  std::vector<std::size_t> count(std::size_t{1} << 16, 0);
  for (const std::uint16_t code : cv::Mat_<std::uint16_t>(wide)) ++count[code];
  const auto most = static_cast<double>(*std::max_element(count.begin(), count.end()));
  return 1.0 - most / static_cast<double>(wide.total());
}

}  // namespace

FrameForm form_of(const fs::path& file, std::size_t most_pixels) {
  const cv::Mat codes = read_codes(file, most_pixels);
  if (codes.cols < kSmallestFlatFieldPx || codes.rows < kSmallestFlatFieldPx) {
    fail(file, fmt::format("{} x {} pixels", codes.cols, codes.rows),
         fmt::format("at least {0} x {0} pixels", kSmallestFlatFieldPx));
  }
  return {codes.size(), codes.depth(), file.string(), most_pixels};
}

cv::Mat read_flat_field_frame(const fs::path& file, const FrameForm& form, int largest_code) {
  const cv::Mat codes = read_codes(file, form.most_pixels);
  if (codes.size() != form.size) {
    fail(file, fmt::format("{} x {} pixels", codes.cols, codes.rows),
         fmt::format("{} x {} pixels, as {}", form.size.width, form.size.height, form.named));
  }
  if (codes.depth() != form.depth)
    fail(file, bits(codes.depth()), fmt::format("{}, as {}", bits(form.depth), form.named));
  double largest = 0.0;
  cv::minMaxLoc(codes, nullptr, &largest);
  if (largest > largest_code) {
    fail(file, fmt::format("a code of {}", largest),
         fmt::format("codes up to {}, by bit_depth in characterize.toml (are the bits shifted to the top of 16? divide "
                     "the codes, or give bit_depth = 16)",
                     largest_code));
  }
  return codes;
}

void reject_copy(const fs::path& file, const cv::Mat& frame, const fs::path& last_file, const cv::Mat& last) {
  if (cv::norm(frame, last, cv::NORM_INF) > 0.0 || spread(frame) <= kSpreadThatShowsNoise) return;
  fail(file, "the same image as " + last_file.filename().string(), "another frame, with noise of its own");
}

namespace {

constexpr int kSmallestTilePx = 16;
constexpr int kMostTilesAcross = 12;
/// Weight of each of `these` frames against the `others`, such that the weighted sum of all frames has zero mean and
/// the same noise as the mean: the weights add up to 0, their squares to 1 / (these + others).
double contrast_weight(std::size_t others, std::size_t these) {
  return std::sqrt(static_cast<double>(others) / static_cast<double>(these)) / static_cast<double>(others + these);
}

/// Sums over the frames of one set.
class Accumulator {
 public:
  Accumulator(const TileGrid& grid, cv::Mat mask, int largest_code, std::size_t frames)
      : grid_(grid),
        mask_(std::move(mask)),
        largest_code_(largest_code),
        sum_(grid.size(), CV_64F, cv::Scalar(0)),
        sum2_(grid.size(), CV_64F, cv::Scalar(0)),
        codes_(grid.size(), CV_64F, cv::Scalar(0)),
        contrast_(grid.size(), CV_64F, cv::Scalar(0)),
        even_weight_(contrast_weight(frames / 2, (frames + 1) / 2)),
        odd_weight_(-contrast_weight((frames + 1) / 2, frames / 2)),
        cells_(grid.cells()) {}

  void add(const cv::Mat& frame) {
    cv::Mat wide;
    frame.convertTo(wide, CV_16U);
    cv::Mat residual(grid_.size(), CV_32F);
    double total = 0.0;
    double pixels = 0.0;
    for (std::size_t tile = 0; tile < grid_.tiles(); ++tile) {
      const std::array<double, 4> means = add_codes(wide, tile);
      for (std::size_t k = 0; k < 4; ++k) {
        total += means[k] * cells_[4 * tile + k].pixels;
        pixels += cells_[4 * tile + k].pixels;
      }
      add_residuals(wide, tile, means, residual);
    }
    frame_means_.push_back(pixels > 0.0 ? total / pixels : 0.0);
    compare(residual);
    ++frames_;
  }

  FlatFieldStack finish() const;

 private:
  struct Cell {
    double pixels = 0.0;
    double mean_sum = 0.0;  // over frames
    double sum2 = 0.0;      // of residuals
    double at_zero = 0.0;
    double at_largest = 0.0;
  };

  template <typename Work>
  void for_pixels(std::size_t tile, Work work) const {
    const cv::Rect area = grid_.tile(tile);
    for (int y = area.y; y < area.y + area.height; ++y) {
      const std::uint8_t* mask = mask_.empty() ? nullptr : mask_.ptr<std::uint8_t>(y);
      for (int x = area.x; x < area.x + area.width; ++x) {
        if (mask == nullptr || mask[x] != 0) work(x, y, 2 * (y & 1) + (x & 1));
      }
    }
  }

  /// The frame's mean in each cell of the tile.
  std::array<double, 4> add_codes(const cv::Mat& frame, std::size_t tile) {
    std::array<double, 4> sum{};
    std::array<long, 4> count{};
    std::array<long, 4> zero{};
    std::array<long, 4> largest{};
    for_pixels(tile, [&](int x, int y, int k) {
      const std::uint16_t code = frame.ptr<std::uint16_t>(y)[x];
      const auto i = static_cast<std::size_t>(k);
      sum[i] += code;
      ++count[i];
      if (code == 0) ++zero[i];
      if (code == largest_code_) ++largest[i];
    });
    for (std::size_t k = 0; k < 4; ++k) {
      Cell& cell = cells_[4 * tile + k];
      cell.pixels = static_cast<double>(count[k]);
      if (count[k] > 0) sum[k] /= cell.pixels;
      cell.mean_sum += sum[k];
      cell.at_zero += static_cast<double>(zero[k]);
      cell.at_largest += static_cast<double>(largest[k]);
    }
    return sum;
  }

  void add_residuals(const cv::Mat& frame, std::size_t tile, const std::array<double, 4>& means, cv::Mat& residual) {
    const cv::Rect area = grid_.tile(tile);
    const double weight = frames_ % 2 == 0 ? even_weight_ : odd_weight_;
    for (int y = area.y; y < area.y + area.height; ++y) {
      const std::uint16_t* code = frame.ptr<std::uint16_t>(y);
      float* out = residual.ptr<float>(y);
      double* sum = sum_.ptr<double>(y);
      double* sum2 = sum2_.ptr<double>(y);
      double* codes = codes_.ptr<double>(y);
      double* contrast = contrast_.ptr<double>(y);
      for (int x = area.x; x < area.x + area.width; ++x) {
        const double e = code[x] - means[static_cast<std::size_t>(2 * (y & 1) + (x & 1))];
        out[x] = static_cast<float>(e);
        sum[x] += e;
        sum2[x] += e * e;
        codes[x] += code[x];
        contrast[x] += weight * e;
      }
    }
    for_pixels(tile, [&](int x, int y, int k) {
      const double e = residual.ptr<float>(y)[x];
      cells_[4 * tile + static_cast<std::size_t>(k)].sum2 += e * e;
    });
  }

  bool counts(int x, int y) const { return mask_.empty() || mask_.at<std::uint8_t>(y, x) != 0; }

  /// Differences of this frame from the previous one and the one before that.
  void compare(cv::Mat& residual) {
    if (!last_.empty() && frames_ == 1) correlate(residual - last_);
    if (!before_last_.empty()) {
      apart_one_ += squares(residual - last_) + squares(last_ - before_last_);
      apart_two_ += 2.0 * squares(residual - before_last_);
    }
    before_last_ = last_;
    last_ = residual;
  }

  double squares(const cv::Mat& difference) const {
    cv::Mat masked = difference;
    if (!mask_.empty()) masked.setTo(0.0F, mask_ == 0);
    return masked.dot(masked);
  }

  void correlate(const cv::Mat& difference) {
    double self = 0.0;
    double right = 0.0;
    double below = 0.0;
    const int width = difference.cols - 1;
    const int height = difference.rows - 1;
    for (int y = 0; y < height; ++y) {
      const float* row = difference.ptr<float>(y);
      const float* next = difference.ptr<float>(y + 1);
      for (int x = 0; x < width; ++x) {
        if (!counts(x, y) || !counts(x + 1, y) || !counts(x, y + 1)) continue;
        self += static_cast<double>(row[x]) * row[x];
        right += static_cast<double>(row[x]) * row[x + 1];
        below += static_cast<double>(row[x]) * next[x];
      }
    }
    if (self <= 0.0) return;
    correlation_right_ = right / self;
    correlation_below_ = below / self;
  }

  const TileGrid& grid_;
  cv::Mat mask_;
  int largest_code_;
  cv::Mat sum_;    // of residuals, pixel by pixel
  cv::Mat sum2_;   // of their squares
  cv::Mat codes_;  // sum of the codes
  cv::Mat contrast_;
  double even_weight_;
  double odd_weight_;
  std::vector<Cell> cells_;
  std::size_t frames_ = 0;
  std::vector<double> frame_means_;
  cv::Mat last_;
  cv::Mat before_last_;
  double apart_one_ = 0.0;
  double apart_two_ = 0.0;
  double correlation_right_ = 0.0;
  double correlation_below_ = 0.0;
};

FlatFieldStack Accumulator::finish() const {
  FlatFieldStack stack;
  const auto frames = static_cast<double>(frames_);
  stack.frames = frames_;
  stack.frame_means_dn = frame_means_;
  codes_.convertTo(stack.mean_dn, CV_32F, 1.0 / frames);
  contrast_.convertTo(stack.contrast_dn, CV_32F);
  stack.correlation_right = correlation_right_;
  stack.correlation_below = correlation_below_;
  if (apart_two_ > 0.0) stack.successive_ratio = apart_one_ / apart_two_;
  std::vector<double> temporal(cells_.size(), 0.0);
  for (std::size_t tile = 0; tile < grid_.tiles(); ++tile) {
    for_pixels(tile, [&](int x, int y, int k) {
      const double sum = sum_.at<double>(y, x);
      temporal[4 * tile + static_cast<std::size_t>(k)] += sum2_.at<double>(y, x) - sum * sum / frames;
    });
  }
  CellStatistics& all = stack.all;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Cell& cell = cells_[c];
    CellStatistics out;
    if (cell.pixels >= 2.0) {
      out.pixels = cell.pixels;
      out.mean_dn = cell.mean_sum / frames;
      out.temporal_dn2 = temporal[c] / ((cell.pixels - 1.0) * (frames - 1.0));
      out.total_dn2 = cell.sum2 / ((cell.pixels - 1.0) * frames);
      out.at_zero = cell.at_zero / (cell.pixels * frames);
      out.at_largest = cell.at_largest / (cell.pixels * frames);
    }
    stack.cells.push_back(out);
    all.pixels += out.pixels;
    all.mean_dn += out.pixels * out.mean_dn;
    all.temporal_dn2 += out.pixels * out.temporal_dn2;
    all.total_dn2 += out.pixels * out.total_dn2;
    all.at_zero += out.pixels * out.at_zero;
    all.at_largest += out.pixels * out.at_largest;
  }
  for (double* value : {&all.mean_dn, &all.temporal_dn2, &all.total_dn2, &all.at_zero, &all.at_largest}) {
    *value /= all.pixels;
  }
  return stack;
}

}  // namespace

TileGrid::TileGrid(cv::Size size)
    : size_(size),
      columns_(std::clamp(size.width / kSmallestTilePx, 1, kMostTilesAcross)),
      rows_(std::clamp(size.height / kSmallestTilePx, 1, kMostTilesAcross)) {}

cv::Rect TileGrid::tile(std::size_t index) const {
  const int column = static_cast<int>(index) % columns_;
  const int row = static_cast<int>(index) / columns_;
  const int left = size_.width * column / columns_;
  const int top = size_.height * row / rows_;
  return {left, top, size_.width * (column + 1) / columns_ - left, size_.height * (row + 1) / rows_ - top};
}

FlatFieldStack stack_frames(const FrameSet& set, const FrameForm& form, int largest_code, const TileGrid& grid,
                            const cv::Mat& mask) {
  Accumulator sums(grid, mask, largest_code, set.files.size());
  cv::Mat last;
  for (std::size_t f = 0; f < set.files.size(); ++f) {
    const cv::Mat frame = read_flat_field_frame(set.files[f], form, largest_code);
    sums.add(frame);
    if (f > 0) reject_copy(set.files[f], frame, set.files[f - 1], last);
    last = frame;
  }
  return sums.finish();
}

}  // namespace glidelab::core
