/// What experiment.toml states about a configuration, compared with what its motion shows.
///
/// Inclination, from the lines a = a0 - (K/m) v:
///     both directions: g sin(alpha) = (a0- + a0+)/2                             (13)
///     one direction:   friction brakes, so g sin(alpha) <= a0-, and g sin(alpha) >= a0+
/// A wrong length, frame rate or gravity shows there as well as a wrong angle: a0 goes with the scale, with the square
/// of the rate, and with g.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

inline constexpr double kMassRatio = 100.0;  ///< gliders of one track differ by less; grams for kilograms make 1000

/// An angle that somebody states, in degrees.
struct StatedIncline {
  double deg = 0.0;
  std::optional<double> sd_deg;
  std::string_view by;  ///< "incline_deg", "the plumb line"
};

struct InclineContradiction {
  std::string sentence;  ///< "the acceleration makes the inclination 0.42 ± 0.13°, incline_deg says 4.3 ± 0.3°"
  double off_deg = 0.0;  ///< infinite where no inclination has the acceleration that was found
  bool gross = false;    ///< more than a track that was set up carelessly explains; see incline_contradiction()
};

/// Nothing where the two agree, or nothing was found to compare. They disagree by more than half a degree and three
/// standard deviations of both together; grossly by more than one degree, a quarter of the stated angle and five
/// standard deviations (a choice: half a degree is a track that was not levelled with care).
std::optional<InclineContradiction> incline_contradiction(const ConfigurationResult& found, double gravity_m_s2,
                                                          const StatedIncline& stated);

/// As incline_deg and incline_sd_deg of its clips say.
StatedIncline stated_incline(const ConfigurationResult& configuration);

/// Adds to the notes: masses that look like grams, stated inclinations that the motion contradicts grossly.
void note_statements(std::vector<ConfigurationResult>& results, double gravity_m_s2);

}  // namespace glidelab::core
