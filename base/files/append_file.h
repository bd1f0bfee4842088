/// A file that grows piece by piece, for what does not fit into memory.
#pragma once

#include <filesystem>
#include <string_view>

namespace glidelab::base {

/// Adds to the end of a file, which is made where it is not there; EnvironmentError as write_file (staged_output.h).
void append_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace glidelab::base
