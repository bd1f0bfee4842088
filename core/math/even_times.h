/// Recovers a camera's uniform times from rounded time stamps.
///
/// A phone writes whole ticks of 1/600 s, Matroska whole milliseconds, a table three or four decimal places, while the
/// sensor exposes at uniform times. Stamps are then off by up to half a tick q (q / sqrt(12) rms). At a speed v this
/// looks like noise of v q / sqrt(12), or like a shaking camera if the pattern repeats.
///
///     stamp_k = a + T n_k + rounding,    n_k the frame's slot (frames may be missing between two)
///
/// Uniform times are used if the stamps themselves support it: all steps are whole multiples of one tick, of two
/// lengths or more, and there is a T for which stamp_k - T n_k spreads over no more than q, as expected from rounding
/// (plus 5 % for a small jitter of the exposures). A clock that jitters or drifts by more leaves that band somewhere in
/// a clip; its stamps are then better than a line. The values of T for which the spread is at most q form an interval,
/// which contains the true T; its middle is taken. (Rounding errors are bounded, and no mean of them determines T as
/// well.)
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

/// The source of the stamps: a container stores them to a microsecond or better; a table writes them as decimals, all
/// with the same last place, or all with the same number of significant digits (3 to 6; q is then the coarsest).
enum class StampSource { container, table };

/// `stamps_s` rise. Empty if there are fewer than 20, if they are already uniform, or if they are not as above.
std::optional<EvenTimes> even_times(std::span<const double> stamps_s, StampSource source = StampSource::container);

}  // namespace glidelab::core
