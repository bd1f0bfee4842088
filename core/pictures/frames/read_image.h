/// Images from files, and the one place that silences OpenCV and FFmpeg.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <filesystem>

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

}  // namespace glidelab::core
