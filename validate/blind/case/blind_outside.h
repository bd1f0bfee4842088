/// Effects that no library has: smooth, local, periodic and random ones, in x, v, t, mass and place in the image.
///
/// They test whether a diagnosis knows when it does not know. None of them may ever be added to what it can name.
#pragma once

#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

const std::vector<DrawnEffect>& outside_library();

}  // namespace glidelab::validate
