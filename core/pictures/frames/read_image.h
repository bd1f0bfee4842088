/// Images from files, and the one place that silences OpenCV and FFmpeg.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "core/experiment/permissions.h"

namespace glidelab::core {

/// Stops OpenCV and FFmpeg from writing about broken files on standard error; our own errors say it better. Called by
/// everything here that opens a file; cheap after the first time.
void silence_opencv();

/// The image with 1 or 3 (BGR) channels of 8 or 16 bits, turned as its EXIF data say. InputError if the file is not an
/// image (PNG, JPEG, TIFF, BMP, PBM, PGM, PPM), and before it is decoded if it states more than `most_pixels`.
cv::Mat read_image(const std::filesystem::path& path, std::size_t most_pixels = kMostPixels);

/// The same as grey, 8 or 16 bits; a grey image is preserved bit by bit.
cv::Mat read_grey_image(const std::filesystem::path& path, std::size_t most_pixels = kMostPixels);

/// Grey of an image with 1 or 3 channels; three equal channels give exactly their value.
cv::Mat to_grey(const cv::Mat& image);

/// The size of an image as its file states it, before any of it is decoded: a small file can state an image that takes
/// gigabytes.
///
/// PNG (ISO/IEC 15948, IHDR), JPEG (ITU-T T.81, the frame header SOF), TIFF 6.0 and BigTIFF (the tags of the first
/// directory), BMP, and PBM, PGM and PPM. What is none of these is not an image here, whatever OpenCV would make of it.
struct ImageSize {
  std::uint64_t width = 0, height = 0;
  std::uint64_t part_width = 0, part_height = 0;  ///< of a TIFF's tiles, which may be larger than the image; else 0
};

/// Nothing for a file that is none of these, or whose header is cut.
std::optional<ImageSize> stated_image_size(const std::filesystem::path& file);

/// InputError (file, key, the size, the limit and the option that raises it) for more than `most_pixels`.
void check_pixels(const std::filesystem::path& file, std::string key, std::uint64_t width, std::uint64_t height,
                  std::size_t most_pixels);

}  // namespace glidelab::core
