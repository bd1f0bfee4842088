/// x(t), v(t) and a(t) of one clip, as measured and smoothed, with what was left out in grey.
#pragma once

#include <vector>

#include "core/result/results.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// Three plots, or none if no frame has a position.
std::vector<Plot> motion_plots(const core::ClipResult& clip);

}  // namespace glidelab::report
