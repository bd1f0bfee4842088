/// Frames that are images in a folder, in the order of their numbers ("2.png" before "10.png").
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

/// `size`, where given, is what every frame must measure. InputError for a folder without images, and where time stamps
/// are asked for, which a folder does not have.
std::unique_ptr<FrameSource> open_frame_folder(const std::filesystem::path& folder, const CameraSettings& camera,
                                               bool with_color, std::optional<cv::Size> size);

}  // namespace glidelab::core
