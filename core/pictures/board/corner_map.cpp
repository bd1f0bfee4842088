#include "core/pictures/board/corner_map.h"

#include <algorithm>
#include <cmath>

namespace glidelab::core {
namespace {

constexpr int kCellsAlongLongSide = 8;  // cells

struct Sums {
  cv::Point2d at, off;
  double squares = 0.0, count = 0.0;
};

}  // namespace

void add_rests(const std::vector<cv::Point2d>& corners, const Eigen::VectorXd& residual,
               std::vector<CornerRest>& rests) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 * k);
    rests.push_back({corners[k], {residual[row], residual[row + 1]}});
  }
}

CornerMap corner_map(cv::Size image, const std::vector<CornerRest>& rests) {
  const double side = static_cast<double>(std::max(image.width, image.height)) / kCellsAlongLongSide;
  const int columns = std::max(1, static_cast<int>(image.width / side));
  const int rows = std::max(1, static_cast<int>(image.height / side));
  std::vector<Sums> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto cell = [](double at, int size, int cells) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor((at + 0.5) * cells / size)), 0, cells - 1));
  };
  for (const CornerRest& rest : rests) {
    Sums& of = sums[cell(rest.at.y, image.height, rows) * static_cast<std::size_t>(columns) +
                    cell(rest.at.x, image.width, columns)];
    of.at += rest.at;
    of.off += rest.off;
    of.squares += rest.off.dot(rest.off);
    of.count += 1.0;
  }
  CornerMap map;
  map.width_px = image.width;
  map.height_px = image.height;
  double scatter = 0.0, free = 0.0, means = 0.0;
  for (const Sums& of : sums) {
    if (of.count < 2.0) continue;
    scatter += of.squares - of.off.dot(of.off) / of.count;
    free += 2.0 * (of.count - 1.0);
    means += of.off.dot(of.off) / of.count;
    map.cells.push_back({of.at.x / of.count, of.at.y / of.count, of.off.x / of.count, of.off.y / of.count, 0.0,
                         static_cast<std::size_t>(of.count)});
  }
  if (map.cells.empty()) return map;
  map.scatter_px = std::sqrt(scatter / free);
  for (CornerCell& one : map.cells) one.sd_px = map.scatter_px / std::sqrt(static_cast<double>(one.corners));
  if (map.scatter_px > 0.0) {
    map.excess = std::sqrt(means / (2.0 * static_cast<double>(map.cells.size()))) / map.scatter_px;
  }
  return map;
}

}  // namespace glidelab::core
