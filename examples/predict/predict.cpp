/// A motion with viscous drag, Coulomb friction and gravity, measured 200 times a second without noise, and the lines
/// that the analysis draws through its phase diagram: what a program of your own does with Glidelab's libraries.
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"

int main() {
  using namespace glidelab;
  sim::Body body;
  body.mass_kg = 0.335;
  body.incline_rad = 4.0 * std::numbers::pi / 180.0;
  const double k_n_s_m = 0.93, mu = 0.007;
  body.forces = {sim::laws::viscous().with({k_n_s_m}), sim::laws::coulomb().with({mu})};

  std::vector<double> times_s;
  for (int frame = 0; frame < 360; ++frame) times_s.push_back(frame / 200.0);
  const sim::Trajectory motion = sim::simulate(body, 0.0, -1.2, times_s);

  core::ClipSetup setup;
  setup.name = "up";
  setup.mass_kg = body.mass_kg;
  core::TrackData track;
  track.frame_rate_hz = 200.0;
  for (const sim::State& state : motion.states) {
    track.frame.push_back(track.t_s.size());
    track.frame_t_s.push_back(state.t_s);
    track.t_s.push_back(state.t_s);
    track.x_m.push_back(state.x_m);
  }
  core::MotionOptions options;
  options.bandwidth_s = 0.02;
  const core::ClipResult clip = core::analyze_motion(setup, track, options);
  std::printf("true K/m %.5f 1/s\n", k_n_s_m / body.mass_kg);
  for (const core::LineFit& line : clip.segments) {
    std::printf("%s: a = %.5f m/s2 - %.5f 1/s v, R2 %.7f\n", line.direction < 0 ? "up  " : "down", line.a0_m_s2.value,
                line.k_over_m_1_s.value, line.r2);
  }
  // Both lines together, with the kernel's bias taken off.
  for (const core::ConfigurationResult& recovered : core::configurations_of_clips({setup}, {clip}, body.gravity_m_s2)) {
    if (!recovered.k_over_m_1_s.estimate) continue;
    const core::Estimate& k_over_m = *recovered.k_over_m_1_s.estimate;
    std::printf("recovered K/m %.5f 1/s\n", k_over_m.value);
  }
  return clip.segments.size() == 2 ? 0 : 1;
}
