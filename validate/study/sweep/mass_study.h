/// Does a recovered mu fall with mass although the true one does not? For a sweep over masses with lines through every
/// smoothed point ("all-points"), for each bandwidth: mu of each mass, its fall from the lightest to the heaviest, and
/// the smallest R² of the lines.
///
/// A mean's standard error is that of the runs (replicates); that of a fall is the root sum of squares of both ends,
/// because their runs are independent. With exact positions all replicates are equal, and there is no random error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sweep_database.h"

namespace glidelab::validate {

struct MassPoint {
  double mass_kg = 0.0;
  double mu = 0.0, se = 0.0;  ///< mean over the runs, and its standard error
  double r2 = 1.0;            ///< smallest of the lines of its clips, mean over the runs
};

/// One bandwidth on one track, at one combination of the other varied keys.
struct MassRow {
  std::string configuration;
  std::string others;  ///< "tracks.noise_m = 2e-05"; empty if nothing else varies
  double bandwidth_s = 0.0;
  double truth = 0.0;
  std::vector<MassPoint> masses;  ///< the lightest first
  double fall() const { return masses.front().mu - masses.back().mu; }
  double fall_se() const;
  double r2() const;  ///< smallest over the masses
};

/// The effect of smoothing at the bandwidth at which a condition is just met, interpolated between two bandwidths that
/// were run: the fall and the logarithm of 1 - R² along straight lines.
struct FallAt {
  double bandwidth_s = 0.0, fall = 0.0, fall_se = 0.0, r2 = 0.0;
};

/// A published fall compared with the runs.
struct FallAnswer {
  PublishedFall published;
  std::string others;
  MassRow widest;               ///< the largest bandwidth that was run
  std::optional<FallAt> whole;  ///< where the whole fall is produced; empty if no bandwidth that was run produces it
  std::optional<FallAt> at_r2;  ///< where R² has the published value; empty if it never does, or is lower throughout
};

struct MassStudy {
  std::vector<MassRow> rows;  ///< by configuration, other varied keys, bandwidth; empty for any other sweep
  std::vector<FallAnswer> answers;
};

/// Empty if the sweep has no lines through all points, or no axis of masses of two or more values.
MassStudy study_masses(const Sweep& sweep, Database& database);

/// The answer from rows of one configuration and one combination, in rising order of bandwidth.
FallAnswer answer_of(const PublishedFall& published, const std::vector<MassRow>& rows);

}  // namespace glidelab::validate
