/// Findings of a check by their kind.
#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "core/check/finding.h"
#include "tests/catch.h"

namespace glidelab::tests {

/// The first finding of this kind; null if there is none. The findings outlive it.
template <class Kind>
const Kind* found_in(const std::vector<core::Finding>& findings) {
  for (const core::Finding& finding : findings) {
    if (const auto* const found = std::get_if<Kind>(&finding.found)) return found;
  }
  return nullptr;
}

/// What this finding says, which has to be of this kind.
template <class Kind>
const Kind& found_as(const core::Finding& finding) {
  const auto* const found = std::get_if<Kind>(&finding.found);
  REQUIRE(found != nullptr);
  return *found;
}

/// The fault of the motion that this finding tells.
template <class Kind>
const Kind* fault_as(const core::Finding& finding) {
  const auto* const fault = std::get_if<core::found::MotionFault>(&finding.found);
  return fault != nullptr ? std::get_if<Kind>(fault) : nullptr;
}

}  // namespace glidelab::tests
