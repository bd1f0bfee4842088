/// Results made by hand from the closed form of a(v), for tests of what is written about them.
#pragma once

#include <cmath>

#include "core/result/results.h"

namespace glidelab::tests {

inline core::Quantity known(double value, double sd) {
  return {core::Estimate{value, sd, value - 1.96 * sd, value + 1.96 * sd}, {}};
}

inline core::LineFit made_line(int direction, double k_over_m, double a0) {
  core::LineFit line;
  line.direction = direction;
  line.points = 100;
  line.k_over_m_1_s = *known(k_over_m, 0.006).estimate;
  line.a0_m_s2 = *known(a0, 0.002).estimate;
  line.r2 = 0.99993;
  line.from_v_m_s = direction < 0 ? -1.2 : 0.02;
  line.to_v_m_s = direction < 0 ? -0.02 : 0.23;
  return line;
}

/// A glider thrown uphill: decelerates, turns, and approaches its terminal velocity. v(t) follows the two lines
/// exactly.
inline core::ClipResult made_clip(const std::string& name, double k_over_m, double a0_up, double a0_down,
                                  std::size_t frames = 300) {
  core::ClipResult clip;
  clip.name = name;
  clip.experiment = "made by hand";
  clip.frames = frames;
  clip.detected = frames - 1;
  clip.frame_rate_hz = 200.0;
  clip.bandwidth_s = 0.043;
  clip.bandwidth_method = core::chosen_by::User{};
  clip.position_noise_m = 2.1e-5;
  clip.segments = {made_line(-1, k_over_m, a0_up), made_line(1, k_over_m, a0_down)};
  clip.v_lim_m_s = known(a0_down / k_over_m, 0.0004);
  double x = 0.2;
  double v = -1.2;
  for (std::size_t k = 0; k < frames; ++k) {
    core::MotionPoint point;
    point.t_s = static_cast<double>(k) / 200.0;
    point.x_m = x;
    point.v_m_s = v;
    point.a_m_s2 = (v < 0.0 ? a0_up : a0_down) - k_over_m * v + 0.004 * std::sin(1.7 * static_cast<double>(k));
    point.sd_x_m = 1e-5;
    point.sd_v_m_s = 0.001;
    point.sd_a_m_s2 = 0.02;
    point.smoothed = true;
    if (k != 7) point.measured_m = x;
    const bool end = k < 20 || k + 20 >= frames;
    const bool reversal = std::abs(v) < 0.02;
    point.left_out = k == 7     ? core::LeftOut::no_marker
                     : end      ? core::LeftOut::kernel_end
                     : reversal ? core::LeftOut::kernel_reversal
                                : core::LeftOut::used;
    clip.motion.push_back(point);
    v += point.a_m_s2 / 200.0;
    x += v / 200.0;
  }
  clip.left_out = {{0.0, 0.1, 20, core::LeftOut::kernel_end},
                   {static_cast<double>(frames - 20) / 200.0, static_cast<double>(frames - 1) / 200.0, 20,
                    core::LeftOut::kernel_end}};
  clip.stretches = {{0.1, 0.4, -1, 60}, {0.42, 1.4, 1, 100}};
  return clip;
}

inline core::ConfigurationResult made_configuration(double mass_kg, const std::string& clip, double k_over_m,
                                                    double a0_up, double a0_down) {
  core::ConfigurationResult configuration;
  configuration.mass_kg = mass_kg;
  configuration.incline_deg = 4.0;
  configuration.group = "flat";
  configuration.clips = {clip};
  configuration.lines = {made_line(-1, k_over_m, a0_up), made_line(1, k_over_m, a0_down)};
  configuration.k_over_m_1_s = known(k_over_m, 0.006);
  configuration.mu = known(0.0071, 0.0001);
  configuration.alpha_deg = known(4.311, 0.006);
  configuration.v_lim_m_s = known(a0_down / k_over_m, 0.0004);
  return configuration;
}

/// Two masses on one inclination.
inline core::AnalysisResults made_results() {
  core::AnalysisResults results;
  results.clips = {made_clip("m1-up", 2.768, 0.8063, 0.667), made_clip("m2-up", 2.1307, 0.7803, 0.6874)};
  results.configurations = {made_configuration(0.335, "m1-up", 2.768, 0.8063, 0.667),
                            made_configuration(0.435, "m2-up", 2.1307, 0.7803, 0.6874)};
  core::CalibrationResult calibration;
  calibration.experiment = "made by hand";
  calibration.rms_px = 0.04;
  calibration.camera_matrix = {800.0, 0.0, 399.5, 0.0, 800.0, 299.5, 0.0, 0.0, 1.0};
  calibration.distortion = {-0.1, 0.01, 0.0, 0.0, 0.0};
  calibration.restitution_rms_m = 2e-5;
  calibration.views_used = 12;
  results.calibrations = {calibration};
  return results;
}

}  // namespace glidelab::tests
