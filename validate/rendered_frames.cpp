#include "validate/rendered_frames.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

class RenderedFrames : public core::FrameSource {
 public:
  RenderedFrames(std::shared_ptr<const render::ClipSet> set, std::size_t clip, std::uint64_t seed, bool with_color)
      : set_(std::move(set)), stream_(set_, clip, seed), frames_(set_->frames(clip, seed)), with_color_(with_color) {}

  std::optional<core::Frame> next() override {
    const std::optional<render::ClipStream::Next> now = stream_.next();
    if (!now) return std::nullopt;
    const render::Camera& camera = set_->scenario().camera;
    const render::PixelRect all{0, 0, camera.width_px, camera.height_px};
    const bool deep = set_->scenario().sensor.bit_depth > 8;
    core::Frame frame;
    frame.grey.create(all.height, all.width, deep ? CV_16U : CV_8U);
    if (deep) {
      stream_.read(all, std::span<std::uint16_t>(frame.grey.ptr<std::uint16_t>(), frame.grey.total()));
    } else {
      stream_.read(all, std::span<std::uint8_t>(frame.grey.ptr<std::uint8_t>(), frame.grey.total()));
    }
    if (with_color_) {
      cv::Mat shallow = frame.grey;
      if (deep) frame.grey.convertTo(shallow, CV_8U, 255.0 / set_->scenario().sensor.largest_code());
      cv::cvtColor(shallow, frame.color, cv::COLOR_GRAY2BGR);
    }
    frame.index = index_++;
    const render::Recording& recording = set_->scenario().recording;
    frame.t_s = recording.clock.variable ? now->stamp_s : static_cast<double>(frame.index) / recording.frame_rate_hz;
    return frame;
  }
  std::size_t stated_frames() const override { return frames_; }
  std::vector<std::string> notes() const override { return {}; }

 private:
  std::shared_ptr<const render::ClipSet> set_;
  render::ClipStream stream_;
  std::size_t frames_;
  bool with_color_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<core::FrameSource> rendered_frames(std::shared_ptr<const render::ClipSet> set, std::size_t clip,
                                                   std::uint64_t seed, bool with_color) {
  if (render::lossy(set->scenario().codec)) {
    throw base::InputError(base::Issue{set->motion(clip).name, 0, "codec.name",
                                       "a codec that loses some of the picture",
                                       "one without loss, or the clip's file: in memory frames are as the sensor gives "
                                       "them"});
  }
  return std::make_unique<RenderedFrames>(std::move(set), clip, seed, with_color);
}

core::FrameOpener rendered_opener(std::shared_ptr<const render::ClipSet> set, std::uint64_t seed) {
  return [set, seed](const std::filesystem::path& file, const core::CameraSettings&, bool with_color,
                     std::optional<cv::Size>) -> std::unique_ptr<core::FrameSource> {
    for (std::size_t clip = 0; clip < set->size(); ++clip) {
      if (file.stem() == set->motion(clip).name || file.filename() == set->motion(clip).name) {
        return rendered_frames(set, clip, seed, with_color);
      }
    }
    throw base::InputError(base::Issue{file.string(), 0, "clip", "no such clip in the scenario", "one of its clips"});
  };
}

}  // namespace glidelab::validate
