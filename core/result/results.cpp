#include "core/result/results.h"

#include <fmt/format.h>

#include <cassert>

namespace glidelab::core {

std::string describe(LeftOut reason) {
  switch (reason) {
    case LeftOut::used:
      return "used";
    case LeftOut::before_start:
      return "before the stated start";
    case LeftOut::after_end:
      return "after the stated end";
    case LeftOut::hand:
      return "hand";
    case LeftOut::rest:
      return "at rest";
    case LeftOut::stop:
      return "stop";
    case LeftOut::kernel_end:
      return "kernel over an end";
    case LeftOut::kernel_reversal:
      return "kernel over a reversal";
    case LeftOut::kernel_gap:
      return "kernel over a gap";
    case LeftOut::no_marker:
      return "no marker";
    case LeftOut::outlier:
      return "outlier";
    case LeftOut::short_stretch:
      return "short stretch";
  }
  assert(false);
  return "";
}

std::string sentence(const AgainstLaunch& against) {
  const std::string moving = against.direction > 0 ? "+x" : "-x", launch = against.direction > 0 ? "-x" : "+x";
  if (!against.until_s) return fmt::format("it moves towards {} only: the launch was towards {}", moving, launch);
  return fmt::format(
      "motion towards {} before {:.3f} s is attributed to the hand and excluded, since the launch was towards {}",
      moving, *against.until_s, launch);
}

}  // namespace glidelab::core
