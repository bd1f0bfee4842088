/// What a command said, and what it left in a folder.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/app/run_process.h"

namespace glidelab::tests {

inline std::vector<std::string> names_in(const std::filesystem::path& dir) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(dir)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline bool says(const ProcessResult& result, const std::string& part) {
  return result.err.find(part) != std::string::npos;
}

}  // namespace glidelab::tests
