#include "base/files/temporary_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <system_error>

#include "base/errors.h"

namespace glidelab::base {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) throw EnvironmentError(fmt::format("no folder for temporary files: {}", error.message()));
  std::string pattern = (parent / ("glidelab-" + purpose + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) throw_system_error(pattern, "cannot be made", errno);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // a destructor has nobody to tell
  fs::remove_all(path_, ignored);
}

}  // namespace glidelab::base
