/// Files on the disk: whole files read and written in one call, temporary folders, the list of the files that this
/// program made, and outputs that appear whole or not at all. Errors name the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

/// Writes the whole text or throws EnvironmentError (a full disk shows at the write or at the close; both are checked).
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Adds to the end of a file, which is created if it does not exist; EnvironmentError as write_file. For a file that
/// grows piece by piece because its contents do not fit into memory.
void append_file(const std::filesystem::path& path, std::string_view bytes);

inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;  ///< bytes; a track of thirty million rows

/// Reads a whole file; InputError if it does not exist, cannot be read, is no regular file (a named pipe would be
/// waited for without end, a device read without end) or is larger than kLargestFile.
std::string read_file(const std::filesystem::path& path);

/// A new temporary folder, removed with its contents at the end of the object's life.
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

/// The list of the files of a folder that this program made. The program replaces these and no file of the user's own.
///
/// A folder that is replaced as a whole (an experiment that `render` made, its truth, a page's plots) holds a list of
/// its files, each with its size and a checksum of its bytes (FNV-1a, 64 bits). A file that is not in the list, or
/// differs from it, is the user's own. StagedOutput::publish_files carries such files over into the folder that
/// replaces it; a file that was made and has since been changed becomes NAME.changed if there is a new NAME. The list
/// lies in the folder, so that both are put in place together.
inline constexpr std::string_view kMadeList = ".glidelab-made";

/// Writes `dir`/.glidelab-made, which lists everything that is now in the folder and below. EnvironmentError if that
/// fails.
void list_made_files(const std::filesystem::path& dir);

/// A file or link that this program did not make, or that has since been changed.
struct OwnFile {
  std::filesystem::path name;  ///< relative to the folder
  bool changed = false;        ///< made, and changed since
};

/// The user's own files in `dir` (which exists) and below, sorted by name. Without a list these are all files; links
/// always count. InputError if a file cannot be read, or the list is malformed.
std::vector<OwnFile> own_files(const std::filesystem::path& dir);

/// Outputs that appear whole or not at all.
///
/// A command writes everything into a staging folder next to the final one (on the same file system, so that rename(2)
/// is atomic) and publishes it once everything has succeeded. An exception removes the staging folder, and the folders
/// above it that it made and that are empty, and leaves the previous output as it was.
class StagedOutput {
 public:
  /// Makes `<parent>/<name>.part-<place>-<pid>-<n>`; EnvironmentError if that cannot be written.
  explicit StagedOutput(std::filesystem::path final_dir);
  ~StagedOutput();
  StagedOutput(const StagedOutput&) = delete;
  StagedOutput& operator=(const StagedOutput&) = delete;

  /// The folder to write into until publication.
  const std::filesystem::path& dir() const { return staging_; }
  const std::filesystem::path& final_dir() const { return final_; }

  /// Renames the staging folder to the final name if no such folder exists. Otherwise moves the staged files into the
  /// final folder one by one: files of these names are replaced, other files stay. A staged sub-folder replaces the one
  /// of its name; the user's own files in it are kept (own_files()). If a file cannot be put in place, the ones before
  /// it are taken back, so that the folder is as it was.
  void publish_files();

  /// Renames the staging folder to the final name as a whole; an existing folder is swapped out and removed.
  void publish_whole();

  /// After publish_whole(): restores what was under the final name before, as far as the file system allows.
  void take_back();

 private:
  std::filesystem::path final_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_parents_;  ///< deepest first
};

}  // namespace glidelab::base
