/// Pictures that frames are drawn on in memory, used again by later frames and clips: a new one costs as much as the
/// drawing.
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

/// Whether nobody but the caller, who holds this pointer, looks at the canvas or its pixels.
bool is_free(const std::shared_ptr<Canvas>& canvas);

/// Between clips, also of different threads. Canvases are of one size and depth; of another none is kept.
class CanvasPool {
 public:
  /// A clear canvas.
  std::shared_ptr<Canvas> take(cv::Size size, int type);

  /// Takes back what is looked at by nobody but the caller, who gives it away.
  void give(std::shared_ptr<Canvas> canvas);

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<Canvas>> all_;
};

}  // namespace glidelab::validate
