/// Free stretches joined where the motion turns.
#pragma once

#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Stretches that follow each other across a reversal make one block. Where a block borders on something that is not
/// free (a hand, a stop, a rest), `margin_s` of it is left out: the border is known to about a bandwidth. Blocks of
/// fewer than kFewestBlockPoints, and such of which no stretch counts, are left out.
std::vector<FreeBlock> free_blocks(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<std::vector<double>>& shared_m, double margin_s);

inline constexpr std::size_t kFewestBlockPoints = 8;

}  // namespace glidelab::core
