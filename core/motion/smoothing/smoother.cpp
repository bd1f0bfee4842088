#include "core/motion/smoothing/smoother.h"

#include <cassert>

namespace glidelab::core {

std::vector<SeriesPart> parts_of(const SmoothingInput& input) {
  std::vector<SeriesPart> parts;
  std::size_t first = 0;
  for (const std::size_t start : input.starts) {
    assert(start > first && start < input.t_s.size());
    parts.push_back({first, start - first});
    first = start;
  }
  if (input.t_s.size() > first) parts.push_back({first, input.t_s.size() - first});
  return parts;
}

}  // namespace glidelab::core
