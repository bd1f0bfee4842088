/// Cross-validation of the local cubic: of x, converted to the bandwidth for a (bandwidth_rule.h). Where the criterion
/// has several local least values the widest bandwidth's counts.
#pragma once

#include "core/motion/bandwidth/bandwidth_rule.h"

namespace glidelab::core {

/// CV(h) = mean ((x_j - xs_j) / (1 - w_jj))^2, with w_jj the weight of a point in its own smoothed value: the error of
/// predicting it from the others, exactly, for any linear smoother whose weights are renormalised (Stone 1974).
class LeaveOneOut : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

/// GCV(h) = mean (x_j - xs_j)^2 / (1 - mean w_jj)^2 (Craven and Wahba 1979).
class GeneralisedCrossValidation : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

/// With the kernel u^2 exp(-u^2), which gives a point no weight in its own value and little to its neighbours', the
/// residual sum of squares is least at about the right h also where the noise of neighbours is correlated; that h times
/// 1.0143 is the Gaussian kernel's (De Brabanter, De Brabanter, Suykens, De Moor 2011, JMLR 12, 1955-1976).
class CorrelatedCrossValidation : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

}  // namespace glidelab::core
