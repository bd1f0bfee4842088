/// The positions in a plane at which a body was seen, first to last: the direction of their line, and how far they
/// leave it.
#pragma once

#include <vector>

namespace glidelab::core {

struct PlanePath {
  std::vector<double> x_m, y_m;
};

/// The angle from the x axis to the line that fits the path best, -90 to 90 degrees.
double slant_deg(const PlanePath& path);

/// Sagitta over length of a parabola through the path, across the line from its first position to the one farthest from
/// it, over the place along that line or over the distance travelled (a flight that comes down again turns back along
/// the line); 0 if neither parabola explains the deviation across the line.
double sagitta_of(const PlanePath& path);

/// A bend of any shape, as the deviation across the line that fits the path best. Its smooth part are the medians of
/// sixteen groups of positions that are neighbours along the line (of at least three each), so that single wrong
/// positions do not count, and a body that comes back beside its way there is on one path; waves shorter than an eighth
/// of the path are lost in it. The smooth part of an arc has nearly the range of its sagitta.
struct PathBend {
  double range_m = 0.0;  ///< of the smooth deviation
  double noise_m = 0.0;  ///< standard deviation of one position across, from second differences
  double step_m = 0.0;   ///< of a coordinate whose values repeat because they are rounded; 0 if neither does
  double length_m = 0.0;
  double slope_deg = 0.0;  ///< between the directions of parts of an eighth of the length, largest against smallest
};
PathBend bend_of(const PlanePath& path);

}  // namespace glidelab::core
