#include "core/phase_diagram.h"

#include <algorithm>
#include <cmath>

#include "core/line_fit.h"
#include "core/local_cubic.h"

namespace glidelab::core {

// THIN: one stretch, fixed bandwidth, white noise from second differences; deepened next.
ClipResult analyze_motion(const ClipSetup& setup, const TrackData& track, std::optional<double> bandwidth_s, double) {
  ClipResult clip;
  clip.name = setup.name;
  clip.frames = track.frame_t_s.size();
  clip.detected = track.t_s.size();
  clip.frame_rate_hz = track.frame_rate_hz;
  clip.sightings = track.sightings;
  clip.notes = track.notes;
  clip.bandwidth_s = bandwidth_s.value_or(0.03);
  clip.bandwidth_method = bandwidth_s ? "given" : "fixed for now";
  const LocalCubic cubic(track.t_s, clip.bandwidth_s);
  double sum = 0.0;
  for (std::size_t i = 2; i + 2 < track.x_m.size(); ++i) {
    const double fourth =
        track.x_m[i - 2] - 4 * track.x_m[i - 1] + 6 * track.x_m[i] - 4 * track.x_m[i + 1] + track.x_m[i + 2];
    sum += fourth * fourth / 70.0;
  }
  clip.position_noise_m = std::sqrt(sum / static_cast<double>(track.x_m.size()));
  const std::vector<double> autocovariance{clip.position_noise_m * clip.position_noise_m};
  const auto smoothed = cubic.smooth(track.x_m);
  LineInput input[2];
  for (std::size_t frame = 0, i = 0; frame < clip.frames; ++frame) {
    MotionPoint point;
    point.t_s = track.frame_t_s[frame];
    point.left_out = LeftOut::no_marker;
    if (i < track.t_s.size() && track.frame[i] == frame) {
      point.measured_m = track.x_m[i];
      point.left_out = LeftOut::kernel_gap;
      if (smoothed[i]) {
        point.smoothed = true;
        point.x_m = smoothed[i]->x_m;
        point.v_m_s = smoothed[i]->v_m_s;
        point.a_m_s2 = smoothed[i]->a_m_s2;
        const auto row = *cubic.row_of_point(i);
        point.sd_x_m = std::sqrt(noise_variance(row.weights->x, autocovariance));
        point.sd_v_m_s = std::sqrt(noise_variance(row.weights->v, autocovariance));
        point.sd_a_m_s2 = std::sqrt(noise_variance(row.weights->a, autocovariance));
        const double margin = 2.5 * clip.bandwidth_s;
        const bool over_end = point.t_s < track.t_s.front() + margin || point.t_s > track.t_s.back() - margin;
        const bool turning = std::abs(point.v_m_s) < std::abs(point.a_m_s2) * margin;
        point.left_out = over_end ? LeftOut::kernel_end : turning ? LeftOut::kernel_reversal : LeftOut::used;
        if (point.left_out == LeftOut::used) {
          LineInput& of = input[point.v_m_s > 0.0];
          of.track_points = track.t_s.size();
          of.v_m_s.push_back(point.v_m_s);
          of.a_m_s2.push_back(point.a_m_s2);
          of.rows.push_back(row);
          of.bias_a_m_s2.push_back(0.0);
          of.mass_part_m_s2.push_back(0.0);
        }
      }
      ++i;
    }
    clip.motion.push_back(point);
  }
  for (const int direction : {-1, 1}) {
    const auto line = fit_line(direction, input[direction > 0], autocovariance, track.scale_sd_relative);
    if (line) clip.segments.push_back(*line);
  }
  clip.v_lim_m_s = limit_velocity(clip.segments);
  return clip;
}

}  // namespace glidelab::core
