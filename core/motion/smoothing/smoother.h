/// The smoothers: positions in; x, v and a with their standard deviations out, and the strength of the smoothing.
///
///     local-polynomial  the local cubic of the paper, whose bandwidth is given (local_polynomial.h)
///     kalman            an integrated Wiener or Ornstein-Uhlenbeck process, its strength by marginal likelihood
///     spline            the spline of the same process, its strength by generalised cross-validation
///
/// The last two are one posterior (wiener_chain.h) with two ways to choose its strength; wiener_smoother.cpp has both.
/// All three are linear in the positions once the strength is chosen, so the effect of any noise and of any
/// displacement on v and a follows from the rows.
///
/// Standard deviations: for the local polynomial those of the noise alone; for the other two those of the posterior,
/// which include what smoothing may remove from a(t).
#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/long_work.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/result/strength.h"

namespace glidelab::core {

struct SmoothingInput {
  std::vector<double> t_s;  ///< rising strictly, of any spacing
  std::vector<double> x_m;
  std::optional<double> noise_sd_m = {};   ///< for a position of factor 1; estimated if not given
  std::vector<double> noise_factor = {};   ///< of each position, above 0; empty: 1
  std::vector<std::size_t> starts = {};    ///< rising: points at which the motion starts afresh (0 is implied)
  std::vector<double> breaks_s = {};       ///< rising: where v = 0 and a may jump, to a step or two
  std::vector<double> at_s = {};           ///< rising: other requested times within the parts of the motion
  std::optional<double> bandwidth_s = {};  ///< of the local polynomial (asserted there), and of no other
  std::vector<double> along_m = {};        ///< another series at the same times, to be smoothed by the same weights
  bool rows = false;                       ///< whether rows are requested
  bool rate_in_rows = false;               ///< whether rows include the effect of the noise through the rate k, for a
                                           ///< covariance
  bool simultaneous = false;               ///< whether the simultaneous band is requested
  base::StopCheck stop_check = base::never_stop;
};

/// Positions that kalman and spline need in one part of the motion, and on each side of a break.
inline constexpr std::size_t kFewestSmoothed = 6;

struct SmoothedState {
  double x_m = 0.0, v_m_s = 0.0, a_m_s2 = 0.0;
  double sd_x_m = 0.0, sd_v_m_s = 0.0, sd_a_m_s2 = 0.0;
};

struct SmoothedSeries {
  SmoothingStrength strength;
  std::vector<std::optional<SmoothedState>> points;  ///< empty if a part has fewer than kFewestSmoothed positions
  std::vector<std::optional<SmoothedState>> at;      ///< of at_s; also empty outside the parts
  std::vector<std::optional<SmoothedState>> along, along_at;  ///< the same of `along_m`, with the same deviations
  /// Rows of the points, over all positions, if requested. If kernels reach over much of a motion, neighbours carry the
  /// same information, and only a few hundred points spread over it have a row.
  std::vector<std::optional<KernelRow>> rows;
  /// With `rate_in_rows`, if the smoothed motion has no rate k: the points under the most likely rate, to which the
  /// rows then belong. A motion without a rate knows nothing of how uncertain k = 0 is.
  std::vector<std::optional<SmoothedState>> with_rate;
  /// With `rate_in_rows`: the rows with that rate held.
  std::vector<std::optional<KernelRow>> held_rows;
};

class Smoother {
 public:
  virtual ~Smoother() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view words() const = 0;  ///< "Kalman smoother, its strength by marginal likelihood"
  virtual bool takes_bandwidth() const = 0;

  /// Times rise strictly, vectors are of one length, parts are not empty (asserted). A break without kFewestSmoothed
  /// positions on both sides within its part is ignored.
  virtual SmoothedSeries smooth(const SmoothingInput& input) const = 0;
};

/// A part of the positions that forms one motion.
struct SeriesPart {
  std::size_t first = 0, count = 0;
};

inline std::vector<SeriesPart> parts_of(const SmoothingInput& input) {
  std::vector<SeriesPart> parts;
  std::size_t first = 0;
  for (const std::size_t start : input.starts) {
    assert(start > first && start < input.t_s.size());
    parts.push_back({first, start - first});
    first = start;
  }
  if (input.t_s.size() > first) parts.push_back({first, input.t_s.size() - first});
  return parts;
}

}  // namespace glidelab::core
