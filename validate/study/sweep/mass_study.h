/// Does a recovered mu fall with mass where the true one does not? Of a sweep over masses with lines through every
/// smoothed point ("all-points"), for each bandwidth: mu of each mass, its fall from the lightest to the heaviest, and
/// the least R² of the lines.
///
/// A mean's standard error is that of the runs (replicates); a fall's is the root of both ends' squares, for their runs
/// are independent. With exact positions all replicates are one, and nothing of it is chance.
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
  double r2 = 1.0;            ///< least of the lines of its clips, mean over the runs
};

/// One bandwidth on one track, at one combination of what else varies.
struct MassRow {
  std::string configuration;
  std::string others;  ///< "tracks.noise_m = 2e-05"; empty if nothing else varies
  double bandwidth_s = 0.0;
  double truth = 0.0;
  std::vector<MassPoint> masses;  ///< the lightest first
  double fall() const { return masses.front().mu - masses.back().mu; }
  double fall_se() const;
  double r2() const;  ///< least of the masses'
};

/// What smoothing makes where it is just wide enough to make something, between two bandwidths that were run: the fall
/// and the logarithm of 1 - R² along straight lines.
struct FallAt {
  double bandwidth_s = 0.0, fall = 0.0, fall_se = 0.0, r2 = 0.0;
};

/// A published fall beside the runs.
struct FallAnswer {
  PublishedFall published;
  std::string others;
  MassRow widest;               ///< the largest bandwidth that was run
  std::optional<FallAt> whole;  ///< where the whole fall is made; nothing if no bandwidth that was run makes it
  std::optional<FallAt> at_r2;  ///< where R² is what was published; nothing if it never is, or is lower throughout
};

struct MassStudy {
  std::vector<MassRow> rows;  ///< by configuration, what else varies, bandwidth; empty of any other sweep
  std::vector<FallAnswer> answers;
};

/// Empty if the sweep has no lines through all points, or no axis of masses of two or more values.
MassStudy study_masses(const Sweep& sweep, Database& database);

/// The answer from rows of one configuration and one combination, in rising order of bandwidth.
FallAnswer answer_of(const PublishedFall& published, const std::vector<MassRow>& rows);

}  // namespace glidelab::validate
