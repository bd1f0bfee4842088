#include "render/film/marker_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/math/extent.h"
#include "render/film/truth_files.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

std::vector<ClipView> views_of(const Scenario& scenario) {
  const Scenario seen_by = as_in_clips(scenario);
  constexpr double kWholeExposure_m = 1e3;  // one instant represents an exposure: nothing is drawn
  std::vector<ClipView> views;
  for (const sim::ConfigurationSetup& configuration : seen_by.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      ClipView view;
      view.clip = motion.name;
      base::Extent moved, seen;
      const auto visit = [&](const FrameMotion& frame) {
        ++view.frames;
        moved.include(frame.middle.x_m);
        if (marker_in_image(seen_by, configuration.body, frame)) {
          seen.include(frame.middle.x_m);
        } else {
          ++view.outside;
        }
      };
      for_each_frame(configuration.body, motion, seen_by.recording, kWholeExposure_m, visit, MotionDetail::path);
      view.moved_m = moved.length();
      view.seen_m = seen.length();
      views.push_back(std::move(view));
    }
  }
  return views;
}

std::string sentence(const ClipView& view) {
  return fmt::format(
      "{}: the marker leaves the image in {} of {} frames: the camera sees {:.2f} m of the {:.2f} m that it moves",
      view.clip, view.outside, view.frames, view.seen_m, view.moved_m);
}

}  // namespace glidelab::render
