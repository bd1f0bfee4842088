/// The page on which a motion's parameters are chosen by hand, for class: it is self-contained.
///
/// Its script scales, interpolates (Hermite, fifth order) and joins the orbits of teach/study/phase_explorer.h; it
/// solves no equation of motion. It also compares itself with the reference motions and says how far it was off.
#pragma once

#include <string>

#include "report/html/html.h"
#include "teach/study/phase_explorer.h"

namespace glidelab::teach {

/// A self-contained HTML page without plots of gnuplot.
report::Page explorer_page(const PhaseExplorer& explorer);

}  // namespace glidelab::teach
