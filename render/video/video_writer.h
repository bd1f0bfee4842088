/// Writes grey clips and stills.
///
/// A clip has a constant rate, frame k at k / frame_rate, or a time stamp for every frame. Matroska rounds stamps to
/// its tick of 1 ms and carries the exact rate beside them; MP4 counts in 1/90000 s; AVI has a constant rate and no
/// rounding. Every write is checked: a full disk is an EnvironmentError that names the file, at the frame, at finish()
/// or never.
#pragma once

#include <filesystem>
#include <memory>

#include "render/video/video_format.h"

namespace cv {
class Mat;
}

namespace glidelab::render {

/// Writes one 8- or 16-bit image.
void write_png(const std::filesystem::path& path, const cv::Mat& image);

/// Opens `path` for writing. EnvironmentError where it cannot be written or the codec is missing.
std::unique_ptr<VideoWriter> open_video(const std::filesystem::path& path, const VideoFormat& format);

}  // namespace glidelab::render
