#include "validate/study/sweep/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>
#include <stdexcept>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

[[noreturn]] void fail(sqlite3* database, int status, std::string_view doing) {
  const char* file = database == nullptr ? nullptr : sqlite3_db_filename(database, nullptr);
  const std::string name = file == nullptr ? "database" : file;
  const std::string what = database == nullptr ? sqlite3_errstr(status) : sqlite3_errmsg(database);
  switch (status & 0xff) {
    case SQLITE_NOTADB:
      throw base::InputError(base::Issue{name, 0, "", "no database", "a database that glidelab sweep has made"});
    case SQLITE_CORRUPT:
      throw base::InputError(base::Issue{name, 0, "", "a damaged database (it was cut off or changed)",
                                         "a database that glidelab sweep has made, as it left it"});
    case SQLITE_ERROR:
    case SQLITE_CONSTRAINT:
    case SQLITE_MISMATCH:
    case SQLITE_MISUSE:
    case SQLITE_RANGE:
      throw std::logic_error(fmt::format("{}: {} ({})", name, what, doing));
    case SQLITE_FULL:
      throw base::EnvironmentError(
          fmt::format("{}: the disk is full; what is finished is kept, run the same command again to continue", name));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw base::EnvironmentError(fmt::format("{}: another process is writing it", name));
    default:
      throw base::EnvironmentError(fmt::format("{}: {} ({})", name, what, sqlite3_errstr(status)));
  }
}

}  // namespace

SqlStatement::SqlStatement(std::shared_ptr<sqlite3> database, std::string_view sql) : database_(std::move(database)) {
  sqlite3_stmt* statement = nullptr;
  const int status = sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  statement_.reset(statement, sqlite3_finalize);
  if (status != SQLITE_OK) fail(database_.get(), status, sql);
}

void SqlStatement::check(int status) const {
  if (status != SQLITE_OK) fail(database_.get(), status, sqlite3_sql(statement_.get()));
}

SqlStatement& SqlStatement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter, value));
  return *this;
}
SqlStatement& SqlStatement::bind(int parameter, double value) {
  check(std::isfinite(value) ? sqlite3_bind_double(statement_.get(), parameter, value)
                             : sqlite3_bind_null(statement_.get(), parameter));
  return *this;
}
SqlStatement& SqlStatement::bind(int parameter, std::string_view value) {
  check(sqlite3_bind_text64(statement_.get(), parameter, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}
SqlStatement& SqlStatement::bind_null(int parameter) {
  check(sqlite3_bind_null(statement_.get(), parameter));
  return *this;
}
SqlStatement& SqlStatement::bind_column(int parameter, const SqlStatement& other, int column) {
  check(sqlite3_bind_value(statement_.get(), parameter, sqlite3_column_value(other.statement_.get(), column)));
  return *this;
}
SqlStatement& SqlStatement::bind(int parameter, const std::optional<double>& value) {
  return value ? bind(parameter, *value) : bind_null(parameter);
}

bool SqlStatement::step() {
  const int status = sqlite3_step(statement_.get());
  if (status == SQLITE_ROW) return true;
  if (status == SQLITE_DONE) return false;
  const std::string sql = sqlite3_sql(statement_.get());
  sqlite3_reset(statement_.get());
  fail(database_.get(), status, sql);
}

void SqlStatement::run() {
  while (step()) {
  }
  reset();
}

void SqlStatement::reset() {
  check(sqlite3_reset(statement_.get()));
  check(sqlite3_clear_bindings(statement_.get()));
}

bool SqlStatement::same_row(const SqlStatement& other, int columns) const {
  for (int i = 0; i < columns; ++i) {
    sqlite3_stmt *const a = statement_.get(), *const b = other.statement_.get();
    const int type = sqlite3_column_type(a, i);
    if (type != sqlite3_column_type(b, i)) return false;
    if (type == SQLITE_INTEGER && integer(i) != other.integer(i)) return false;
    if (type == SQLITE_FLOAT && number(i) != other.number(i)) return false;
    if (type == SQLITE_TEXT && text(i) != other.text(i)) return false;
    if (type == SQLITE_BLOB) return false;  // no table contains one
  }
  return true;
}

bool SqlStatement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::int64_t SqlStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double SqlStatement::number(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}
std::optional<double> SqlStatement::maybe_number(int column) const {
  if (is_null(column)) return std::nullopt;
  return number(column);
}
std::string SqlStatement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  std::string copy;
  for (int i = 0; i < size; ++i) copy += static_cast<char>(text[i]);
  return copy;
}

Database::Database(const std::filesystem::path& file, Mode mode) : file_(file) {
  const int flags = mode == Mode::create  ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                    : mode == Mode::write ? SQLITE_OPEN_READWRITE
                                          : SQLITE_OPEN_READONLY;
  sqlite3* database = nullptr;
  const int status = sqlite3_open_v2(file.c_str(), &database, flags, nullptr);
  database_.reset(database, sqlite3_close_v2);
  if (status != SQLITE_OK) {
    throw base::EnvironmentError(fmt::format("{}: cannot be opened: {}", file.string(), sqlite3_errstr(status)));
  }
  sqlite3_extended_result_codes(database, 1);
  // Code stored in a file never runs, whoever opens it and whenever it was put there.
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  constexpr int kPatience_ms = 10000;  // a reader's checkpoint, a copy of the file
  sqlite3_busy_timeout(database, kPatience_ms);
}

void Database::run(std::string_view sql) {
  const std::string text(sql);
  const int status = sqlite3_exec(database_.get(), text.c_str(), nullptr, nullptr, nullptr);
  if (status != SQLITE_OK) fail(database_.get(), status, sql);
}

Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const std::exception&) {
    // SQLite has already rolled back (as on a full disk); the error that led here is the one to report.
  }
}

void Transaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

std::string sql_name(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace glidelab::validate
