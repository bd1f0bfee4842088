/// The film of a law on its page, and the points that run along a(v) with it.
#pragma once

#include <string>

#include "teach/study/law_film.h"
#include "teach/study/law_study.h"

namespace glidelab::teach {

/// The film with the browser's own controls and its rows' names over it, and a sheet for a(v). HTML.
std::string film_figure(const LawStudy& study, const LawFilm& film);

/// Once a page: the style and the script of all its film_figure().
std::string film_script();

}  // namespace glidelab::teach
