/// Effects that are in no library: smooth, local, periodic and random ones, in x, v, t, mass and position in the image.
///
/// They test whether a diagnosis recognises what it does not know. None of them may ever be added to the effects that
/// it can name.
#pragma once

#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

const std::vector<DrawnEffect>& outside_library();

}  // namespace glidelab::validate
