/// Outputs that appear whole or not at all.
///
/// A command writes everything into a staging folder beside the final one (same file system, so that rename(2) is
/// atomic) and publishes it when all has succeeded. An exception removes the staging folder and leaves what stood
/// before.
#pragma once

#include <filesystem>
#include <string_view>

namespace glidelab::base {

class StagedOutput {
 public:
  /// Makes `<parent>/<name>.part-<place>-<pid>-<n>`; EnvironmentError where that cannot be written.
  explicit StagedOutput(std::filesystem::path final_dir);
  ~StagedOutput();
  StagedOutput(const StagedOutput&) = delete;
  StagedOutput& operator=(const StagedOutput&) = delete;

  /// The folder to write into until publication.
  const std::filesystem::path& dir() const { return staging_; }
  const std::filesystem::path& final_dir() const { return final_; }

  /// Renames the staged files into the final folder one by one (made if need be); files of these names are replaced,
  /// other files stay. A staged sub-folder replaces the one of its name; somebody's own there is kept (made_files.h).
  void publish_files();

  /// Renames the staging folder to the final name as a whole; an existing folder is swapped out and removed.
  void publish_whole();

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;
};

/// Writes the whole text or throws EnvironmentError (a full disk shows at the write or at the close; both are checked).
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Adds to the end of a file, which is made where it is not there; EnvironmentError as write_file.
void append_file(const std::filesystem::path& path, std::string_view bytes);

/// Reads a whole file; InputError where it is not there or cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace glidelab::base
