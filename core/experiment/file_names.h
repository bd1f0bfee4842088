/// Names of files: as people give and number them, and as experiment.toml may state them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml/strict_toml.h"
#include "core/experiment/permissions.h"

namespace glidelab::core {

/// Orders names as people number files: "2.png" before "10.png".
bool natural_less(const std::string& a, const std::string& b);

/// Letters in lower case (ASCII only).
std::string lower(std::string_view text);

/// ".png" of "IMG_1.PNG"; empty where the name has no ending.
std::string lower_extension(const std::filesystem::path& file);

/// The files that experiment.toml names, and where they may lie.
///
/// A name counts from the folder and is taken as it is written (a/../b is b). One that leaves the folder, or that is
/// absolute, is refused unless the person who runs the program allows it: a folder that came from elsewhere cannot make
/// the program open what is not in it. A symbolic link in the folder is followed: whoever put it there asked for it.
struct FolderFiles {
  std::filesystem::path folder;
  OutsideFiles outside = OutsideFiles::refused;

  /// The files that a key with wildcards names; at least one, else that is recorded as an error of the key.
  std::vector<std::filesystem::path> files(const base::TomlTable& table, std::string_view key) const;
  /// The one file that a key names, or where `or_folder` the folder of frames; that it exists is checked.
  std::filesystem::path file(const base::TomlTable& table, std::string_view key, bool or_folder = false) const;
};

/// The regular files below `folder` whose relative path matches `pattern`, sorted by name (byte by byte). `*` and `?`
/// match within one part of the path, `[…]` as in a shell; a name that exists as it stands is taken literally.
std::vector<std::filesystem::path> files_matching(const std::filesystem::path& folder, std::string_view pattern);

}  // namespace glidelab::core
