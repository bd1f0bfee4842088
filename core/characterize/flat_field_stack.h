/// The frames of one set of flat fields, read strictly, and their statistics tile by tile: mean and temporal variance.
///
/// An image is cut into tiles, and the pixels of a tile into four cells by their position in the 2 x 2 mosaic of a
/// colour sensor (on a monochrome sensor the four are equivalent). With y_pf the code of pixel p in frame f, and m_f
/// the mean of the cell in frame f,
///
///     e_pf = y_pf - m_f,     temporal variance = mean over p of [sum_f (e_pf - mean_f e_pf)^2 / (L - 1)] n / (n - 1)
///
/// which for two frames is half the variance of their difference (EMVA standard 1288, release 3.1, equation for the
/// temporal variance from two images). Subtracting each cell's own mean makes it insensitive to a light that flickers
/// or drifts from frame to frame; using each pixel's own differences makes it insensitive to shading and fixed
/// patterns.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/characterize/flat_field_folder.h"

namespace glidelab::core {

/// Smallest width and height, in pixels, of an image that gives enough tiles for a standard deviation.
inline constexpr int kSmallestFlatFieldPx = 64;

/// The form that every frame must have, set by the first one.
struct FrameForm {
  cv::Size size;
  int depth = 0;      ///< CV_8U or CV_16U
  std::string named;  ///< file that set it
  std::size_t most_pixels = kMostPixels;
};

/// InputError if the file is not a grey image of at least kSmallestFlatFieldPx pixels each way and at most
/// `most_pixels` in all.
FrameForm form_of(const std::filesystem::path& file, std::size_t most_pixels = kMostPixels);

/// One frame of a flat-field folder, read strictly, because a wrong frame would corrupt a variance unnoticed. Grey
/// codes; a colour file counts as grey if its three channels are equal. InputError (file, found, expected) for a file
/// that is not an image, one with colours, one of another size or depth, and a code above `largest_code`.
cv::Mat read_flat_field_frame(const std::filesystem::path& file, const FrameForm& form, int largest_code);

/// InputError if `frame`, of `file`, equals the previous frame `last`: copies do not measure noise. Frames that are
/// constant (dark, or all saturated) may be equal.
void reject_copy(const std::filesystem::path& file, const cv::Mat& frame, const std::filesystem::path& last_file,
                 const cv::Mat& last);

/// How an image is divided: about 50 to 150 tiles, at least 16 pixels wide and high.
class TileGrid {
 public:
  explicit TileGrid(cv::Size size);
  cv::Size size() const { return size_; }
  std::size_t tiles() const { return static_cast<std::size_t>(columns_ * rows_); }
  std::size_t cells() const { return 4 * tiles(); }
  cv::Rect tile(std::size_t index) const;
  /// Cell of a pixel of that tile.
  static std::size_t cell(std::size_t tile, int x, int y) {
    return 4 * tile + 2 * static_cast<std::size_t>(y & 1) + static_cast<std::size_t>(x & 1);
  }

 private:
  cv::Size size_;
  int columns_;
  int rows_;
};

struct CellStatistics {
  double pixels = 0.0;        ///< number of pixels that are not masked
  double mean_dn = 0.0;       ///< over pixels and frames
  double temporal_dn2 = 0.0;  ///< variance of a pixel from frame to frame, quantisation included
  double total_dn2 = 0.0;     ///< variance over the pixels and frames of the cell
  double at_zero = 0.0;       ///< fraction of the samples at code 0
  double at_largest = 0.0;    ///< fraction of the samples at the largest code
};

struct FlatFieldStack {
  std::size_t frames = 0;
  std::vector<CellStatistics> cells;
  CellStatistics all;                  ///< over the whole image; variances are means over the cells
  std::vector<double> frame_means_dn;  ///< of the whole image, frame by frame
  cv::Mat mean_dn;                     ///< CV_32F, mean of the frames
  cv::Mat contrast_dn;  ///< CV_32F, even frames minus odd ones: as noisy as the mean but without its pattern
  /// Correlation of the noise (difference of the first two frames) of pixels side by side and one above the other; 0 if
  /// there is no noise.
  double correlation_right = 0.0;
  double correlation_below = 0.0;
  /// Variance of the differences of successive frames over that of frames two apart; 1 for noise that is new in every
  /// frame. Empty for two frames, or without noise.
  std::optional<double> successive_ratio;
};

/// Reads the frames of a set one after another (never more than three at once). `mask`, CV_8U, is 255 where a pixel
/// counts; empty: all count. InputError (file, found, expected) for a file that is not an image, one with colours, one
/// of another size or depth, a code above `largest_code`, and a frame that repeats the previous one.
FlatFieldStack stack_frames(const FrameSet& set, const FrameForm& form, int largest_code, const TileGrid& grid,
                            const cv::Mat& mask);

}  // namespace glidelab::core
