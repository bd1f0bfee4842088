#include "base/files/file_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/temporary_folders.h"

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
  std::error_code failure;  // the name is too long, or its folder may not be read
  const fs::file_status status = fs::status(path, failure);
  if (fs::is_fifo(status) || fs::is_socket(status) || fs::is_character_file(status) || fs::is_block_file(status)) {
    throw InputError(Issue{path.string(), 0, "", fs::is_fifo(status) ? "a named pipe" : "a device or socket",
                           "a regular file (save the pipe's output to one first)"});
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (const std::uintmax_t bytes = fs::file_size(path, failure); !failure && bytes > kLargestFile) {
    throw InputError(
        Issue{path.string(), 0, "", fmt::format("{} bytes", bytes), fmt::format("at most {}", kLargestFile)});
  }
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

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) throw EnvironmentError(fmt::format("no folder for temporary files: {}", error.message()));
  std::string pattern = (parent / ("glidelab-" + purpose + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) throw_system_error(pattern, "cannot be made", errno);
  path_ = pattern;
  remember_temporary_folder(path_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // a destructor cannot report errors
  fs::remove_all(path_, ignored);
  forget_temporary_folder(path_);
}

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHead = "glidelab made 1";

std::uint64_t sum_of(const fs::path& file) {
  constexpr std::uint64_t kFnvOffset = 0xcbf29ce484222325u, kFnvPrime = 0x100000001b3u;
  std::uint64_t sum = kFnvOffset;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(Issue{file.string(), 0, "", "no readable file", "a readable file"});
  std::array<char, 1 << 16> bytes;
  do {
    stream.read(bytes.data(), bytes.size());
    for (std::streamsize i = 0; i < stream.gcount(); ++i) {
      sum = (sum ^ static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)])) * kFnvPrime;
    }
  } while (stream);
  if (stream.bad()) throw InputError(Issue{file.string(), 0, "", "a read error", "a readable file"});
  return sum;
}

std::string state_of(const fs::path& file) {
  return fmt::format("{:016x} {}", sum_of(file), fs::file_size(file));
}

/// Everything below `dir` that is not a folder, sorted by name, without the list itself.
std::vector<fs::path> files_below(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dir)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const fs::path name = entry.path().lexically_relative(dir);
    if (name != kMadeList) files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Maps a name to the file's state; empty if there is no list.
std::map<std::string, std::string> listed(const fs::path& dir) {
  const fs::path list = dir / kMadeList;
  std::map<std::string, std::string> files;
  if (!fs::is_regular_file(fs::symlink_status(list))) return files;
  std::istringstream text(read_file(list));
  std::string head, sum, size, name;
  std::getline(text, head);
  while (text >> sum >> size >> std::quoted(name)) files[name] = sum + " " + size;
  if (head != kHead || !text.eof()) {
    throw InputError(Issue{list.string(), 0, "", "something else", "the list of what glidelab made"});
  }
  return files;
}

}  // namespace

void list_made_files(const fs::path& dir) {
  std::ostringstream text;
  text << kHead << '\n';
  for (const fs::path& name : files_below(dir)) {
    text << state_of(dir / name) << ' ' << std::quoted(name.generic_string()) << '\n';
  }
  write_file(dir / kMadeList, text.str());
}

std::vector<OwnFile> own_files(const fs::path& dir) {
  const std::map<std::string, std::string> made = listed(dir);
  std::vector<OwnFile> own;
  for (const fs::path& name : files_below(dir)) {
    const auto entry = made.find(name.generic_string());
    const bool regular = fs::is_regular_file(fs::symlink_status(dir / name));
    if (entry == made.end() || !regular) {
      own.push_back({name, false});
    } else if (entry->second != state_of(dir / name)) {
      own.push_back({name, true});
    }
  }
  return own;
}

namespace fs = std::filesystem;
namespace {

std::atomic<int> next_staging_number{0};

/// Identifies the machine, its boot and the process-number namespace of a process: only within these does a process
/// number tell whether the process still runs. Zero if the system does not say.
std::size_t place_of_processes() {
  std::error_code error;
  std::ifstream boot("/proc/sys/kernel/random/boot_id");
  std::string text;
  const fs::path space = fs::read_symlink("/proc/self/ns/pid", error);
  if (!std::getline(boot, text) || error) return 0;
  return std::hash<std::string>{}(text + space.string());
}

/// "<name>.part-<place>-": followed by a process number and a count, this is the name of what that process writes.
std::string staging_prefix(const fs::path& final_dir) {
  static const std::size_t place = place_of_processes();
  return fmt::format("{}.part-{:016x}-", final_dir.filename().string(), place);
}

fs::path staging_name(const fs::path& final_dir, std::string_view kind = "") {
  return final_dir.parent_path() /
         fmt::format("{}{}-{}{}", staging_prefix(final_dir), ::getpid(), next_staging_number++, kind);
}

/// Removes what killed processes left beside `final_dir`. Leftovers of another machine or of a running process stay.
void clear_leftovers(const fs::path& final_dir) {
  const std::string prefix = staging_prefix(final_dir);
  if (prefix.find("-0000000000000000-") != std::string::npos) return;
  std::error_code ignored;  // what cannot be read or removed stays; this is no reason to fail
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator entry(final_dir.parent_path(), ignored), end; entry != end; entry.increment(ignored)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(prefix)) continue;
    long process = 0;
    int number = 0, length = 0;
    const char* rest = name.c_str() + prefix.size();
    if (std::sscanf(rest, "%ld-%d%n", &process, &number, &length) != 2 || rest[length] != '\0' || process <= 0)
      continue;
    if (::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) leftovers.push_back(entry->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
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

/// Puts `from` in the place of `to`. The previous `to` is afterwards in the place of `from`, or removed; if the process
/// is killed in between, one of the two is whole. On a file system that cannot exchange names, folders need two
/// renames, with an instant between them.
void swap_in(const fs::path& from, const fs::path& to) {
  if (!fs::exists(fs::symlink_status(to))) return rename_or_throw(from, to);
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) throw_system_error(to.string(), "cannot be put in place", errno);
  if (!fs::is_directory(fs::symlink_status(to))) return rename_or_throw(from, to);
  const fs::path old = staging_name(to, ".old");
  rename_or_throw(to, old);
  try {
    rename_or_throw(from, to);
  } catch (const EnvironmentError&) {
    rename_or_throw(old, to);
    throw;
  }
  std::error_code ignored;  // the new one is in place; a leftover of the old one is no reason to fail
  fs::remove_all(old, ignored);
}

/// Gives a file a second name: nothing is moved, so that a kill loses nothing.
void link_or_copy(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  if (::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), 0) != 0)
    fs::copy(from, to, fs::copy_options::copy_symlinks);
}

/// Carries the user's own files in the folder `old` over into `fresh`, which replaces it.
void keep_own_files(const fs::path& old, const fs::path& fresh) {
  const bool known = fs::exists(old / kMadeList);
  for (const OwnFile& own : own_files(old)) {
    fs::path kept = fresh / own.name;
    if (fs::exists(kept) && !known) continue;  // made by a version that kept no list: the same plot, drawn again
    while (fs::exists(fs::symlink_status(kept))) kept += ".changed";
    link_or_copy(old / own.name, kept);
  }
}

}  // namespace

namespace {

/// EnvironmentError if the folder, or one of its parent folders, is a dangling link.
void refuse_dangling(const fs::path& folder) {
  std::error_code error;  // a folder that cannot be read fails later, when it is made
  for (fs::path at = folder; at.has_relative_path(); at = at.parent_path()) {
    if (!fs::is_symlink(fs::symlink_status(at, error)) || fs::exists(at, error)) continue;
    const fs::path target = fs::read_symlink(at, error);
    throw EnvironmentError(at.string() + ": is a dangling link (" + target.string() + " does not exist)");
  }
}

/// The folders above this one that do not exist yet, deepest first.
std::vector<fs::path> missing_parents(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;  // a folder that cannot be looked at was not made here
  for (fs::path at = folder.parent_path(); at.has_relative_path(); at = at.parent_path()) {
    if (fs::symlink_status(at, error).type() != fs::file_type::not_found) break;
    missing.push_back(at);
  }
  return missing;
}

}  // namespace

StagedOutput::StagedOutput(fs::path final_dir)
    : final_(without_trailing_slash(std::move(final_dir))), staging_(staging_name(final_)) {
  std::error_code error;
  if (fs::exists(final_, error) && !fs::is_directory(final_, error)) {
    throw_system_error(final_.string(), "cannot be an output folder", ENOTDIR);
  }
  refuse_dangling(final_);
  clear_leftovers(final_);
  made_parents_ = missing_parents(staging_);
  remember_temporary_folder(staging_, made_parents_);  // before it is there: this may end for want of memory
  const auto give_up = [&] {
    ::rmdir(staging_.c_str());
    remove_empty_folders(made_parents_);
    forget_temporary_folder(staging_);
  };
  try {
    fs::create_directories(staging_, error);
  } catch (const std::bad_alloc&) {
    give_up();
    throw;
  }
  if (error) {
    give_up();
    throw_system_error(final_.string(), "output folder cannot be written", error.value());
  }
}

StagedOutput::~StagedOutput() {
  try {
    std::error_code ignored;  // a destructor cannot report errors
    fs::remove_all(staging_, ignored);
    remove_empty_folders(made_parents_);
    forget_temporary_folder(staging_);
  } catch (const std::bad_alloc&) {  // the next run to the same output removes it
  }
}

namespace {

/// Reverses swap_in(from, to).
void undo_swap(const fs::path& from, const fs::path& to) {
  std::error_code ignored;  // the error that led here is the one to report
  if (!fs::exists(fs::symlink_status(from, ignored))) {
    fs::rename(to, from, ignored);
  } else {
    ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE);
  }
}

/// The outputs put in place so far. Unless they are kept, the destructor takes them back: each new output returns to
/// the staging folder, and what it replaced comes back from there.
class Placed {
 public:
  explicit Placed(const fs::path& final_dir) : final_(final_dir) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;
  ~Placed() {
    try {
      for (const fs::path& staged : staged_) undo_swap(staged, final_ / staged.filename());
    } catch (const std::bad_alloc&) {  // what is in place stays there; the error that led here is reported
    }
  }
  void add(const fs::path& staged) { staged_.push_back(staged); }
  void keep() { staged_.clear(); }

 private:
  const fs::path& final_;
  std::vector<fs::path> staged_;
};

}  // namespace

void StagedOutput::publish_files() {
  // Listed first, because exchanging changes the listed folder, and because the standard library ends the program where
  // it lists a folder without memory: until the publishing begins, nothing then stays.
  std::vector<fs::path> staged;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) staged.push_back(entry.path());
  for (const fs::path& path : staged) {
    if (fs::is_directory(path)) list_made_files(path);
  }
  begin_publishing();
  if (!fs::exists(fs::symlink_status(final_))) return rename_or_throw(staging_, final_);
  Placed placed(final_);
  for (const fs::path& path : staged) {
    const fs::path old = final_ / path.filename();
    if (fs::is_directory(path) && fs::is_directory(fs::symlink_status(old))) keep_own_files(old, path);
    swap_in(path, old);
    placed.add(path);
  }
  placed.keep();
}

void StagedOutput::publish_whole() {
  begin_publishing();
  swap_in(staging_, final_);
}

void StagedOutput::take_back() {
  undo_swap(staging_, final_);
}

}  // namespace glidelab::base
