/// File names with wildcards, as a settings file gives them.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace glidelab::core {

/// The regular files below `folder` whose relative path matches `pattern`, sorted by name (byte by byte). `*` and `?`
/// match within one part of the path, `[…]` as in a shell; a name that exists as it stands is taken literally.
std::vector<std::filesystem::path> files_matching(const std::filesystem::path& folder, std::string_view pattern);

}  // namespace glidelab::core
