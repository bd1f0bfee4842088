/// Which files of a folder this program made, so that it replaces these and no file of the user's own.
///
/// A folder that is replaced as a whole (an experiment that `render` made, its truth, a page's plots) holds a list of
/// its files, each with its size and a checksum of its bytes (FNV-1a, 64 bits): what is not in the list, or differs
/// from it, is the user's own. StagedOutput::publish_files carries such files over into the folder that replaces it: a
/// file that was made and changed since becomes NAME.changed if there is a new NAME. The list lies in the folder, so
/// that both are put in place at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

inline constexpr std::string_view kMadeList = ".glidelab-made";

/// Writes `dir`/.glidelab-made: all that is in the folder and below now. EnvironmentError where that fails.
void list_made_files(const std::filesystem::path& dir);

/// A file or link that was not made, or was changed since.
struct OwnFile {
  std::filesystem::path name;  ///< relative to the folder
  bool changed = false;        ///< made, and changed since
};

/// The user's own files in `dir` (which exists) and below, by name: all if there is no list; links always. InputError
/// if a file cannot be read, or the list is not such a list.
std::vector<OwnFile> own_files(const std::filesystem::path& dir);

}  // namespace glidelab::base
