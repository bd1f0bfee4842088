#include "core/check/marker_smear.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace glidelab::core {

std::optional<MarkerSmear> marker_smear(const std::vector<MarkerSighting>& sightings,
                                        const std::vector<MarkerFit>& fits, double frame_rate_hz) {
  constexpr std::size_t kFewest = 20;
  constexpr double kClear = 5.0;  // standard deviations
  if (fits.size() != sightings.size()) return std::nullopt;
  std::vector<double> speed2, excess;  // px²/s², px²
  double way_u = 0.0, way_v = 0.0;     // of the fastest step: the glider runs along one line
  for (std::size_t i = 1; i + 1 < sightings.size(); ++i) {
    if (sightings[i + 1].frame - sightings[i - 1].frame != 2) continue;
    const double u = sightings[i + 1].u_px - sightings[i - 1].u_px, v = sightings[i + 1].v_px - sightings[i - 1].v_px;
    if (std::hypot(u, v) > std::hypot(way_u, way_v)) way_u = u, way_v = v;
  }
  const double length = std::hypot(way_u, way_v);
  if (!(length > 0.0)) return std::nullopt;
  const double c = way_u / length, s = way_v / length;
  for (std::size_t i = 1; i + 1 < sightings.size(); ++i) {
    if (sightings[i + 1].frame - sightings[i - 1].frame != 2) continue;
    const double u = sightings[i + 1].u_px - sightings[i - 1].u_px, v = sightings[i + 1].v_px - sightings[i - 1].v_px;
    const cv::Vec3d& m = fits[i].moments;
    speed2.push_back(0.25 * (u * u + v * v) * frame_rate_hz * frame_rate_hz);
    excess.push_back((c * c - s * s) * (m[0] - m[2]) + 4.0 * c * s * m[1]);
  }
  const auto n = static_cast<double>(speed2.size());
  if (speed2.size() < kFewest) return std::nullopt;
  const double mean_x = std::accumulate(speed2.begin(), speed2.end(), 0.0) / n;
  const double mean_y = std::accumulate(excess.begin(), excess.end(), 0.0) / n;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < speed2.size(); ++i) {
    xx += (speed2[i] - mean_x) * (speed2[i] - mean_x);
    xy += (speed2[i] - mean_x) * (excess[i] - mean_y);
    yy += (excess[i] - mean_y) * (excess[i] - mean_y);
  }
  if (!(xx > 0.0)) return std::nullopt;
  const double slope = xy / xx;
  const double sd = std::sqrt(std::max(0.0, yy - slope * xy) / (n - 2.0) / xx);
  if (!(slope > 0.0) || slope < kClear * sd) return std::nullopt;
  const double exposure_s = std::sqrt(12.0 * slope);
  return MarkerSmear{exposure_s, 6.0 * sd / exposure_s};  // dT = 12 dslope / (2 T)
}

}  // namespace glidelab::core
