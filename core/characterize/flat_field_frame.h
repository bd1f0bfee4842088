/// One frame of a flat-field folder, read strictly: a wrong frame spoils a variance without a trace.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>

namespace glidelab::core {

/// Smallest width and height, in pixels, of an image that gives enough tiles for a standard deviation.
inline constexpr int kSmallestFlatFieldPx = 64;

/// What every frame must be: set by the first one.
struct FrameForm {
  cv::Size size;
  int depth = 0;      ///< CV_8U or CV_16U
  std::string named;  ///< file that set it
};

/// InputError if the file is not a grey image of at least kSmallestFlatFieldPx pixels each way.
FrameForm form_of(const std::filesystem::path& file);

/// Grey codes; a colour file counts as grey where its three channels are equal. InputError (file, found, expected) for
/// a file that is no image, one with colours, one of another size or depth, and a code above `largest_code`.
cv::Mat read_flat_field_frame(const std::filesystem::path& file, const FrameForm& form, int largest_code);

/// InputError where `frame`, of `file`, equals `last`, the one before: copies are no measurement of noise. Frames that
/// are constant (dark, or all saturated) may be equal.
void reject_copy(const std::filesystem::path& file, const cv::Mat& frame, const std::filesystem::path& last_file,
                 const cv::Mat& last);

}  // namespace glidelab::core
