/// A clip of a small scenario, frame by frame in memory, for the tests of what a camera does to it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/files/file_io.h"
#include "render/film/clip_renderer.h"
#include "render/film/truth_files.h"
#include "render/paint/static_painter.h"
#include "tests/temp_dir.h"

namespace glidelab::render::tests {

inline Scenario scenario_of(const std::string& text) {
  const glidelab::tests::TempDir dir;
  base::write_file(dir / "s.toml", "format = 1\nname = \"t\"\n" + text);
  return read_scenario(dir / "s.toml");
}

/// Everything that the frames of a scenario's first clip are made of.
struct MadeClip {
  Scenario scenario;  ///< as in the clips
  const sim::ConfigurationSetup& configuration = scenario.motion.configurations.front();
  RayTable rays = make_ray_table(scenario.camera, scenario.vignetting);
  StaticScene scene = empty_track(scenario, configuration.body.incline_rad);
  FloatImage background_e;
  std::optional<FineImage> fine;

  explicit MadeClip(const Scenario& read) : scenario(as_in_clips(read)) {
    background_e = StaticPainter(scenario.camera, rays, scenario.focus).paint(scene);
    for (float& value : background_e.values) value *= static_cast<float>(electrons_of_white(scenario));
    if (scenario.mount.moves()) {
      fine =
          fine_image(scenario.camera, scenario.mount, scenario.focus, scene, configuration.motions.front().duration_s);
    }
  }
  MadeClip(const MadeClip&) = delete;
  MadeClip& operator=(const MadeClip&) = delete;

  ClipRenderer renderer() const {
    return ClipRenderer(scenario, configuration, scene, rays, background_e, 1, 0, fine ? &*fine : nullptr);
  }
  void each_frame(const std::function<void(const FrameMotion&, ClipRenderer&)>& visit) const {
    ClipRenderer made = renderer();
    for_each_frame(
        configuration.body, configuration.motions.front(), scenario.recording, made.longest_step_m(),
        [&](const FrameMotion& frame) { visit(frame, made); }, made.detail());
  }
};

}  // namespace glidelab::render::tests
