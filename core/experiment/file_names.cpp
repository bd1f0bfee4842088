#include "core/experiment/file_names.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "base/text/number_text.h"

namespace glidelab::core {

bool natural_less(const std::string& a, const std::string& b) {
  using base::is_digit;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    std::size_t i_end = i;
    std::size_t j_end = j;
    while (i_end < a.size() && is_digit(a[i_end])) ++i_end;
    while (j_end < b.size() && is_digit(b[j_end])) ++j_end;
    if (i_end - i != j_end - j) return i_end - i < j_end - j;
    const int order = a.compare(i, i_end - i, b, j, j_end - j);
    if (order != 0) return order < 0;
    i = i_end;
    j = j_end;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return small;
}

std::string lower_extension(const std::filesystem::path& file) {
  return lower(file.extension().string());
}

namespace fs = std::filesystem;
namespace {

/// The normalised name; if an error is recorded, empty.
std::optional<std::string> name_within(const base::TomlTable& table, std::string_view key, OutsideFiles outside) {
  const std::string name = table.text(key);
  if (name.empty()) return std::nullopt;
  if (name.find('\0') != std::string::npos) {
    table.reject(key, "a name with a zero byte", "the name of a file");
    return std::nullopt;
  }
  const fs::path plain = fs::path(name).lexically_normal();
  if (outside == OutsideFiles::refused && (plain.is_absolute() || *plain.begin() == "..")) {
    table.reject(key, fmt::format("\"{}\", outside the folder", name),
                 "a file in the experiment's folder (--allow-outside takes others)");
    return std::nullopt;
  }
  return plain.string();
}

}  // namespace

std::vector<fs::path> FolderFiles::files(const base::TomlTable& table, std::string_view key) const {
  const auto pattern = name_within(table, key, outside);
  if (!pattern) return {};
  std::vector<fs::path> files = files_matching(folder, *pattern);
  if (files.empty()) {
    table.reject(key, fmt::format("no file {}", (folder / *pattern).string()),
                 "the name of one or more files that exist");
  }
  return files;
}

fs::path FolderFiles::file(const base::TomlTable& table, std::string_view key, bool or_folder) const {
  const auto name = name_within(table, key, outside);
  if (!name) return {};
  fs::path path = folder / *name;
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored) || (or_folder && fs::is_directory(path, ignored))) return path;
  table.reject(key, fmt::format("no file {}", path.string()),
               or_folder ? "the name of a file or a folder of frames that exists" : "the name of a file that exists");
  return path;
}

std::vector<fs::path> files_matching(const fs::path& folder, std::string_view pattern) {
  std::error_code ignored;  // what cannot be read does not match
  const fs::path relative{std::string(pattern)};
  if (fs::is_regular_file(folder / relative, ignored)) return {folder / relative};
  std::vector<fs::path> found{relative.is_absolute() ? relative.root_path() : folder};
  for (const fs::path& part : relative.relative_path()) {
    std::vector<fs::path> deeper;
    for (const fs::path& place : found) {
      if (part.native().find_first_of("*?[") == std::string::npos) {
        if (fs::exists(place / part, ignored)) deeper.push_back(place / part);
        continue;
      }
      for (fs::directory_iterator entry(place, ignored), end; entry != end; entry.increment(ignored)) {
        const fs::path name = entry->path().filename();
        if (::fnmatch(part.c_str(), name.c_str(), FNM_PERIOD) == 0) deeper.push_back(place / name);
      }
    }
    found = std::move(deeper);
  }
  std::erase_if(found, [&](const fs::path& path) { return !fs::is_regular_file(path, ignored); });
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) { return a.native() < b.native(); });
  return found;
}

}  // namespace glidelab::core
