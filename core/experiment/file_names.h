/// File names: how users write and number them, and how experiment.toml may state them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml/strict_toml.h"
#include "core/experiment/permissions.h"

namespace glidelab::core {

/// Orders numbered files naturally: "2.png" before "10.png".
bool natural_less(const std::string& a, const std::string& b);

/// Letters in lower case (ASCII only).
std::string lower(std::string_view text);

/// ".png" for "IMG_1.PNG"; empty if the name has no extension.
std::string lower_extension(const std::filesystem::path& file);

/// The files that experiment.toml names, and where they may be.
///
/// A name is relative to the folder and is resolved lexically (a/../b is b). A name that leaves the folder, or that is
/// absolute, is refused unless the user who runs the program allows it: a folder from elsewhere cannot make the program
/// open files outside it. A symbolic link in the folder is followed: it was put there on purpose.
struct FolderFiles {
  std::filesystem::path folder;
  OutsideFiles outside = OutsideFiles::refused;

  /// The files that a key with wildcards names; if there is none, an error of the key is recorded.
  std::vector<std::filesystem::path> files(const base::TomlTable& table, std::string_view key) const;
  /// The one file that a key names or, if `or_folder`, the folder of frames; its existence is checked.
  std::filesystem::path file(const base::TomlTable& table, std::string_view key, bool or_folder = false) const;
};

/// The regular files below `folder` whose relative path matches `pattern`, sorted by name (byte by byte). `*` and `?`
/// match within one part of the path, `[…]` as in a shell; a name that exists as it stands is taken literally.
std::vector<std::filesystem::path> files_matching(const std::filesystem::path& folder, std::string_view pattern);

}  // namespace glidelab::core
