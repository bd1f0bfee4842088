#include "base/errors.h"

#include <fmt/format.h>

#include <cstring>

namespace glidelab::base {
namespace {

std::string join(const std::vector<Issue>& issues) {
  std::string text;
  for (const Issue& issue : issues) {
    if (!text.empty()) text += '\n';
    text += describe(issue);
  }
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
