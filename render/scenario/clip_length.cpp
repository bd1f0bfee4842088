#include "render/scenario/clip_length.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "render/scenario/clip_motion.h"

namespace glidelab::render {

void check_states(const sim::MotionScenario& scenario, const Recording& recording, const std::string& file,
                  const std::string& key) {
  constexpr double kBytesOfRow = 65.0;  // of the CSV
  for (const sim::ConfigurationSetup& configuration : scenario.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const std::size_t states = frame_count(recording, motion);
      if (states <= kMostFrames) continue;
      throw base::InputError(base::Issue{
          file, 0, key,
          fmt::format("{:.6g} Hz, for clip \"{}\" of {:.6g} s {} states or {:.3g} GB", recording.frame_rate_hz,
                      motion.name, motion.duration_s, states, 1e-9 * kBytesOfRow * static_cast<double>(states)),
          fmt::format("at most {} states in a clip, {:.6g} Hz", kMostFrames,
                      static_cast<double>(kMostFrames) / motion.duration_s)});
    }
  }
}

}  // namespace glidelab::render
