/// Which values a run has: full factorial, Latin hypercube or Sobol, and draws.
///
/// Factorial: the first axis varies slowest. Latin hypercube: each axis' n strata are visited once each, in a random
/// order (a Feistel permutation, so that nothing of the size of the design is stored), at a random place within.
/// Sobol: the sequence of boost::random::sobol with a random digital shift on each axis, so that its first 2^m points
/// stay a net. A list in these two designs is cut in equal parts.
#pragma once

#include <cstdint>
#include <vector>

#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// Points of the design; InputError (of the sweep's file) where there are more than 2^53.
std::uint64_t point_count(const Sweep& sweep);
std::uint64_t run_count(const Sweep& sweep);

/// One for each axis, in their order.
std::vector<base::TomlScalar> values_of(const Sweep& sweep, std::uint64_t run);

/// Of the noise of a run: a function of the sweep's seed and the run's number.
std::uint64_t seed_of(const Sweep& sweep, std::uint64_t run);

/// The value at a quantile u of [0, 1): of a drawn axis by its distribution, else as the hypercube places it. Of whole
/// numbers each has the same part of [0, 1) with equal steps or a uniform draw; with equal ratios the nearest is taken.
base::TomlScalar value_at(const AxisSource& source, double u);

/// All values of an axis of a factorial design.
std::vector<base::TomlScalar> all_values(const AxisSource& source);

/// A permutation of 0 … count-1, a different one for each key.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key);

}  // namespace glidelab::validate
