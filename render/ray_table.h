/// The exact inverse of the camera's mapping at every pixel, its derivative there, and how much light gets there.
///
/// For the pixel (u, v) the table gives the undistorted coordinates (x, y) of the ray through its centre, and the
/// Jacobian d(x, y)/d(u, v). Within a pixel the mapping is taken as linear; the neglected second order is below
/// |d²x/du²|/8, 3e-5 px for the strongest lens that `why_not_one_to_one` lets pass in a picture of 800 px. Computed in
/// double and rounded once to single precision: 2^-25 of half the picture's width, 1e-5 px.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/vignetting.h"

namespace glidelab::render {

struct RayTable {
  int width = 0;
  int height = 0;
  std::vector<float> x_y_dxdu_dxdv;  ///< four floats a pixel
  std::vector<float> dydu_dydv;      ///< two floats a pixel
  std::vector<float> gain;           ///< one a pixel, of its light; empty where it is 1 everywhere
  double fold_radius = 0.0;          ///< of the lens
};

/// NumericalError where a pixel has no ray (a camera that `why_not_one_to_one` would refuse).
RayTable make_ray_table(const Camera& camera, const Vignetting& vignetting = {});

}  // namespace glidelab::render
