#include "render/sensor/dust.h"

#include <cmath>

namespace glidelab::render {

FloatImage behind(const Dust& dust, FloatImage expected_e) {
  for (int y = 0; y < expected_e.height; ++y) {
    for (int x = 0; x < expected_e.width; ++x) {
      if (std::hypot(x - dust.x_px, y - dust.y_px) < dust.radius_px) {
        expected_e.at(x, y) *= static_cast<float>(dust.passes);
      }
    }
  }
  return expected_e;
}

}  // namespace glidelab::render
