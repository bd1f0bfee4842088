#include "core/motion/analyze_tracks.h"

#include <atomic>
#include <cassert>
#include <cstddef>

#include "core/motion/join_configurations.h"

namespace glidelab::core {

AnalysisResults analyze_tracks(const std::vector<ClipSetup>& setups, const std::vector<TrackData>& tracks,
                               double gravity_m_s2, const MotionOptions& options, int jobs,
                               const base::Progress& progress) {
  assert(setups.size() == tracks.size());
  AnalysisResults results;
  results.clips.resize(setups.size());
  std::atomic<std::size_t> done = 0;
  base::for_each_parallel(setups.size(), jobs, [&](std::size_t i) {
    results.clips[i] = analyze_motion(setups[i], tracks[i], options);
    results.clips[i].images = tracks[i].images;
    progress("phase diagram", static_cast<double>(++done) / static_cast<double>(setups.size()));
  });
  results.gravity_m_s2 = gravity_m_s2;
  results.configurations = join_configurations(setups, results.clips, gravity_m_s2, options.lines);
  results.estimator = name_of(options.lines);
  return results;
}

}  // namespace glidelab::core
