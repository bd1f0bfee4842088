/// The local cubic of each part with its own points alone (local_polynomial.h), as one of the smoothers.
#pragma once

#include "core/motion/smoothing/smoother.h"

namespace glidelab::core {

const Smoother& cubic_smoother();

}  // namespace glidelab::core
