/// The fixed parts of the pages: the files of teach/page/explorer and teach/page/laws as strings. teach/CMakeLists.txt
/// makes the source.
#pragma once

#include <string_view>

namespace glidelab::teach {

extern const std::string_view kExplorerStyle;
extern const std::string_view kExplorerBody;    ///< controls, plots and the line of words; HTML
extern const std::string_view kExplorerMotion;  ///< script: a motion from the orbits
extern const std::string_view kExplorerWords;   ///< script: what becomes of a motion
extern const std::string_view kExplorerView;    ///< script: controls and drawing
extern const std::string_view kFilmStyle;
extern const std::string_view kFilmScript;  ///< script: the points that run along a(v) with the film

}  // namespace glidelab::teach
