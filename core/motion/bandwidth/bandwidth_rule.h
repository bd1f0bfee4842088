/// Rules that choose the bandwidth of the local cubic from data, by name: what each makes least, and its source.
///
///  - `cv`: error of each position predicted by the others. Stone 1974. Assumes white noise.
///  - `gcv`: n RSS / (n - tr S)^2. Craven and Wahba 1979. Assumes white noise.
///  - `cv-correlated`: RSS of a kernel with K(0) = 0, then a factor. De Brabanter et al. 2011 (JMLR 12). Assumes a
///    correlation that is short beside h.
///  - `rsc`: local residual variance (1 + 4 V). Fan and Gijbels 1995. Assumes white noise.
///  - `plug-in`: h^9 = 1.058 s^2 dt / mean(x''''^2). Ruppert, Sheather, Wand 1995. Takes x'''' from a global fit of
///    order 6.
///  - `ebbs`: variance + bias^2 of a, the bias from how a changes with h. Ruppert 1997. Assumes that it goes as h^2.
///  - `ici`: at every point the widest h whose confidence intervals all meet. Goldenshluger, Nemirovski 1997. Assumes
///    known noise.
///
/// `cv`, `gcv`, `cv-correlated` and `rsc` look at x; their h is converted to that for a by the constants of
/// kernel_constants.h (`cv`: times 0.867, `rsc`: times 0.829), which holds where x'''' varies little over the kernel.
/// All look at a point at a time and know of no line; the default rule of `analyze` (bandwidth.h) serves lines.
/// The rule that the paper took from its reference [15] is not in its text, and none of these is claimed to be it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/smoothing/noise.h"

namespace glidelab::core {

/// A part of the motion that is smoothed with its own points alone.
struct MotionPart {
  std::span<const double> t_s;
  std::span<const double> x_m;
};

struct BandwidthProblem {
  std::vector<MotionPart> parts;
  PositionNoise noise;
  double step_s = 0.0;  ///< median time step
};

struct LocalBandwidth {
  double t_s = 0.0;
  double bandwidth_s = 0.0;
};

struct BandwidthPick {
  double bandwidth_s = 0.0;           ///< one for all points; of a local rule the median
  std::string method;                 ///< one line for a reader
  std::vector<LocalBandwidth> local;  ///< of a local rule only
};

class BandwidthRule {
 public:
  virtual ~BandwidthRule() = default;
  /// Nothing where the motion is too short for any bandwidth.
  virtual std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const = 0;
};

const std::vector<std::string>& bandwidth_rule_names();

/// Null where there is no rule of the name.
std::unique_ptr<BandwidthRule> make_bandwidth_rule(std::string_view name);

}  // namespace glidelab::core
