#include "render/clip_set.h"

#include <set>

#include "base/parallel.h"
#include "render/static_painter.h"

namespace glidelab::render {

ClipSet::ClipSet(const Scenario& scenario, int jobs, const std::function<void()>& drawn)
    : scenario_(as_in_clips(scenario)), rays_(make_ray_table(scenario_.camera, scenario_.vignetting)) {
  double longest_s = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario_.motion.configurations) {
    SetUp& set_up = set_ups_[configuration.group];
    if (set_up.scene.boxes.empty()) set_up.scene = empty_track(scenario_, configuration.body.incline_rad);
    for (const sim::MotionSetup& motion : configuration.motions) {
      clips_.push_back({&configuration, &motion, &set_up});
      longest_s = std::max(longest_s, motion.duration_s);
    }
  }
  std::vector<SetUp*> set_ups;
  for (auto& [name, set_up] : set_ups_) set_ups.push_back(&set_up);
  const double white_e = electrons_of_white(scenario_);
  base::in_parallel(jobs, set_ups.size(), [&](const auto& next) {
    StaticPainter painter(scenario_.camera, rays_, scenario_.focus);
    for (std::size_t i = next(); i < set_ups.size(); i = next()) {
      SetUp& set_up = *set_ups[i];
      set_up.background_e = painter.paint(set_up.scene);
      for (float& value : set_up.background_e.values) {
        value = static_cast<float>(static_cast<double>(value) * white_e);
      }
      if (scenario_.mount.moves()) {
        set_up.fine = fine_picture(scenario_.camera, scenario_.mount, scenario_.focus, set_up.scene, longest_s);
      }
      if (drawn) drawn();
    }
  });
}

ClipRenderer ClipSet::renderer(std::size_t clip, std::uint64_t seed) const {
  const Clip& one = clips_.at(clip);
  return ClipRenderer(scenario_, *one.configuration, one.set_up->scene, rays_, one.set_up->background_e, seed,
                      static_cast<std::uint32_t>(clip), one.set_up->fine ? &*one.set_up->fine : nullptr);
}

ClipCount count_clips(const Scenario& scenario, std::uint64_t seed) {
  ClipCount count;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const FrameClock clock(scenario.recording.clock, scenario.recording.frame_rate_hz, seed,
                             static_cast<std::uint32_t>(count.clips++));
      count.frames += clock.frames_of(frame_count(scenario.recording, motion));
    }
  }
  return count;
}

std::size_t count_set_ups(const Scenario& scenario) {
  std::set<std::string> groups;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations)
    groups.insert(configuration.group);
  return groups.size();
}

FrameClock ClipSet::clock(std::size_t clip, std::uint64_t seed) const {
  return FrameClock(scenario_.recording.clock, scenario_.recording.frame_rate_hz, seed,
                    static_cast<std::uint32_t>(clip));
}

ClipStream::ClipStream(std::shared_ptr<const ClipSet> set, std::size_t clip, std::uint64_t seed)
    : set_(std::move(set)),
      renderer_(set_->renderer(clip, seed)),
      clock_(set_->clock(clip, seed)),
      motions_(set_->configuration(clip).body, set_->motion(clip), set_->scenario().recording, clock_,
               renderer_.longest_step_m(), renderer_.detail()) {}

std::optional<ClipStream::Next> ClipStream::next() {
  while (std::optional<FrameMotion> slot = motions_.next()) {
    const std::size_t number = slot->frame;
    const FrameFate fate = clock_.fate(number);
    if (fate == FrameFate::dropped) continue;
    const double stamp_s = clock_.stamp_s(number);
    const bool repeated = fate == FrameFate::duplicated;
    if (!repeated) shown_ = std::make_shared<const FrameMotion>(std::move(*slot));
    return Next{shown_, number, repeated, stamp_s};
  }
  return std::nullopt;
}

}  // namespace glidelab::render
