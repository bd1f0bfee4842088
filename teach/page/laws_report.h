/// The page of `laws`: each case with a film, x(t), and a(v) with its equilibrium.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "report/html/html.h"
#include "teach/study/law_film.h"
#include "teach/study/law_study.h"

namespace glidelab::teach {

/// One page that needs nothing but itself. EnvironmentError where gnuplot fails; std::logic_error where there is not
/// one film a study.
report::Page laws_report(const std::vector<LawStudy>& studies, const std::vector<LawFilm>& films,
                         const base::Progress& progress = base::no_progress);

}  // namespace glidelab::teach
