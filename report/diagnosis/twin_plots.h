/// A twin compared with the data that it was made from.
#pragma once

#include <vector>

#include "report/html/plot.h"
#include "validate/film/twin_motions.h"

namespace glidelab::report {

/// What the measured positions lie off the twin's, over the time, beside noise alone; and a(v) of both.
std::vector<Plot> twin_plots(const std::vector<validate::TwinMotion>& motions);

}  // namespace glidelab::report
