/// Clips through libavformat and libavcodec (there and nowhere else).
#pragma once

#include <filesystem>
#include <memory>

#include "render/video/video_format.h"

namespace glidelab::render {

/// For every codec but png. EnvironmentError where the file cannot be written or the encoder is missing.
std::unique_ptr<VideoWriter> open_libav(const std::filesystem::path& path, const VideoFormat& format);

}  // namespace glidelab::render
