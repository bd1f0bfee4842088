/// Which rays are cast at what stands still: how many a pixel, and where they go.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/focus.h"
#include "render/image/float_picture.h"

namespace glidelab::render {

/// How many rays each pixel needs (0, 16 or 64): by how much it changes within itself (`spread`) or against a
/// neighbour, in itself or in one of its neighbours.
FloatPicture wanted_rays(const FloatPicture& picture, const FloatPicture& spread);

/// The first 64 points of the Sobol sequence in two dimensions, within [0, 1)²: any first 16 of them, or all, have one
/// point in every column and row of as many.
std::vector<Eigen::Vector2f> pixel_places();

/// Of each of kFocusRays rays, four numbers: its point of the aperture in metres and its part of the core in
/// undistorted coordinates; then, in a second row, its place in the pixel.
std::vector<float> lens_rays(const Focus& focus, const Camera& camera);

}  // namespace glidelab::render
