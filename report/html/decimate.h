/// Which points of a long series a plot needs: what is drawn must look the same, and a page must stay small.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glidelab::report {

/// Indices (rising) of about `most` points that keep the outline of a line through all of them: the first, the last,
/// and the lowest and highest of each of most/2 equal parts. All of them where there are no more than `most`, or
/// than four.
std::vector<std::size_t> outline(std::span<const double> y, std::size_t most);

/// Indices of `most` points at equal distance, the first and the last among them (of 1 the first alone), or of all
/// where there are no more: for clouds of points.
std::vector<std::size_t> every_nth(std::size_t count, std::size_t most);

}  // namespace glidelab::report
