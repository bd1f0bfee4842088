#include "validate/film/canvas_pool.h"

#include <utility>

namespace glidelab::validate {

void Canvas::clear() {
  for (const cv::Rect& rect : drawn) picture(rect).setTo(0);
  drawn.clear();
}

bool is_free(const std::shared_ptr<Canvas>& canvas) {
  return canvas.use_count() == 1 && canvas->picture.u->refcount == 1;
}

std::shared_ptr<Canvas> CanvasPool::take(cv::Size size, int type) {
  std::shared_ptr<Canvas> canvas;
  {
    const std::lock_guard lock(mutex_);
    if (!all_.empty()) {
      canvas = std::move(all_.back());
      all_.pop_back();
    }
  }
  if (!canvas || canvas->picture.size() != size || canvas->picture.type() != type) {
    return std::make_shared<Canvas>(Canvas{cv::Mat::zeros(size, type), {}});
  }
  canvas->clear();
  return canvas;
}

void CanvasPool::give(std::shared_ptr<Canvas> canvas) {
  if (!is_free(canvas)) return;
  const std::lock_guard lock(mutex_);
  all_.push_back(std::move(canvas));
}

}  // namespace glidelab::validate
