/// What is done to a rendered experiment folder before it is a filmed blind case: lines of experiment.toml that say
/// something else, frames that are lost, pictures that are pulled along the track, clips filed anew without loss.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>

#include "validate/blind_scene.h"

namespace glidelab::validate {

/// Where each column's pixels are taken from: columns, and how many rows farther down. One row each.
struct ColumnSources {
  cv::Mat_<double> column, down;
};

/// A grey picture of 8 bits with its pixels from there, by Lanczos' interpolation (8 x 8 pixels, places exact).
cv::Mat pulled(const cv::Mat& grey, const ColumnSources& sources);

/// Changes the folder in place. A line of experiment.toml that is to be changed and is not there: std::logic_error.
void retouch_folder(const BlindScene& scene, const std::filesystem::path& folder);

}  // namespace glidelab::validate
