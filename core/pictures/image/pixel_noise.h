/// The noise of an image's pixels from second differences along its rows: their median is not moved by edges.
#pragma once

#include <opencv2/core.hpp>

namespace glidelab::core {

/// Standard deviation of one pixel, of an image of floats.
double noise_of(const cv::Mat& values);

/// The same of the image shrunk by a whole number, from some of its rows; values of 8 or 16 bits.
double noise_when_shrunk(const cv::Mat& values, int shrink);

}  // namespace glidelab::core
