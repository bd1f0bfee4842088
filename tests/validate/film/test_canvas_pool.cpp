#include "validate/film/film_studio.h"

#include "tests/catch.h"

using namespace glidelab;

namespace {

std::shared_ptr<validate::Canvas> drawn_on(validate::CanvasPool& pool) {
  const std::shared_ptr<validate::Canvas> canvas = pool.take({40, 30}, CV_8U);
  const cv::Rect part(3, 4, 5, 6);
  canvas->image(part).setTo(200);
  canvas->drawn.push_back(part);
  return canvas;
}

}  // namespace

TEST_CASE("a canvas that is given back is used again, and clear") {
  validate::CanvasPool pool;
  std::shared_ptr<validate::Canvas> canvas = drawn_on(pool);
  const unsigned char* const pixels = canvas->image.data;
  pool.give(std::move(canvas));
  const std::shared_ptr<validate::Canvas> again = pool.take({40, 30}, CV_8U);
  CHECK(again->image.data == pixels);
  CHECK(cv::countNonZero(again->image) == 0);
  CHECK(again->drawn.empty());
}

TEST_CASE("an image that somebody still looks at is not drawn on again") {
  validate::CanvasPool pool;
  std::shared_ptr<validate::Canvas> canvas = drawn_on(pool);
  const cv::Mat kept = canvas->image;
  pool.give(std::move(canvas));
  CHECK(pool.take({40, 30}, CV_8U)->image.data != kept.data);
  CHECK(cv::countNonZero(kept) == 30);
}

TEST_CASE("a canvas of another size or depth is a new one") {
  validate::CanvasPool pool;
  pool.give(drawn_on(pool));
  CHECK(pool.take({30, 40}, CV_8U)->image.size() == cv::Size(30, 40));
  pool.give(drawn_on(pool));
  const std::shared_ptr<validate::Canvas> deep = pool.take({40, 30}, CV_16U);
  CHECK(deep->image.type() == CV_16U);
  CHECK(cv::countNonZero(deep->image) == 0);
}
