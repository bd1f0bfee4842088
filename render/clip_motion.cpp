#include "render/clip_motion.h"

#include <algorithm>
#include <cmath>

namespace glidelab::render {

std::size_t frame_count(const Recording& recording, const sim::MotionSetup& motion) {
  const double last_start = motion.duration_s - recording.exposure_s;
  // A whole number of frame times that rounding made a little shorter still counts.
  return last_start <= 0.0 ? 1 : static_cast<std::size_t>(std::floor(last_start * recording.frame_rate_hz + 1e-9)) + 1;
}

void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    double longest_step_m, const std::function<void(const FrameMotion&)>& visit) {
  constexpr std::size_t kChunk = 1024;
  const std::size_t frames = frame_count(recording, motion);
  double x0_m = motion.x0_m;
  double v0_m_s = motion.v0_m_s;
  for (std::size_t first = 0; first < frames; first += kChunk) {
    const std::size_t count = std::min(kChunk, frames - first);
    const auto start_of = [&](std::size_t i) { return static_cast<double>(i) / recording.frame_rate_hz; };
    // Once for the middles, which say how fast the glider is; then for the parts of each exposure.
    std::vector<double> times;
    for (std::size_t i = 0; i < count; ++i) times.push_back(start_of(i) + 0.5 * recording.exposure_s);
    times.push_back(start_of(count));
    const sim::Trajectory middles = sim::simulate(body, x0_m, v0_m_s, times);

    std::vector<double> part_times;
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < count; ++i) {
      const double length = std::abs(middles.states[i].v_m_s) * recording.exposure_s;
      const auto n = static_cast<std::size_t>(std::max(1.0, std::ceil(length / longest_step_m)));
      parts.push_back(n);
      for (std::size_t k = 0; k < n; ++k) {
        part_times.push_back(start_of(i) +
                             (static_cast<double>(k) + 0.5) / static_cast<double>(n) * recording.exposure_s);
      }
    }
    part_times.push_back(start_of(count));
    const sim::Trajectory inside = sim::simulate(body, x0_m, v0_m_s, part_times);
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      FrameMotion frame;
      frame.frame = first + i;
      frame.middle = middles.states[i];
      frame.middle.t_s = static_cast<double>(first + i) / recording.frame_rate_hz;
      for (std::size_t k = 0; k < parts[i]; ++k) frame.x_m.push_back(inside.states[at++].x_m);
      visit(frame);
    }
    x0_m = inside.states.back().x_m;
    v0_m_s = inside.states.back().v_m_s;
  }
}

}  // namespace glidelab::render
