#include "core/experiment/file_glob.h"

#include <fnmatch.h>

#include <algorithm>
#include <string>
#include <system_error>

namespace glidelab::core {
namespace fs = std::filesystem;

std::vector<fs::path> files_matching(const fs::path& folder, std::string_view pattern) {
  std::error_code ignored;  // what cannot be looked at does not match
  const fs::path relative{std::string(pattern)};
  if (fs::is_regular_file(folder / relative, ignored)) return {folder / relative};
  std::vector<fs::path> found{relative.is_absolute() ? relative.root_path() : folder};
  for (const fs::path& part : relative.relative_path()) {
    std::vector<fs::path> deeper;
    for (const fs::path& place : found) {
      if (part.native().find_first_of("*?[") == std::string::npos) {
        if (fs::exists(place / part, ignored)) deeper.push_back(place / part);
        continue;
      }
      for (fs::directory_iterator entry(place, ignored), end; entry != end; entry.increment(ignored)) {
        const fs::path name = entry->path().filename();
        if (::fnmatch(part.c_str(), name.c_str(), FNM_PERIOD) == 0) deeper.push_back(place / name);
      }
    }
    found = std::move(deeper);
  }
  std::erase_if(found, [&](const fs::path& path) { return !fs::is_regular_file(path, ignored); });
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) { return a.native() < b.native(); });
  return found;
}

}  // namespace glidelab::core
