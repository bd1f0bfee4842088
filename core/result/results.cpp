#include "core/result/results.h"

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

}  // namespace glidelab::core
