/// Outputs that appear whole or not at all.
///
/// A command writes everything into a staging folder beside the final one (on the same file system, so that rename(2)
/// is atomic) and publishes it once everything has succeeded. An exception removes the staging folder and leaves what
/// stood before.
#pragma once

#include <filesystem>

#include "base/files/file_io.h"  // what is staged is written with it

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
  /// other files stay. A staged sub-folder replaces the one of its name; the user's own files in it are kept
  /// (made_files.h).
  void publish_files();

  /// Renames the staging folder to the final name as a whole; an existing folder is swapped out and removed.
  void publish_whole();

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;
};

}  // namespace glidelab::base
