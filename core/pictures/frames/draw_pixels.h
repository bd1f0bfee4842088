/// Pictures whose pixels are made as they are looked at: a renderer's, of which a tracker looks at a hundredth.
#pragma once

#include <opencv2/core.hpp>

#include <functional>

namespace glidelab::core {

/// Makes the pixels of a rectangle within the picture, where they are not there yet.
using DrawPixels = std::function<void(const cv::Rect&)>;

}  // namespace glidelab::core
