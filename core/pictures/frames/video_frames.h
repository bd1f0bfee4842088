/// Frames of a video file, with what its container says about their times.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

/// `size`, where given, is what every frame must measure. InputError for a file that is no video.
std::unique_ptr<FrameSource> open_video(const std::filesystem::path& file, const CameraSettings& camera,
                                        bool with_color, std::optional<cv::Size> size);

}  // namespace glidelab::core
