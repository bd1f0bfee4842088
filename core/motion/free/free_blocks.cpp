#include "core/motion/free/free_blocks.h"

#include <algorithm>

namespace glidelab::core {
namespace {

bool turns_into(const FreeStretch& before, const FreeStretch& after) {
  return before.end == LeftOut::kernel_reversal && after.start == LeftOut::kernel_reversal &&
         before.first + before.count == after.first;
}

FreeBlock block_of(const Motion& motion, std::size_t from, std::size_t to,
                   const std::vector<std::vector<double>>& shared_m) {
  FreeBlock block;
  block.shared_m.resize(shared_m.size());
  for (std::size_t i = from; i < to; ++i) {
    block.t_s.push_back(motion.t_s[i]);
    block.x_m.push_back(motion.x_m[i]);
    for (std::size_t mode = 0; mode < shared_m.size(); ++mode) {
      if (!shared_m[mode].empty()) block.shared_m[mode].push_back(shared_m[mode][motion.point[i]]);
    }
  }
  return block;
}

}  // namespace

std::vector<FreeBlock> free_blocks(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<std::vector<double>>& shared_m, double margin_s) {
  std::vector<FreeBlock> blocks;
  for (std::size_t s = 0; s < stretches.size();) {
    std::size_t end = s + 1;
    while (end < stretches.size() && turns_into(stretches[end - 1], stretches[end])) ++end;
    std::size_t from = stretches[s].first, to = stretches[end - 1].first + stretches[end - 1].count;
    bool counts = false;
    std::vector<int> directions;
    for (; s < end; ++s) {
      counts = counts || stretches[s].whole == LeftOut::used;
      directions.push_back(stretches[s].direction);
    }
    const double first_s = motion.t_s[from] + (from > 0 ? margin_s : 0.0);
    const double last_s = motion.t_s[to - 1] - (to < motion.t_s.size() ? margin_s : 0.0);
    while (from < to && motion.t_s[from] < first_s) ++from;
    while (to > from && motion.t_s[to - 1] > last_s) --to;
    if (!counts || to - from < kFewestBlockPoints) continue;
    blocks.push_back(block_of(motion, from, to, shared_m));
    blocks.back().directions = std::move(directions);
  }
  return blocks;
}

}  // namespace glidelab::core
