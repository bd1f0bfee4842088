/// The page of `laws`: each case with an animation, x(t), and a(v) with its equilibrium.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "report/html.h"
#include "validate/law_study.h"

namespace glidelab::report {

/// One page that needs nothing but itself. EnvironmentError where gnuplot fails.
Page laws_report(const std::vector<validate::LawStudy>& studies, const base::Progress& progress = base::no_progress);

}  // namespace glidelab::report
