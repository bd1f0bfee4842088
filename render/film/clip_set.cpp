#include "render/film/clip_set.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "base/parallel.h"
#include "render/paint/static_painter.h"

namespace glidelab::render {

std::shared_ptr<const Stage> set_stage(const Scenario& before, int jobs, const std::function<void()>& drawn) {
  const Scenario scenario = as_in_clips(before);
  const auto stage = std::make_shared<Stage>();
  stage->rays = make_ray_table(scenario.camera, scenario.vignetting);
  double longest_s = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    Stage::SetUp& set_up = stage->set_ups[configuration.group];
    if (set_up.scene.boxes.empty()) set_up.scene = empty_track(scenario, configuration.body.incline_rad);
    for (const sim::MotionSetup& motion : configuration.motions) longest_s = std::max(longest_s, motion.duration_s);
  }
  std::vector<Stage::SetUp*> set_ups;
  for (auto& [name, set_up] : stage->set_ups) set_ups.push_back(&set_up);
  const double white_e = electrons_of_white(scenario);
  base::in_parallel(jobs, set_ups.size(), [&](const auto& next) {
    StaticPainter painter(scenario.camera, stage->rays, scenario.focus);
    for (std::size_t i = next(); i < set_ups.size(); i = next()) {
      Stage::SetUp& set_up = *set_ups[i];
      set_up.background_e = painter.paint(set_up.scene);
      for (float& value : set_up.background_e.values) {
        value = static_cast<float>(static_cast<double>(value) * white_e);
      }
      if (scenario.mount.moves()) {
        set_up.fine = fine_picture(scenario.camera, scenario.mount, scenario.focus, set_up.scene, longest_s);
      }
      if (drawn) drawn();
    }
  });
  return stage;
}

ClipSet::ClipSet(const Scenario& scenario, int jobs, const std::function<void()>& drawn)
    : ClipSet(scenario, set_stage(scenario, jobs, drawn)) {}

ClipSet::ClipSet(const Scenario& scenario, std::shared_ptr<const Stage> stage)
    : scenario_(as_in_clips(scenario)), stage_(std::move(stage)) {
  for (const sim::ConfigurationSetup& configuration : scenario_.motion.configurations) {
    const auto found = stage_->set_ups.find(configuration.group);
    if (found == stage_->set_ups.end()) throw std::logic_error("the stage has no group " + configuration.group);
    for (const sim::MotionSetup& motion : configuration.motions) {
      clips_.push_back({&configuration, &motion, &found->second});
    }
  }
}

ClipRenderer ClipSet::renderer(std::size_t clip, std::uint64_t seed) const {
  const Clip& one = clips_.at(clip);
  return ClipRenderer(scenario_, *one.configuration, one.set_up->scene, stage_->rays, one.set_up->background_e, seed,
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
