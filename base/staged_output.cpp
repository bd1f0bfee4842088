#include "base/staged_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "base/append_file.h"
#include "base/errors.h"

namespace glidelab::base {
namespace fs = std::filesystem;
namespace {

std::atomic<int> next_staging_number{0};

fs::path staging_name(const fs::path& final_dir, std::string_view kind) {
  return final_dir.parent_path() /
         fmt::format("{}.{}-{}-{}", final_dir.filename().string(), kind, ::getpid(), next_staging_number++);
}

/// "a/b/" and "a/b" name one folder; the staging folder stands beside it, so the name must be the last component.
fs::path without_trailing_slash(fs::path path) {
  path = fs::absolute(path).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw_system_error(to.string(), "cannot be put in place", error.value());
}

/// Puts `from` where `to` stands; what stood there is removed only after the new one is in place.
void swap_in(const fs::path& from, const fs::path& to) {
  if (!fs::is_directory(fs::symlink_status(to))) return rename_or_throw(from, to);
  const fs::path old = staging_name(to, "part-old");
  rename_or_throw(to, old);
  try {
    rename_or_throw(from, to);
  } catch (const EnvironmentError&) {
    rename_or_throw(old, to);
    throw;
  }
  std::error_code ignored;  // the new one stands; a leftover of the old one is no reason to fail
  fs::remove_all(old, ignored);
}

}  // namespace

StagedOutput::StagedOutput(fs::path final_dir)
    : final_(without_trailing_slash(std::move(final_dir))), staging_(staging_name(final_, "part")) {
  std::error_code error;
  if (fs::exists(final_, error) && !fs::is_directory(final_, error)) {
    throw_system_error(final_.string(), "cannot be an output folder", ENOTDIR);
  }
  fs::create_directories(staging_, error);
  if (error) throw_system_error(final_.string(), "output folder cannot be written", error.value());
}

StagedOutput::~StagedOutput() {
  std::error_code ignored;  // a destructor has nobody to tell
  fs::remove_all(staging_, ignored);
}

void StagedOutput::publish_files() {
  std::error_code error;
  fs::create_directories(final_, error);
  if (error) throw_system_error(final_.string(), "output folder cannot be made", error.value());
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
    swap_in(entry.path(), final_ / entry.path().filename());
  }
}

void StagedOutput::publish_whole() {
  swap_in(staging_, final_);
}

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
  if (!stream || fs::is_directory(path)) {
    throw InputError(Issue{path.string(), 0, "", fs::exists(path) ? "no readable file" : "nothing", "a readable file"});
  }
  text << stream.rdbuf();
  if (stream.bad()) throw InputError(Issue{path.string(), 0, "", "a read error", "a readable file"});
  return std::move(text).str();
}

}  // namespace glidelab::base
