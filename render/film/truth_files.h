/// What a render writes beside the clips: experiment.toml, and the truth, which is the true values, the marker's true
/// place in every frame, and ideal frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Names within the experiment folder, of the i-th of `count` images.
std::string view_name(std::size_t i);
std::string plane_name(std::size_t i, std::size_t count);

/// experiment.toml: what a person would write who took these images; no truth in it.
std::string experiment_toml(const Scenario& scenario);

/// truth.json: what was put in. The seed is the one that was used.
std::string truth_json(const Scenario& scenario, std::uint64_t seed);

/// Where the pattern's first corner, projected on the line of motion of this inclination, lies on the track.
double x_origin_m(const Scenario& scenario, double incline_rad);

/// Where the marker truly is in a frame's image, for the truth folder.
///
/// A frame shows the marker as it is at the middle of the exposure of the row that its centre lies on (with a global
/// shutter, of any row). Centre: the projection of the sphere's centre. Centroid: of the area of the sphere's sharp
/// image at that instant, which differs by what perspective and lens do to a sphere (some 1e-3 px of a small one).
struct MarkerInPicture {
  double t_s = 0.0;  ///< the instant, on the recording's clock
  double x_m = 0.0;  ///< on the track, then
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
};

/// Nothing where the centre lies outside the image. NumericalError where the marker outruns a rolling readout.
std::optional<MarkerInPicture> marker_in_picture(const Scenario& scenario, const sim::Body& body,
                                                 const FrameMotion& frame);

/// The second product of a render: frames as a perfect camera would take them, and where the marker is in each.
///
/// Ideal frames are sharp in every way (no lens distortion, no blur, an instant for an exposure, no vignetting, an even
/// light, a mount at rest, no noise), by the same pinhole at rest, at each frame's time (the middle of the middle row's
/// exposure; slot by slot of a clock without error, jitter, dropped and repeated frames). They have 8 bits: the code is
/// 0.75 · 255 times the radiance, rounded and limited to 255, so that white is 191.
///
/// Writes `ideal-<clip>.mkv` (FFV1) and `ideal-<clip>.csv` (frame,t_s,u_px,v_px: the projection of the marker's centre,
/// for the frames that hold it) of every clip into `truth_dir`, on up to `jobs` threads.
void write_ideal_frames(const Scenario& scenario, const std::filesystem::path& truth_dir, int jobs);

}  // namespace glidelab::render
