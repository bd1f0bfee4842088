#include "diagnose/pixel_modes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  motion.m_per_px = way(motion.x_m) / way(along);
  motion.shared_m.resize(std::max(motion.shared_m.size(), first_mode + kPixelModes));
  for (std::size_t k = 0; k < kPixelModes; ++k) {
    const double turns = k < 2 ? 1.0 : 2.0, phase = k % 2 == 0 ? 0.0 : 0.25;
    std::vector<double>& mode = motion.shared_m[first_mode + k];
    mode.clear();
    for (const double s : along) {
      mode.push_back(kPixelError_px * motion.m_per_px * std::sin(2.0 * std::numbers::pi * (turns * s + phase)));
    }
  }
}

}  // namespace glidelab::diagnose
