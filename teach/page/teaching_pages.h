/// Pages for class: the explorer, in which a motion's parameters are chosen by hand, and the cases of `laws` with their
/// films.
#pragma once

#include <string>
#include <vector>

#include "base/long_work.h"
#include "report/html/html.h"
#include "teach/study/law_study.h"
#include "teach/study/phase_explorer.h"

namespace glidelab::teach {

/// The explorer page, in which a motion's parameters are chosen by hand, for class: self-contained HTML without gnuplot
/// plots.
///
/// Its script scales, interpolates (Hermite, fifth order) and joins the orbits of teach/study/phase_explorer.h; it
/// solves no equation of motion. It also compares itself with the reference motions and reports its error. It opens in
/// the given language (one of language_codes()) and has a menu of all languages.
report::Page explorer_page(const PhaseExplorer& explorer, const std::string& language = "en");

/// The film with the browser's own controls, the names of its rows over it, and a canvas for a(v). HTML.
std::string film_figure(const LawStudy& study, const LawFilm& film);

/// Once per page: the style, and the scripts for its texts and for all its film_figure().
std::string film_script(const std::string& language = "en");

/// The page of `laws`: each case with a film, x(t), and a(v) with its equilibrium. It is self-contained.
/// EnvironmentError if gnuplot fails; std::logic_error if there is not one film per study.
report::Page laws_report(const std::vector<LawStudy>& studies, const std::vector<LawFilm>& films,
                         const base::Progress& progress = base::no_progress, const std::string& language = "en");

}  // namespace glidelab::teach
