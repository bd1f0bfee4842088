#include "core/pictures/frames/folder_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/experiment/clip_names.h"
#include "core/pictures/frames/frame_parts.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

class FolderFrames final : public FrameSource {
 public:
  FolderFrames(const fs::path& folder, const CameraSettings& camera, bool with_color, std::optional<cv::Size> size)
      : camera_(camera), with_color_(with_color), check_size_(size) {
    static const std::set<std::string> kImageEndings{".png", ".tif", ".tiff", ".pgm", ".bmp", ".jpg", ".jpeg"};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with('.') || !entry.is_regular_file()) continue;
      if (kImageEndings.contains(lower_extension(entry.path()))) {
        files_.push_back(entry.path());
      } else {
        ++others_;
      }
    }
    if (files_.empty()) fail_frames(folder, "", "a folder without images", "a folder of frames (PNG, in order)");
    if (camera.time == TimeSource::container) {
      fail_frames(folder, "", "a folder of frames, which has no time stamps",
                  "a video, or time = \"rate\" in [camera] of experiment.toml");
    }
    std::sort(files_.begin(), files_.end(),
              [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
  }

  std::optional<Frame> next() override {
    if (count_ == files_.size()) return std::nullopt;
    const cv::Mat image = read_image(files_[count_]);
    check_size_(image, count_, files_[count_]);
    Frame frame = make_frame(image, with_color_, count_);
    frame.t_s = static_cast<double>(count_) / camera_.frame_rate_hz;
    ++count_;
    return frame;
  }

  std::size_t stated_frames() const override { return files_.size(); }

  std::vector<std::string> notes() const override {
    if (others_ == 0) return {};
    return {fmt::format("{} files in the folder of frames are not images and are skipped", others_)};
  }

 private:
  CameraSettings camera_;
  bool with_color_;
  SizeCheck check_size_;
  std::vector<fs::path> files_;
  std::size_t others_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_frame_folder(const fs::path& folder, const CameraSettings& camera, bool with_color,
                                               std::optional<cv::Size> size) {
  return std::make_unique<FolderFrames>(folder, camera, with_color, size);
}

}  // namespace glidelab::core
