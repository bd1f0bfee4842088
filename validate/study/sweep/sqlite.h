/// SQLite wrapped in one file: a database and its statements, errors as exceptions.
///
/// A full disk, a file that cannot be read or written, and one that another process is writing are EnvironmentError
/// with the file's name; a file that is not a database, or a damaged one, is InputError. Wrong SQL is a programmer's
/// mistake: std::logic_error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace glidelab::validate {

/// A prepared statement; parameters and columns count from 1 and 0, as SQLite does.
class SqlStatement {
 public:
  SqlStatement& bind(int parameter, std::int64_t value);
  SqlStatement& bind(int parameter, double value);
  SqlStatement& bind(int parameter, std::string_view value);
  SqlStatement& bind_null(int parameter);
  /// Binds a column of another statement's row, of any type.
  SqlStatement& bind_column(int parameter, const SqlStatement& other, int column);
  /// NULL if there is none, or if the number is not finite.
  SqlStatement& bind(int parameter, const std::optional<double>& value);

  /// The next row; false at the end.
  bool step();
  /// Runs to its end; the statement can then be bound again.
  void run();
  void reset();

  /// Whether the first `columns` of both rows have the same types and values, numbers to the last bit.
  bool same_row(const SqlStatement& other, int columns) const;
  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double number(int column) const;
  std::optional<double> maybe_number(int column) const;
  std::string text(int column) const;

 private:
  friend class Database;
  SqlStatement(std::shared_ptr<sqlite3> database, std::string_view sql);
  void check(int status) const;
  std::shared_ptr<sqlite3> database_;
  std::shared_ptr<sqlite3_stmt> statement_;
};

/// One connection, used by one thread at a time.
class Database {
 public:
  enum class Mode { create, write, read };
  Database(const std::filesystem::path& file, Mode mode);
  void run(std::string_view sql);
  SqlStatement prepare(std::string_view sql) { return SqlStatement(database_, sql); }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::shared_ptr<sqlite3> database_;
};

/// From BEGIN to commit(); rolled back if it is left without commit().
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

/// A name in double quotes, as SQL requires for columns.
std::string sql_name(std::string_view name);

}  // namespace glidelab::validate
