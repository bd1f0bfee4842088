/// Pages for class: the explorer, on which a motion's parameters are chosen by hand, and the cases of `laws` with their
/// films.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "report/html/html.h"
#include "teach/study/law_study.h"
#include "teach/study/phase_explorer.h"

namespace glidelab::teach {

/// The page on which a motion's parameters are chosen by hand, for class: self-contained HTML without plots of gnuplot.
///
/// Its script scales, interpolates (Hermite, fifth order) and joins the orbits of teach/study/phase_explorer.h; it
/// solves no equation of motion. It also compares itself with the reference motions and says how far it was off.
/// It opens in that language (one of language_codes()) and has a menu of all.
report::Page explorer_page(const PhaseExplorer& explorer, const std::string& language = "en");

/// The film with the browser's own controls and its rows' names over it, and a sheet for a(v). HTML.
std::string film_figure(const LawStudy& study, const LawFilm& film);

/// Once a page: the style and the scripts of its texts and of all its film_figure().
std::string film_script(const std::string& language = "en");

/// The page of `laws`: each case with a film, x(t), and a(v) with its equilibrium. It needs nothing but itself.
/// EnvironmentError where gnuplot fails; std::logic_error where there is not one film a study.
report::Page laws_report(const std::vector<LawStudy>& studies, const std::vector<LawFilm>& films,
                         const base::Progress& progress = base::no_progress, const std::string& language = "en");

}  // namespace glidelab::teach
