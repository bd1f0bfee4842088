/// Statistics of grouped values: the runs of a study, each with several configurations and quantities.
///
/// The values of one run (several intervals that contain the truth, or not) are correlated, because its configurations
/// share camera and clock. So the interval of a share is that of Clopper and Pearson, with the effective number of
/// independent values instead of the number of values: n / D, D = (variance of the share from run to run) / (p (1 - p)
/// / n), at least 1 and such that n / D is at most n and at least the number of runs' smallest use, 1 (Korn and
/// Graubard 1998). If all or none hold, nothing varies, and each run counts once.
#pragma once

#include <cstddef>
#include <vector>

namespace glidelab::validate {

/// The number of values that hold in one run.
struct RunCount {
  std::size_t holds = 0;
  std::size_t of = 0;
};

struct RunShare {
  std::size_t holds = 0, of = 0;
  double share = 0.0;
  double low = 0.0, high = 1.0;
};

/// Runs with `of` = 0 do not count; without any runs the share is 0 and the interval 0 to 1.
RunShare share_of(const std::vector<RunCount>& runs, double confidence);

/// A mean over runs with its standard deviation, which is infinite for a single run.
struct RunMean {
  double value = 0.0, sd = 0.0;
};
/// The mean from each run's sum and number of values: sum of sums over sum of counts, with the jackknife's standard
/// deviation.
RunMean mean_of(const std::vector<double>& sums, const std::vector<double>& counts);

/// The reduction of an rms value: 1 - sqrt(sum after / sum before), from the squares of each run, before and after in
/// the same runs; the interval by the jackknife of ln(after / before) and Student's t.
struct RunFall {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< for the requested confidence
};
/// Several quantities have equal weight: the mean of their logarithms. Each has the same runs, two or more (asserted).
RunFall fall_of(const std::vector<std::vector<double>>& before, const std::vector<std::vector<double>>& after,
                double confidence);

}  // namespace glidelab::validate
