/// Whole files, read and written in one call, with errors that name the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glidelab::base {

/// Writes the whole text or throws EnvironmentError (a full disk shows at the write or at the close; both are checked).
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Adds to the end of a file, which is created if it does not exist; EnvironmentError as write_file. For a file that
/// grows piece by piece because its contents do not fit into memory.
void append_file(const std::filesystem::path& path, std::string_view bytes);

/// Reads a whole file; InputError if it does not exist or cannot be read.
std::string read_file(const std::filesystem::path& path);

}  // namespace glidelab::base
