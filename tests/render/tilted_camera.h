/// A tilted camera with a lens, off the middle of the track, that sees one glider on an incline.
#pragma once

#include "render/camera/camera.h"
#include "render/scenario/scenario.h"

namespace glidelab::tests {

inline render::Scenario tilted_camera() {
  render::Scenario scenario;
  scenario.camera.width_px = 800;
  scenario.camera.height_px = 600;
  scenario.camera.focal_px = {1200.0, 1200.0};
  scenario.camera.center_px = {404.0, 296.0};
  scenario.camera.lens = {-0.12, 0.06, 0.0, 0.0004, -0.0003};
  scenario.camera.X_WC = render::look_at({0.14, 0.12, 2.4}, {0.0, 0.0, 0.0}, 0.012);
  sim::ConfigurationSetup configuration;
  configuration.body.mass_kg = 0.335;
  configuration.body.incline_rad = 0.07;
  scenario.motion.configurations.push_back(configuration);
  return scenario;
}

}  // namespace glidelab::tests
