/// A round speck on the sensor's cover glass: the example of docs/extending.md.
#pragma once

#include "render/image/float_image.h"

namespace glidelab::render {

struct Dust {
  double x_px = 0.0, y_px = 0.0, radius_px = 0.0;
  double passes = 1.0;  ///< the part of the light that comes through
};

/// The expected electrons behind the speck.
FloatImage behind(const Dust& dust, FloatImage expected_e);

}  // namespace glidelab::render
