#include "base/errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace glidelab::base {
namespace {

constexpr std::size_t kMostLines = 20;  // a screenful, with the command above it

std::string join(const std::vector<Issue>& issues) {
  std::string text;
  for (std::size_t i = 0; i < std::min(issues.size(), kMostLines); ++i) {
    if (!text.empty()) text += '\n';
    text += describe(issues[i]);
  }
  if (issues.size() > kMostLines) text += fmt::format("\nand {} more", issues.size() - kMostLines);
  return text;
}

}  // namespace

std::string describe(const Issue& issue) {
  std::string text = issue.file;
  if (issue.line > 0) text += fmt::format(":{}", issue.line);
  if (!issue.key.empty()) text += (text.empty() ? "" : ": ") + issue.key;
  if (!text.empty()) text += ": ";
  text += "found " + issue.found;
  if (!issue.expected.empty()) text += ", expected " + issue.expected;
  return text;
}

InputError::InputError(std::vector<Issue> issues) : std::runtime_error(join(issues)), issues_(std::move(issues)) {}

void throw_system_error(std::string_view path, std::string_view what, int error_number) {
  throw EnvironmentError(fmt::format("{}: {}: {}", path, what, std::strerror(error_number)));
}

}  // namespace glidelab::base
