#include "base/files/made_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "base/errors.h"
#include "base/files/file_io.h"

namespace glidelab::base {
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

/// All that is no folder, below `dir`, by name; the list itself is not among them.
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

/// From a name to the file's state; empty where there is no list.
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

}  // namespace glidelab::base
