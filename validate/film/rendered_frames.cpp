#include "validate/film/rendered_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

/// The canvases of one clip: those that nobody looks at any more are drawn on again.
class Canvases {
 public:
  Canvases(std::shared_ptr<CanvasPool> pool, cv::Size size, int type)
      : pool_(std::move(pool)), size_(size), type_(type) {}
  Canvases(const Canvases&) = delete;
  Canvases& operator=(const Canvases&) = delete;
  ~Canvases() {
    for (std::shared_ptr<Canvas>& canvas : all_) pool_->give(std::move(canvas));
  }

  std::shared_ptr<Canvas> clear_one() {
    for (const std::shared_ptr<Canvas>& canvas : all_) {
      if (!is_free(canvas)) continue;
      canvas->clear();
      return canvas;
    }
    all_.push_back(pool_->take(size_, type_));
    return all_.back();
  }

 private:
  std::shared_ptr<CanvasPool> pool_;
  cv::Size size_;
  int type_;
  std::vector<std::shared_ptr<Canvas>> all_;
};

class RenderedFrames : public core::FrameSource {
 public:
  RenderedFrames(std::shared_ptr<const render::ClipSet> set, std::size_t clip, std::uint64_t seed, bool with_color,
                 std::shared_ptr<CanvasPool> pool)
      : set_(std::move(set)),
        stream_(set_, clip, seed),
        frames_(set_->frames(clip, seed)),
        with_color_(with_color),
        deep_(set_->scenario().sensor.bit_depth > 8),
        canvases_(std::move(pool), {set_->scenario().camera.width_px, set_->scenario().camera.height_px},
                  deep_ ? CV_16U : CV_8U) {}

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = next_in_parts();
    if (!frame || !frame->draw) return frame;
    frame->draw(cv::Rect({}, frame->grey.size()));
    frame->draw = {};
    return frame;
  }

  std::optional<core::Frame> next_in_parts() override {
    const std::optional<render::ClipStream::Next> now = stream_.next();
    if (!now) return std::nullopt;
    core::Frame frame;
    const std::shared_ptr<Canvas> canvas = canvases_.clear_one();
    frame.grey = canvas->picture;
    frame.index = index_++;
    const render::Recording& recording = set_->scenario().recording;
    frame.t_s = recording.clock.variable ? now->stamp_s : static_cast<double>(frame.index) / recording.frame_rate_hz;
    // Copies of the frame share the canvas.
    frame.draw = [this, canvas, shown = now->shown](const cv::Rect& part) {
      cv::Mat& picture = canvas->picture;
      if (std::ranges::any_of(canvas->drawn, [&](const cv::Rect& known) { return (known & part) == part; })) return;
      canvas->drawn.push_back(part);
      cv::Mat target = picture(part);
      if (picture.depth() == CV_16U) {
        read<std::uint16_t>(*shown, part, target);
      } else {
        read<std::uint8_t>(*shown, part, target);
      }
    };
    if (!with_color_) return frame;
    frame.draw(cv::Rect({}, frame.grey.size()));
    frame.draw = {};
    cv::Mat shallow = frame.grey;
    if (deep_) frame.grey.convertTo(shallow, CV_8U, 255.0 / set_->scenario().sensor.largest_code());
    cv::cvtColor(shallow, frame.color, cv::COLOR_GRAY2BGR);
    return frame;
  }
  std::size_t stated_frames() const override { return frames_; }
  std::vector<std::string> notes() const override { return {}; }

 private:
  template <typename Code>
  void read(const render::FrameMotion& shown, const cv::Rect& rect, cv::Mat& target) {
    const render::PixelRect part{rect.x, rect.y, rect.width, rect.height};
    if (target.isContinuous()) {
      stream_.read(shown, part, std::span<Code>(target.ptr<Code>(), target.total()));
      return;
    }
    cv::Mat codes(rect.size(), target.type());
    stream_.read(shown, part, std::span<Code>(codes.ptr<Code>(), codes.total()));
    codes.copyTo(target);
  }

  std::shared_ptr<const render::ClipSet> set_;
  render::ClipStream stream_;
  std::size_t frames_;
  bool with_color_;
  bool deep_;
  Canvases canvases_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<core::FrameSource> rendered_frames(std::shared_ptr<const render::ClipSet> set, std::size_t clip,
                                                   std::uint64_t seed, bool with_color,
                                                   std::shared_ptr<CanvasPool> pool) {
  if (render::lossy(set->scenario().codec)) {
    throw base::InputError(base::Issue{set->motion(clip).name, 0, "codec.name", "a codec that loses part of the image",
                                       "one without loss, or the clip's file: in memory frames are as the sensor gives "
                                       "them"});
  }
  return std::make_unique<RenderedFrames>(std::move(set), clip, seed, with_color, std::move(pool));
}

core::FrameOpener rendered_opener(std::shared_ptr<const render::ClipSet> set, std::uint64_t seed,
                                  std::shared_ptr<CanvasPool> pool) {
  return [set, seed, pool](const std::filesystem::path& file, const core::CameraSettings&, bool with_color,
                           std::optional<cv::Size>) -> std::unique_ptr<core::FrameSource> {
    for (std::size_t clip = 0; clip < set->size(); ++clip) {
      if (file.stem() == set->motion(clip).name || file.filename() == set->motion(clip).name) {
        return rendered_frames(set, clip, seed, with_color, pool);
      }
    }
    throw base::InputError(base::Issue{file.string(), 0, "clip", "no such clip in the scenario", "one of its clips"});
  };
}

}  // namespace glidelab::validate
