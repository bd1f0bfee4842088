#include "core/characterize/flat_field_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/catch.h"
#include "tests/core/flat_fields.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr int kWidth = 70, kHeight = 64, kLargest = 1023;

/// Frames whose noise is that of the frame before, in part, and whose light and shading change: nothing averages out.
std::vector<cv::Mat> uneven_frames(std::size_t count) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<cv::Mat> frames;
  cv::Mat last(kHeight, kWidth, CV_64F, cv::Scalar(0.0));
  for (std::size_t f = 0; f < count; ++f) {
    cv::Mat codes(kHeight, kWidth, CV_16U), noise(kHeight, kWidth, CV_64F);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        noise.at<double>(y, x) = 0.4 * last.at<double>(y, x) + 60.0 * normal(random) +
                                 (x > 0 ? 0.3 * noise.at<double>(y, x - 1) : 0.0) -
                                 (y > 0 ? 0.2 * noise.at<double>(y - 1, x) : 0.0);
        const double mean = 80.0 + 9.0 * static_cast<double>(f) + 2.0 * x + (x == 69 ? 900.0 : 0.0);
        codes.at<std::uint16_t>(y, x) =
            static_cast<std::uint16_t>(std::clamp(mean + noise.at<double>(y, x), 0.0, 1.0 * kLargest));
      }
    }
    last = noise;
    frames.push_back(codes);
  }
  return frames;
}

core::FlatFieldStack stacked(const std::vector<cv::Mat>& frames, const cv::Mat& mask) {
  const tests::TempDir dir;
  core::FrameSet set;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    set.files.push_back(dir / (std::to_string(f) + ".png"));
    tests::write_png(set.files.back(), frames[f]);
  }
  return core::stack_frames(set, core::form_of(set.files[0]), kLargest, core::TileGrid(frames[0].size()), mask);
}

/// One cell by the definitions, from its pixels alone: code(p, f).
struct Cell {
  std::vector<cv::Point> pixels;
  std::vector<double> means;  // of each frame
  Cell(const std::vector<cv::Mat>& frames, const cv::Rect& tile, int k, const cv::Mat& mask) {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      for (int x = tile.x; x < tile.x + tile.width; ++x) {
        if (2 * (y % 2) + x % 2 == k && mask.at<std::uint8_t>(y, x) != 0) pixels.emplace_back(x, y);
      }
    }
    for (const cv::Mat& frame : frames) {
      double sum = 0.0;
      for (const cv::Point p : pixels) sum += frame.at<std::uint16_t>(p);
      means.push_back(sum / static_cast<double>(pixels.size()));
    }
  }
};

}  // namespace

TEST_CASE("the statistics of a stack of frames are those of their definitions, cell by cell, with a mask") {
  for (const std::size_t count : {std::size_t{2}, std::size_t{5}}) {
    const std::vector<cv::Mat> frames = uneven_frames(count);
    cv::Mat mask(kHeight, kWidth, CV_8U, cv::Scalar(255));
    mask(cv::Rect(20, 30, 17, 9)).setTo(0);
    const core::FlatFieldStack stack = stacked(frames, mask);
    const core::TileGrid grid({kWidth, kHeight});
    const auto n_frames = static_cast<double>(count);
    cv::Mat residuals[5];
    for (std::size_t f = 0; f < count; ++f) residuals[f] = cv::Mat(kHeight, kWidth, CV_64F, cv::Scalar(0.0));
    core::CellStatistics all;
    std::vector<double> frame_sums(count, 0.0);
    REQUIRE(stack.frames == count);
    REQUIRE(stack.cells.size() == 4 * grid.tiles());
    for (std::size_t tile = 0; tile < grid.tiles(); ++tile) {
      for (int k = 0; k < 4; ++k) {
        const Cell cell(frames, grid.tile(tile), k, mask);
        const auto n = static_cast<double>(cell.pixels.size());
        core::CellStatistics expected;
        expected.pixels = n;
        double temporal = 0.0, total = 0.0;
        for (const cv::Point p : cell.pixels) {
          std::vector<double> e;
          double mean = 0.0;
          for (std::size_t f = 0; f < count; ++f) {
            const double code = frames[f].at<std::uint16_t>(p);
            e.push_back(code - cell.means[f]);
            residuals[f].at<double>(p) = e.back();
            mean += e.back() / n_frames;
            total += e.back() * e.back();
            expected.mean_dn += code / (n * n_frames);
            expected.at_zero += (code == 0.0 ? 1.0 : 0.0) / (n * n_frames);
            expected.at_largest += (code == kLargest ? 1.0 : 0.0) / (n * n_frames);
            frame_sums[f] += code;
          }
          for (const double one : e) temporal += (one - mean) * (one - mean) / (n_frames - 1.0);
        }
        expected.temporal_dn2 = temporal / (n - 1.0);
        expected.total_dn2 = total / ((n - 1.0) * n_frames);
        const core::CellStatistics& found = stack.cells[4 * tile + static_cast<std::size_t>(k)];
        INFO(count << " frames, tile " << tile << ", cell " << k);
        CHECK(found.pixels == n);
        // Sums of some 60 numbers of up to 1e6 in double; residuals are kept in single precision, 6e-8 of each.
        CHECK(std::abs(found.mean_dn - expected.mean_dn) < 1e-9);
        CHECK(std::abs(found.temporal_dn2 / expected.temporal_dn2 - 1.0) < 1e-6);
        CHECK(std::abs(found.total_dn2 / expected.total_dn2 - 1.0) < 1e-6);
        CHECK(std::abs(found.at_zero - expected.at_zero) < 1e-12);
        CHECK(std::abs(found.at_largest - expected.at_largest) < 1e-12);
        all.pixels += n;
        all.mean_dn += n * expected.mean_dn;
        all.temporal_dn2 += n * expected.temporal_dn2;
        all.total_dn2 += n * expected.total_dn2;
        all.at_zero += n * expected.at_zero;
        all.at_largest += n * expected.at_largest;
      }
    }
    REQUIRE(all.at_zero > 0.0);
    REQUIRE(all.at_largest > 0.0);
    CHECK(stack.all.pixels == all.pixels);
    CHECK(std::abs(stack.all.mean_dn - all.mean_dn / all.pixels) < 1e-9);
    CHECK(std::abs(stack.all.temporal_dn2 / (all.temporal_dn2 / all.pixels) - 1.0) < 1e-6);
    CHECK(std::abs(stack.all.total_dn2 / (all.total_dn2 / all.pixels) - 1.0) < 1e-6);
    CHECK(std::abs(stack.all.at_zero - all.at_zero / all.pixels) < 1e-12);
    CHECK(std::abs(stack.all.at_largest - all.at_largest / all.pixels) < 1e-12);

    // Frames against each other.
    double self = 0.0, right = 0.0, below = 0.0, one = 0.0, two = 0.0;
    const auto square = [&](std::size_t a, std::size_t b, const cv::Point& p) {
      return std::pow(residuals[a].at<double>(p) - residuals[b].at<double>(p), 2);
    };
    const double even = std::ceil(n_frames / 2.0), odd = n_frames - even;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const cv::Point p(x, y);
        double mean = 0.0, plus = 0.0, minus = 0.0;
        for (std::size_t f = 0; f < count; ++f) {
          mean += frames[f].at<std::uint16_t>(p) / n_frames;
          if (mask.at<std::uint8_t>(p) != 0) (f % 2 == 0 ? plus : minus) += residuals[f].at<double>(p);
        }
        CHECK(std::abs(stack.mean_dn.at<float>(p) - mean) < 1e-4);
        if (mask.at<std::uint8_t>(p) == 0) continue;
        // (mean of the even frames - mean of the odd ones), as noisy as the mean of all: sd² (1/even + 1/odd) = sd²/n.
        const double contrast = (plus / even - minus / odd) * std::sqrt(1.0 / n_frames / (1.0 / even + 1.0 / odd));
        CHECK(std::abs(stack.contrast_dn.at<float>(p) - contrast) < 1e-4);
        for (std::size_t f = 2; f < count; ++f) {
          one += square(f, f - 1, p) + square(f - 1, f - 2, p);
          two += 2.0 * square(f, f - 2, p);
        }
        if (x + 1 == kWidth || y + 1 == kHeight || mask.at<std::uint8_t>(y, x + 1) == 0 ||
            mask.at<std::uint8_t>(y + 1, x) == 0) {
          continue;
        }
        const auto apart = [&](int u, int v) { return residuals[1].at<double>(v, u) - residuals[0].at<double>(v, u); };
        self += apart(x, y) * apart(x, y);
        right += apart(x, y) * apart(x + 1, y);
        below += apart(x, y) * apart(x, y + 1);
      }
    }
    CHECK(std::abs(stack.correlation_right - right / self) < 1e-6);
    CHECK(std::abs(stack.correlation_below - below / self) < 1e-6);
    CHECK(stack.successive_ratio.has_value() == (count > 2));
    if (stack.successive_ratio) CHECK(std::abs(*stack.successive_ratio / (one / two) - 1.0) < 1e-6);
    for (std::size_t f = 0; f < count; ++f) {
      CHECK(std::abs(stack.frame_means_dn.at(f) - frame_sums[f] / all.pixels) < 1e-9);
    }
  }
}

TEST_CASE("frames of one code have no noise, no correlation and no ratio") {
  const std::vector<cv::Mat> frames(3, cv::Mat(kHeight, kWidth, CV_16U, cv::Scalar(17)));
  const core::FlatFieldStack stack = stacked(frames, {});
  CHECK(stack.all.temporal_dn2 == 0.0);
  CHECK(stack.correlation_right == 0.0);
  CHECK(stack.correlation_below == 0.0);
  CHECK_FALSE(stack.successive_ratio.has_value());
}
