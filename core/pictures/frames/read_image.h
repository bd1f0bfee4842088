/// Pictures from files, and the one place where OpenCV and FFmpeg are told to keep quiet.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>

namespace glidelab::core {

/// OpenCV and FFmpeg write what they think of a broken file on standard error; our own errors say it better. Called by
/// everything here that opens a file; cheap after the first time.
void silence_opencv();

/// The picture with 1 or 3 (BGR) channels of 8 or 16 bits, turned as its EXIF says. InputError where the file is no
/// picture.
cv::Mat read_picture(const std::filesystem::path& path);

/// The same as grey, 8 or 16 bits; a grey picture comes out bit by bit as it is stored.
cv::Mat read_grey_picture(const std::filesystem::path& path);

/// Grey of a picture with 1 or 3 channels; three equal channels give exactly their value.
cv::Mat to_grey(const cv::Mat& picture);

}  // namespace glidelab::core
