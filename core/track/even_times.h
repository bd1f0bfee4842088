/// The even times of a camera behind rounded time stamps.
///
/// A phone writes whole ticks of 1/600 s, Matroska whole milliseconds, a table three or four places after the point,
/// while the sensor exposes evenly: stamps are then off by up to half a tick q (q / sqrt(12) on average), which at a
/// speed v looks like noise of v q / sqrt(12), or like a shaking camera where the pattern repeats.
///
///     stamp_k = a + T n_k + rounding,    n_k the frame's slot (frames may be missing between two)
///
/// Even times are taken where the stamps themselves show it: all steps are whole multiples of one tick, of two lengths
/// or more, and there is a T for which stamp_k - T n_k spread over no more than q, as rounding makes it (and 5 % more,
/// for what little the exposures jitter). A clock that jitters or drifts by more leaves that band somewhere in a clip;
/// its stamps are then better than a line. The T for which they spread over q at most are an interval; its middle is
/// taken, and the true T lies in it. (Rounding errors are bounded, and no mean of them tells T as well.)
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

struct EvenTimes {
  std::vector<double> t_s;    ///< of each stamp; the first one's is 0
  double step_s = 0.0;        ///< T
  double half_width_s = 0.0;  ///< of the interval of T
  double tick_s = 0.0;        ///< q
};

/// Where stamps come from: a container stores them to a microsecond or better; a table writes them in decimal places,
/// all of its times with one last place, or with one number of significant digits (3 to 6; q is then the coarsest).
enum class StampSource { container, table };

/// `stamps_s` rise. Nothing where they are fewer than 20, are even already, or are not as above.
std::optional<EvenTimes> even_times(std::span<const double> stamps_s, StampSource source = StampSource::container);

}  // namespace glidelab::core
