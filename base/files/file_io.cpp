#include "base/files/file_io.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/errors.h"

namespace glidelab::base {
namespace fs = std::filesystem;
namespace {

void write_with(int flags, const fs::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0666);
  if (file < 0) throw_system_error(path.string(), "cannot be written", errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      ::close(file);
      throw_system_error(path.string(), "cannot be written", error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(file) != 0) throw_system_error(path.string(), "cannot be written", errno);
}

}  // namespace

void write_file(const fs::path& path, std::string_view bytes) {
  write_with(O_TRUNC, path, bytes);
}

void append_file(const fs::path& path, std::string_view bytes) {
  write_with(O_APPEND, path, bytes);
}

std::string read_file(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  std::error_code failure;  // of a name that is too long, or in a folder that may not be looked into
  const fs::file_status status = fs::status(path, failure);
  if (!stream || fs::is_directory(status)) {
    throw InputError(Issue{path.string(), 0, "",
                           fs::is_directory(status)               ? "a folder"
                           : fs::exists(status)                   ? "no readable file"
                           : status.type() == fs::file_type::none ? failure.message()
                                                                  : "nothing",
                           fs::is_directory(status) ? "a file" : "a readable file"});
  }
  text << stream.rdbuf();
  if (stream.bad()) throw InputError(Issue{path.string(), 0, "", "a read error", "a readable file"});
  return std::move(text).str();
}

}  // namespace glidelab::base
