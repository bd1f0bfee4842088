#include "diagnose/tracks/pixel_modes.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPixelError_px = 0.01;
constexpr double kLeastWay_px = 1.0;

}  // namespace

void add_pixel_modes(const core::ClipResult& clip, const std::vector<std::size_t>& frames, std::size_t first_mode,
                     TrackedMotion& motion) {
  std::vector<double> columns, rows;
  auto sighting = clip.sightings.begin();
  for (const std::size_t frame : frames) {
    while (sighting != clip.sightings.end() && sighting->frame < frame) ++sighting;
    if (sighting == clip.sightings.end() || sighting->frame != frame) return;  // of a track
    columns.push_back(sighting->u_px);
    rows.push_back(sighting->v_px);
  }
  if (frames.empty()) return;
  motion.row_px = rows;
  const auto way = [](const std::vector<double>& at) {
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    return *high - *low;
  };
  const std::vector<double>& along = way(columns) >= way(rows) ? columns : rows;
  if (way(along) < kLeastWay_px) return;
  motion.along_px = along;
  motion.m_per_px = way(motion.x_m) / way(along);
  motion.shared_m.resize(std::max(motion.shared_m.size(), first_mode + kPixelModes));
  motion.first_pixel_mode = first_mode;
  for (std::size_t k = 0; k < kPixelModes; ++k) {
    const double turns = k < 2 ? 1.0 : 2.0, phase = k % 2 == 0 ? 0.0 : 0.25;
    std::vector<double>& mode = motion.shared_m[first_mode + k];
    mode.clear();
    for (const double s : along) {
      mode.push_back(kPixelError_px * motion.m_per_px * std::sin(2.0 * std::numbers::pi * (turns * s + phase)));
    }
  }
}

std::vector<std::vector<double>> without_pixel_errors(const std::vector<TrackedMotion>& motions) {
  constexpr double kOutlier = 5.0;  // standard deviations off the neighbours
  constexpr auto kMany = static_cast<Eigen::Index>(kPixelModes);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(kMany, kMany);  // each amplitude N(0, 1) beforehand
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kMany);
  const auto has = [](const TrackedMotion& motion) { return motion.shared_m.size() > motion.first_pixel_mode; };
  for (const TrackedMotion& motion : motions) {
    for (std::size_t i = 2; has(motion) && i + 2 < motion.t_s.size(); ++i) {
      const auto near = motion.outlier.begin() + static_cast<std::ptrdiff_t>(i) - 2;
      if (std::any_of(near, near + 5, [](char out) { return out != 0; })) continue;
      const double off = neighbour_residual(motion.t_s, motion.x_m, i) / motion.sd_m;
      if (std::abs(off) > kOutlier) continue;
      Eigen::VectorXd row(kMany);
      for (Eigen::Index k = 0; k < kMany; ++k) {
        const auto& mode = motion.shared_m[motion.first_pixel_mode + static_cast<std::size_t>(k)];
        row[k] = neighbour_residual(motion.t_s, mode, i) / motion.sd_m;
      }
      normal += row * row.transpose();
      right += off * row;
    }
  }
  const Eigen::MatrixXd amplitude = base::solve_positive(normal, right);
  std::vector<std::vector<double>> without;
  for (const TrackedMotion& motion : motions) {
    without.push_back(motion.x_m);
    for (std::size_t k = 0; has(motion) && k < kPixelModes; ++k) {
      const auto& mode = motion.shared_m[motion.first_pixel_mode + k];
      for (std::size_t p = 0; p < mode.size(); ++p)
        without.back()[p] -= amplitude(static_cast<Eigen::Index>(k), 0) * mode[p];
    }
  }
  return without;
}

}  // namespace glidelab::diagnose
