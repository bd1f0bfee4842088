#include "core/pictures/frames/open_frames.h"

#include "core/pictures/frames/folder_frames.h"
#include "core/pictures/frames/frame_parts.h"
#include "core/pictures/frames/read_image.h"
#include "core/pictures/frames/video_frames.h"

namespace glidelab::core {
namespace fs = std::filesystem;

std::unique_ptr<FrameSource> open_frames(const fs::path& file, const CameraSettings& camera, bool with_color,
                                         std::optional<cv::Size> size) {
  silence_opencv();
  std::error_code error;
  if (fs::is_directory(file, error)) return open_frame_folder(file, camera, with_color, size);
  if (!fs::is_regular_file(file, error)) fail_frames(file, "", "no file", "a video or a folder of frames");
  return open_video(file, camera, with_color, size);
}

}  // namespace glidelab::core
