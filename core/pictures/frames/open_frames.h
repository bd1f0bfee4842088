/// The frames of a file: a video, or a folder of images.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

/// Opens a video or a folder of frames. `size`, where given, is what the frames must measure (the calibration's
/// images). InputError where it is neither a video nor a folder with images.
std::unique_ptr<FrameSource> open_frames(const std::filesystem::path& file, const CameraSettings& camera,
                                         bool with_color, std::optional<cv::Size> size);

/// How an analysis comes by a clip's frames: open_frames, or what gives the same from elsewhere.
using FrameOpener = std::function<std::unique_ptr<FrameSource>(
    const std::filesystem::path& file, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)>;

}  // namespace glidelab::core
