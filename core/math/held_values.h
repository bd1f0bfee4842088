/// Rows in which a logger repeats a value that a slower sensor gave before, while the body moves on.
///
/// Runs of equal values follow each other: without the first and the last, there are six or more, and three in five
/// of them have two rows or more. A rounded position repeats too, but a slow body then goes on by one unit of its
/// rounding. So the values count as held only if they are not all multiples of one step, or if the median step is two
/// such units or more.
///
/// A run that is longer than usual holds several equal values of the sensor, as of a body at rest: after every
/// `usual` rows, the 90 % quantile of the runs, a row is taken for a value of its own, if half as many follow.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

struct HeldValues {
  std::vector<bool> is_held;  ///< of each row: it repeats the one before and is no value of its own
  std::size_t count = 0;
  std::size_t usual = 0;  ///< rows from one value of the sensor to the next
};

/// Empty if no values are held.
std::optional<HeldValues> held_values(std::span<const double> x);

/// The step of which all given steps are multiples, to within a hundredth of it; 0 if there is none. Steps of 0 do not
/// count.
double common_step(std::span<const double> steps);

}  // namespace glidelab::core
