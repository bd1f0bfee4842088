/// A new temporary folder, removed with its contents at the end of the object's life.
#pragma once

#include <filesystem>
#include <string>

namespace glidelab::base {

class TemporaryFolder {
 public:
  /// Makes `glidelab-<purpose>-XXXXXX`; EnvironmentError if there is no folder for temporary files or it is full.
  explicit TemporaryFolder(const std::string& purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace glidelab::base
