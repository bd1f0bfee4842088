/// The page of `laws`: each case with a film, x(t), and a(v) with its equilibrium.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "report/html.h"
#include "validate/law_film.h"
#include "validate/law_study.h"

namespace glidelab::report {

/// One page that needs nothing but itself. EnvironmentError where gnuplot fails; std::logic_error where there is not
/// one film a study.
Page laws_report(const std::vector<validate::LawStudy>& studies, const std::vector<validate::LawFilm>& films,
                 const base::Progress& progress = base::no_progress);

}  // namespace glidelab::report
