/// The fixed parts of the pages for class: the files of teach/page/explorer, teach/page/laws and teach/page/languages
/// as strings. teach/page/page_texts.cmake makes their source.
#pragma once

#include <string_view>

namespace glidelab::teach {

extern const std::string_view kExplorerStyle;
extern const std::string_view kExplorerBody;    ///< controls, plots and the line of text; HTML
extern const std::string_view kExplorerMotion;  ///< script: a motion from the orbits
extern const std::string_view kExplorerWords;   ///< script: the outcome of a motion in words
extern const std::string_view kExplorerTrack;   ///< script: the track at its true slope
extern const std::string_view kExplorerKept;    ///< script: curves kept for comparison, and their legend
extern const std::string_view kExplorerLink;    ///< script: settings in a link
extern const std::string_view kExplorerView;    ///< script: controls and drawing
extern const std::string_view kPageLanguage;    ///< script: texts in the chosen language
extern const std::string_view kEnglish, kGerman, kSpanish, kFrench, kPortuguese;  ///< texts by their keys; JSON
extern const std::string_view kFilmStyle;
extern const std::string_view kFilmScript;  ///< script: the points that move along a(v) with the film
extern const std::string_view kLawsWords;   ///< script: the page of laws in the chosen language

}  // namespace glidelab::teach
