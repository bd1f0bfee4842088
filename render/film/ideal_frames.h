/// The second product of a render: frames as a perfect camera would take them, and where the marker is in each.
///
/// Ideal frames are sharp in every way (no lens distortion, no blur, an instant for an exposure, no vignetting, an
/// even light, a mount at rest, no noise), by the same pinhole at rest, at each frame's time (the middle of the middle
/// row's exposure; slot by slot of a clock without error, jitter, dropped and repeated frames). They have 8 bits: the
/// code is 0.75 · 255 times the radiance, rounded and limited to 255, so that white is 191.
#pragma once

#include <filesystem>

#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Writes `ideal-<clip>.mkv` (FFV1) and `ideal-<clip>.csv` (frame,t_s,u_px,v_px: the projection of the marker's centre,
/// for the frames that hold it) of every clip into `truth_dir`, on up to `jobs` threads.
void write_ideal_frames(const Scenario& scenario, const std::filesystem::path& truth_dir, int jobs);

}  // namespace glidelab::render
