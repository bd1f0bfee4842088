/// Names of files as people give them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glidelab::core {

/// Orders names as people number files: "2.png" before "10.png".
bool natural_less(const std::string& a, const std::string& b);

/// Letters in lower case (ASCII only).
std::string lower(std::string_view text);

/// ".png" of "IMG_1.PNG"; empty where the name has no ending.
std::string lower_extension(const std::filesystem::path& file);

}  // namespace glidelab::core
