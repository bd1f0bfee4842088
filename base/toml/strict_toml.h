/// TOML files read strictly: unknown keys, wrong types and values out of range are errors that name file, line and key.
///
/// All of a file's errors are collected and thrown together by finish(). Until then a value that is missing or wrong
/// reads as NaN, zero or an empty text, which must not be used before finish() has returned.
///
///     TomlFile file = TomlFile::load(path);
///     TomlTable camera = file.root().table("camera");
///     double rate_hz = camera.number("frame_rate_hz", above(0.0));
///     file.finish();
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml/toml_table.h"

namespace glidelab::base {

struct TomlDocument;

class TomlFile {
 public:
  /// InputError with line and column if the file is missing or not valid TOML. `shown_as` is the name in messages.
  static TomlFile load(const std::filesystem::path& path);
  static TomlFile parse(std::string_view text, std::string shown_as);
  ~TomlFile();
  TomlFile(TomlFile&&) noexcept;
  TomlFile& operator=(TomlFile&&) noexcept;

  /// Gives `table` of this file (made, where it is missing) the keys that it lacks and the table of that name in
  /// `others` has, but for those in `without`; they move from there to here. Messages name the file that a value comes
  /// from. To be called before the table is read.
  void add_missing(std::string_view table, TomlFile& others, const std::vector<std::string>& without);

  TomlTable root() const;
  const std::string& name() const;

  /// Throws InputError with everything that was rejected, and every key that was never asked for (with the nearest
  /// known name).
  void finish() const;

 private:
  explicit TomlFile(std::shared_ptr<TomlDocument> document);
  std::shared_ptr<TomlDocument> document_;
};

}  // namespace glidelab::base
