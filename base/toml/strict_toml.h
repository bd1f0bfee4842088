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
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace glidelab::base {

/// A single value of a TOML file: a number, a switch or a string.
using TomlScalar = std::variant<double, bool, std::string>;

/// The allowed values, and their description for messages. Numbers that are not finite are never allowed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool contains(double value) const;
  std::string describe() const;
};
Range any_number();
Range above(double low);
Range at_least(double low);
Range between(double low, double high);       ///< both ends allowed
Range between_open(double low, double high);  ///< neither end allowed

struct TomlNode;

/// One table of the file, which checks each value as it is asked for and remembers the keys that were asked for. Cheap
/// to copy; lives as long as its TomlFile.
class TomlTable {
 public:
  bool has(std::string_view key) const;
  int line() const;                              ///< where the table starts
  int line(std::string_view key) const;          ///< the key's line; the table's line if the key is missing
  std::string path(std::string_view key) const;  ///< "camera.frame_rate_hz", for messages

  double number(std::string_view key, Range range = {}) const;
  double number_or(std::string_view key, double otherwise, Range range = {}) const;
  std::optional<double> maybe_number(std::string_view key, Range range = {}) const;
  /// A whole number in [low, high].
  long integer(std::string_view key, long low, long high) const;
  long integer_or(std::string_view key, long otherwise, long low, long high) const;
  bool boolean_or(std::string_view key, bool otherwise) const;
  std::string text(std::string_view key) const;  ///< not empty
  std::string text_or(std::string_view key, std::string_view otherwise) const;
  std::optional<std::string> maybe_text(std::string_view key) const;
  /// One of the given words; `otherwise`, if not empty, is returned for a missing key.
  std::string word(std::string_view key, const std::vector<std::string>& allowed,
                   std::string_view otherwise = {}) const;
  /// One of the given words, required. If it is missing or another word, an error is recorded and the result is empty.
  /// For a word that decides what else is read.
  std::optional<std::string> one_of(std::string_view key, const std::vector<std::string>& allowed) const;
  /// An array of exactly `count` numbers (any length if count is 0).
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range = {}) const;
  std::optional<std::vector<double>> maybe_numbers(std::string_view key, std::size_t count, Range range = {}) const;
  std::vector<std::string> texts_or_none(std::string_view key) const;
  /// All numbers, switches and texts of this table and those within it, by their path from here ("shutter.kind",
  /// written as one quoted key or as dotted keys). Anything else, an array or a date, is recorded as wrong.
  std::vector<std::pair<std::string, TomlScalar>> scalars() const;

  TomlTable table(std::string_view key) const;  ///< required
  std::optional<TomlTable> maybe_table(std::string_view key) const;
  std::vector<TomlTable> tables(std::string_view key) const;  ///< [[key]], one or more
  std::vector<TomlTable> tables_or_none(std::string_view key) const;

  std::vector<std::string> keys() const;  ///< all keys of this table, known or not

  /// Everything below this key is the user's own and is not checked.
  void ignore(std::string_view key) const;

  /// Records an error that the caller found (a name used twice), unless the key's value could not be read anyway.
  void reject(std::string_view key, std::string found, std::string expected) const;

 private:
  friend class TomlFile;
  explicit TomlTable(std::shared_ptr<TomlNode> node) : node_(std::move(node)) {}
  std::shared_ptr<TomlNode> node_;
};

struct TomlDocument;

class TomlFile {
 public:
  /// InputError with line and column if the file is missing or not valid TOML. `shown_as` is the name in messages.
  static TomlFile load(const std::filesystem::path& path);
  static TomlFile parse(std::string_view text, std::string shown_as);
  ~TomlFile();
  TomlFile(TomlFile&&) noexcept;
  TomlFile& operator=(TomlFile&&) noexcept;

  /// Moves to `table` of this file (made if it is missing) those keys of the same table in `others` that it lacks,
  /// except those in `without`. Messages name the file that a value comes from. Must be called before the table is
  /// read.
  void add_missing(std::string_view table, TomlFile& others, const std::vector<std::string>& without);

  TomlTable root() const;
  const std::string& name() const;

  /// Throws InputError with everything that was rejected and every key that was never asked for (with the nearest known
  /// name).
  void finish() const;

 private:
  explicit TomlFile(std::shared_ptr<TomlDocument> document);
  std::shared_ptr<TomlDocument> document_;
};

}  // namespace glidelab::base
