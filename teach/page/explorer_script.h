/// The parts of the explorer's page that do not depend on numbers.
#pragma once

#include <string_view>

namespace glidelab::teach {

extern const std::string_view kExplorerBody;    ///< controls, plots, readout; HTML and its style
extern const std::string_view kExplorerMotion;  ///< script: a motion from the orbits
extern const std::string_view kExplorerWords;   ///< script: what becomes of a motion
extern const std::string_view kExplorerView;    ///< script: controls and drawing

}  // namespace glidelab::teach
