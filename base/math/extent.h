/// The interval that some numbers span.
#pragma once

#include <algorithm>
#include <limits>

namespace glidelab::base {

/// For no numbers: low above high.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high > low ? high - low : 0.0; }  ///< 0 if there are none
};

}  // namespace glidelab::base
