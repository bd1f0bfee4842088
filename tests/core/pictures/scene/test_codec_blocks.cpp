#include "core/pictures/scene/camera_traces.h"

#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr int kWidth = 320, kHeight = 120;

core::BlockSteps steps_of(unsigned seed, double block_code, const std::vector<int>& edges = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  core::BlockStepSums sums;
  for (int k = 0; k < 24; ++k) {
    cv::Mat_<double> blocks(kHeight / 8, kWidth / 8);
    for (double& one : blocks) one = block_code * noise(random);
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v) {
      double scene = 80.0;
      for (int u = 0; u < kWidth; ++u) {
        for (const int edge : edges) scene += edge == u ? 9.0 : 0.0;
        image(v, u) = cv::saturate_cast<unsigned char>(scene + blocks(v / 8, u / 8) + noise(random));
      }
    }
    sums.add(image);
  }
  return sums.finish();
}

core::ImageRecord record_of(const core::BlockSteps& steps) {
  core::ImageRecord record;
  record.steps = steps;
  return record;
}

}  // namespace

TEST_CASE("blocks of eight pixels show at their edges, as large as they differ", "[blocks]") {
  const core::BlockSteps steps = steps_of(5, 2.0);
  const core::BlockEdges edges = core::block_edges(steps);
  // The mean of |N(0, s)| goes with s: sqrt(2 (1 + 1/12) + 2 2²) over sqrt(2 (1 + 1/12)) at the edges, with rounding.
  const double expected = std::sqrt(1.0 + 4.0 / (1.0 + 1.0 / 12.0)) - 1.0;
  CHECK(edges.relative == Approx(expected).epsilon(0.1));
  CHECK(edges.z > 10.0);
  CHECK(core::through_lossy_codec(record_of(steps)));
  CHECK(core::sure_block_steps(steps) == edges.relative);
}

TEST_CASE("an image without blocks has none, nor do upright edges in the scene make them", "[blocks]") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CHECK(core::block_edges(steps_of(seed, 0.0)).z < 5.0);
  }
  const core::BlockSteps edges = steps_of(3, 0.0, {32, 96, 160, 240, 296});  // all where blocks would meet
  CHECK(core::block_edges(edges).z < 5.0);
  CHECK_FALSE(core::through_lossy_codec(record_of(edges)));
  CHECK(core::sure_block_steps(edges) == 0.0);
}

TEST_CASE("a codec's smooth blocks are no scatter of its columns", "[blocks]") {
  core::BlockSteps steps;
  steps.mean = {1.8, 0.9, 1.15, 0.75, 0.6, 0.75, 1.15, 0.9};  // as of a transform's waves: even about the middle
  CHECK(core::block_edges(steps).z > 10.0);
  steps.mean = {1.3, 0.7, 1.3, 0.7, 1.3, 0.7, 1.3, 0.7};  // every second pixel was made from its neighbours
  CHECK(core::block_edges(steps).z < 1.0);
  steps.mean = {1.3, 1.0, 0.8, 1.1, 0.9, 1.25, 1.0, 0.85};  // a scene's columns
  CHECK(core::block_edges(steps).z < 1.0);
}

TEST_CASE("what the file says needs no blocks, and a clip without pixels has none", "[blocks]") {
  core::ImageRecord record;
  CHECK_FALSE(core::through_lossy_codec(record));
  record.lossy = true;
  CHECK(core::through_lossy_codec(record));
  CHECK(core::block_edges(core::BlockStepSums().finish()).z == 0.0);
}
