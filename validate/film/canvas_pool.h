/// Images in memory that frames are drawn on, reused by later frames and clips: allocating a new one costs as much as
/// the drawing.
#pragma once

#include <opencv2/core.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace glidelab::validate {

/// A frame's pixels and what of them is drawn; the rest is 0.
struct Canvas {
  cv::Mat picture;
  std::vector<cv::Rect> drawn;

  /// All 0 again.
  void clear();
};

/// Whether the caller, who holds this pointer, is the only one that refers to the canvas or its pixels.
bool is_free(const std::shared_ptr<Canvas>& canvas);

/// Shared between clips, also on different threads. All canvases have one size and depth; no others are kept.
class CanvasPool {
 public:
  /// A clear canvas.
  std::shared_ptr<Canvas> take(cv::Size size, int type);

  /// Takes back a canvas that only the caller refers to.
  void give(std::shared_ptr<Canvas> canvas);

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<Canvas>> all_;
};

}  // namespace glidelab::validate
