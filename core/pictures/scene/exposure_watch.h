/// How a clip is exposed: which share of its pixels is at the largest code, at 0, and how bright the bright ones are.
///
/// Every fourth pixel, either way, of every fifth frame counts.
#pragma once

#include <cstddef>
#include <vector>

#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

struct Exposure {
  double saturated = 0.0;     ///< share of pixels at the largest code
  double dark = 0.0;          ///< share at 0
  double bright_level = 0.0;  ///< below which 99.9 % of the pixels are, as a share of the largest code
  int full_code = 255;        ///< the largest code
};

class ExposureWatch {
 public:
  explicit ExposureWatch(int bit_depth) : bit_depth_(bit_depth) {}
  void add(const Frame& frame);
  Exposure result() const;

 private:
  int bit_depth_;
  std::vector<std::size_t> count_;  ///< of each code
  std::size_t pixels_ = 0;
};

}  // namespace glidelab::core
