/// The laboratory of a scenario: what the painters get to draw for each image.
///
/// The line of motion of a set-up with inclination a passes through the world's origin, off the plane z = 0 by the
/// marker's height, along (cos a, -sin a, 0) (track.downhill = +1) or (-cos a, -sin a, 0) (-1).
#pragma once

#include <optional>
#include <vector>

#include "render/scenario/moving_body.h"
#include "render/scenario/scenario_data.h"
#include "render/scenario/static_scene.h"

namespace glidelab::render {

/// The track's +x (downhill) in the world, of length 1.
Eigen::Vector3d track_direction_W(const TrackSetup& track, double incline_rad);

/// The marker's centre at x on the track.
Eigen::Vector3d marker_position_W(const Scenario& scenario, double incline_rad, double x_m);

/// Wall, table and track, without the glider.
StaticScene empty_track(const Scenario& scenario, double incline_rad);

/// The glider with its marker, as the scene lights it when it is at x_m on its track.
MovingBody glider(const Scenario& scenario, const StaticScene& scene, const sim::Body& body, double x_m);

/// The board in the plane of motion (z = 0) as the i-th plane view shows it; the track is that of the first
/// configuration.
Chessboard plane_board(const Scenario& scenario, std::size_t view);

PlumbLine plumb_line(const PlumbSetup& setup, const Camera& camera);

/// A rectangle around the part of the plumb line that is seen before the wall, above the track of the first
/// configuration; nothing where less than 40 px of it are in the image, or there is no plumb.
std::optional<PixelRect> plumb_region(const Scenario& scenario);

/// The scenario as its clips see it: with the focal length after the calibration (render/camera/mount.h).
Scenario as_in_clips(const Scenario& scenario);

/// Electrons that a relative radiance of 1 gives in one exposure.
double electrons_of_white(const Scenario& scenario);

}  // namespace glidelab::render
