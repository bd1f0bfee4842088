/// Pages for class: the explorer, on which a motion's parameters are chosen by hand, and the cases of `laws` with their
/// films.
///
/// The strings are the fixed parts of the pages, the files of teach/page/explorer and teach/page/laws.
/// teach/CMakeLists.txt makes their source.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/long_work.h"
#include "report/html/html.h"
#include "teach/study/law_study.h"
#include "teach/study/phase_explorer.h"

namespace glidelab::teach {

extern const std::string_view kExplorerStyle;
extern const std::string_view kExplorerBody;    ///< controls, plots and the line of words; HTML
extern const std::string_view kExplorerMotion;  ///< script: a motion from the orbits
extern const std::string_view kExplorerWords;   ///< script: what becomes of a motion
extern const std::string_view kExplorerTrack;   ///< script: the track at its true slope
extern const std::string_view kExplorerKept;    ///< script: curves kept for comparison, and their legend
extern const std::string_view kExplorerLink;    ///< script: settings in a link
extern const std::string_view kExplorerView;    ///< script: controls and drawing
extern const std::string_view kPageLanguage;    ///< script: texts in the language that is chosen
extern const std::string_view kEnglish, kGerman, kSpanish, kFrench, kPortuguese;  ///< texts by their keys; JSON
extern const std::string_view kFilmStyle;
extern const std::string_view kFilmScript;  ///< script: the points that run along a(v) with the film
extern const std::string_view kLawsWords;   ///< script: the page of laws in the language that is chosen

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
