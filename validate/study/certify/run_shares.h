/// Statistics of values that come in groups: the runs of a study, each with several configurations and quantities.
///
/// What one run holds (several intervals that contain the truth, or not) goes together, since its configurations share
/// camera and clock. So the interval of a share is that of Clopper and Pearson with the number of independent values in
/// place of the number of values: n / D, D = (variance of the share from run to run) / (p (1 - p) / n), at least 1 and
/// such that n / D is at most n and at least the number of runs' smallest use, 1 (Korn and Graubard 1998). Where all or
/// none hold, nothing varies, and each run counts once.
#pragma once

#include <cstddef>
#include <vector>

namespace glidelab::validate {

/// Of one run: how many of its values hold.
struct RunCount {
  std::size_t holds = 0;
  std::size_t of = 0;
};

struct RunShare {
  std::size_t holds = 0, of = 0;
  double share = 0.0;
  double low = 0.0, high = 1.0;
};

/// Runs with `of` = 0 count for nothing; none at all: share 0, interval 0 to 1.
RunShare share_of(const std::vector<RunCount>& runs, double confidence);

/// A mean over runs with its standard deviation; of a single run the latter is infinite.
struct RunMean {
  double value = 0.0, sd = 0.0;
};
/// Of the sums of each run over `count` values each: sum of sums over sum of counts, and the jackknife's deviation.
RunMean mean_of(const std::vector<double>& sums, const std::vector<double>& counts);

/// How much smaller a root mean square becomes: 1 - sqrt(sum after / sum before), from the squares of each run, before
/// and after in the same runs; the interval by the jackknife of ln(after / before) and Student's t.
struct RunFall {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< of the confidence that is asked for
};
/// Several quantities count alike: the mean of their logarithms. Each has the same runs, two or more (asserted).
RunFall fall_of(const std::vector<std::vector<double>>& before, const std::vector<std::vector<double>>& after,
                double confidence);

}  // namespace glidelab::validate
