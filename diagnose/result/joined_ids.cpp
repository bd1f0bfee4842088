#include "diagnose/result/joined_ids.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace glidelab::diagnose {
namespace {

constexpr std::string_view kAnd = " + ";

}  // namespace

std::string joined_ids(const std::vector<std::string>& ids) {
  return fmt::format("{}", fmt::join(ids, kAnd));
}

std::vector<std::string> split_ids(std::string_view text) {
  std::vector<std::string> ids;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(kAnd, at), text.size());
    ids.emplace_back(text.substr(at, end - at));
    at = end == text.size() ? end + 1 : end + kAnd.size();
  }
  return ids;
}

}  // namespace glidelab::diagnose
