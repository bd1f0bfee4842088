/// What the positions tell about a motion if neither the order, nor the size, nor the rate of the process is known:
/// posteriors weighted by their marginal likelihoods, about one smoothed motion.
///
/// The standard deviations are those of the error of that motion, s (within the posteriors and between them), times the
/// ratio of the 97.5 % quantiles of Student's t and of the normal distribution if the noise is estimated: ± 1.96 of
/// them hold 95 %. The factor of the simultaneous band is the c for which the expected number of crossings of c s by
/// the error, including its start, is 5 % (Rice's formula between neighbouring nodes; Sun and Loader 1994, Ann. Stat.
/// 22, 1328).
#pragma once

#include <Eigen/Core>

#include <limits>
#include <vector>

#include "base/long_work.h"
#include "core/motion/smoothing/wiener_chain.h"

namespace glidelab::core {

struct EnsembleNode {
  Eigen::Array3d mean;      ///< x, v, a
  Eigen::Array3d variance;  ///< of them
  double with_next = 0.0;   ///< covariance of a with a at the next node
};

struct EnsembleMember {
  double weight = 0.0;
  std::vector<std::vector<EnsembleNode>> parts;
};

/// The nodes of a posterior for noise of the given standard deviation.
template <int N>
std::vector<EnsembleNode> nodes_of(const ChainPosterior<N>& posterior, double noise_sd);

struct SmoothingEnsemble {
  std::vector<std::vector<ChainNode>> nodes;                 ///< of each part
  std::vector<std::vector<Eigen::Array3d>> smoothed;         ///< the motion about which the band lies
  std::vector<EnsembleMember> members;                       ///< weights add up to 1
  double freedom = std::numeric_limits<double>::infinity();  ///< of the noise; infinite if it is stated
};

/// Standard deviations of x, v and a at every node. If a node may lie on either side of a break, given the uncertainty
/// of the time of v = 0, a of both sides lies within ± 1.96 of them.
std::vector<std::vector<Eigen::Array3d>> standard_deviations(const SmoothingEnsemble& ensemble,
                                                             const base::StopCheck& stop_check = base::never_stop);

double simultaneous_factor(const SmoothingEnsemble& ensemble, const std::vector<std::vector<Eigen::Array3d>>& sd,
                           const base::StopCheck& stop_check = base::never_stop);

}  // namespace glidelab::core
