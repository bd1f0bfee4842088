/// What the generalised line (gls_line.h) is fitted to: free stretches up to the estimated times at which they turn or
/// come to rest, and what is known of their noise.
#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/free/event_time.h"
#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"

namespace glidelab::core {

/// Points first … first + count - 1 of the motion: free, of one direction, up to the events at their ends.
struct FreePiece {
  std::size_t first = 0;
  std::size_t count = 0;
  int direction = 0;
};

/// The stretches up to their estimated ends. Where a stretch turns into the reversed one or comes to rest the event's
/// time is estimated from three bandwidths on both sides (event_time.h), and the stretch reaches up to two standard
/// deviations from it; where that fails, and at other borders (a hand, a bumper), a bandwidth is left out. At the
/// data's own ends nothing is.
std::vector<FreePiece> free_pieces(const Motion& motion, const FreeMotion& free, double bandwidth_s,
                                   const std::vector<double>& autocovariance);

struct GlsInput {
  double bandwidth_s = 0.0;
  std::vector<double> autocovariance;
  std::vector<double> noise_factor = {};  ///< of every point of the motion (speed_dependent_noise.h); empty: 1
  double k_start_1_s = 0.0;               ///< where the search for k begins
  double scale_sd_relative = 0.0;
  double mass_kg = 0.0;  ///< with a known force only
  double mass_sd_kg = 0.0;
  std::vector<double> law_m_s2;               ///< with a known force only: f(v(t)) at every point (bandwidth.h)
  std::vector<std::vector<double>> shared_m;  ///< as in TrackData
};

}  // namespace glidelab::core
