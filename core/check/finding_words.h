/// Wording that the findings of a check share, and a collector for the findings about one subject.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/check/recording_check.h"

namespace glidelab::core {

inline std::string percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

/// At most six names, and how many more there are.
inline std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::size_t shown = std::min(kMost, names.size());
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// Collects the findings about one subject; `findings` outlive it.
class FindingBook {
 public:
  FindingBook(std::vector<Finding>& findings, std::string about) : findings_(findings), about_(std::move(about)) {}
  void add(Severity severity, std::string found, std::string advice = {}) {
    findings_.push_back({severity, about_, std::move(found), std::move(advice)});
  }

 private:
  std::vector<Finding>& findings_;
  std::string about_;
};

}  // namespace glidelab::core
