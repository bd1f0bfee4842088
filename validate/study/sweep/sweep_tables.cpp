#include "validate/study/sweep/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

constexpr const char* kTables = R"sql(
CREATE TABLE sweep (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE "schema" ("table" TEXT, "column" TEXT, unit TEXT, meaning TEXT, PRIMARY KEY ("table", "column")) WITHOUT ROWID;
CREATE TABLE result (run INTEGER, configuration TEXT, estimator TEXT, quantity TEXT, truth REAL, value REAL, sd REAL,
                     low95 REAL, high95 REAL, least_sd REAL, why TEXT, uncorrected REAL,
                     PRIMARY KEY (run, configuration, estimator, quantity)) WITHOUT ROWID;
CREATE TABLE clip (run INTEGER, clip TEXT, estimator TEXT, frames INTEGER, detected INTEGER, bandwidth_s REAL,
                   position_noise_m REAL, r2_up REAL, r2_down REAL, a_rms_error_m_s2 REAL,
                   PRIMARY KEY (run, clip, estimator)) WITHOUT ROWID;
CREATE TABLE timing (run INTEGER PRIMARY KEY, wall_s REAL);
INSERT INTO "schema" VALUES
 ('run', 'run', '', 'number of the run, from 0'), ('run', 'point', '', 'combination of values: run / replicates'),
 ('run', 'replicate', '', 'which of the runs of its point'), ('run', 'seed', '', 'of all random numbers of the run'),
 ('run', 'status', '', 'done or failed'), ('run', 'why', '', 'why a run failed'),
 ('result', 'run', '', 'number of the run'), ('clip', 'run', '', 'number of the run'),
 ('timing', 'run', '', 'number of the run'), ('clip', 'clip', '', 'its name in the scenario'),
 ('result', 'configuration', '', 'its name in the scenario'), ('result', 'estimator', '', 'how it was analysed'),
 ('result', 'quantity', '', 'what was recovered, with its unit: k_over_m_1_s, mu, alpha_deg, v_lim_m_s'),
 ('result', 'truth', 'of the quantity', 'what the scenario put in; null where it has no such thing'),
 ('result', 'value', 'of the quantity', 'as recovered; null where the data do not determine it'),
 ('result', 'sd', 'of the quantity', 'standard deviation as the analysis states it'),
 ('result', 'low95', 'of the quantity', 'lower end of the stated 95 % interval'),
 ('result', 'high95', 'of the quantity', 'upper end of the stated 95 % interval'),
 ('result', 'least_sd', 'of the quantity', 'Cramer-Rao bound of the standard deviation; of tracks only'),
 ('result', 'why', '', 'why there is no value'),
 ('result', 'uncorrected', 'of the quantity', 'value before the smoothing''s bias was taken off; null where none was'),
 ('clip', 'estimator', '', 'how it was analysed'), ('clip', 'frames', '', 'of the clip'),
 ('clip', 'detected', '', 'frames in which the marker was found'),
 ('clip', 'bandwidth_s', 's', 'standard deviation of the smoothing kernel'),
 ('clip', 'position_noise_m', 'm', 'standard deviation of a position, as estimated'),
 ('clip', 'r2_up', '', 'of the line a(v) for v < 0'), ('clip', 'r2_down', '', 'of the line a(v) for v > 0'),
 ('clip', 'a_rms_error_m_s2', 'm/s^2', 'root mean square of a(t) minus the truth, over the points that count'),
 ('timing', 'wall_s', 's', 'wall time of the run on its thread');
)sql";

/// A key's unit is the end of its name.
std::string unit_of_key(const std::string& key) {
  static const std::vector<std::pair<const char*, const char*>> kUnits = {{"_over_m_1_s", "1/s"},
                                                                          {"_m_s2", "m/s^2"},
                                                                          {"_n_s_m", "N s/m"},
                                                                          {"_e_s", "e-/s"},
                                                                          {"_photons_s", "1/s"},
                                                                          {"_m_s", "m/s"},
                                                                          {"_kbit_s", "kbit/s"},
                                                                          {"_kg_m", "kg/m"},
                                                                          {"_kg", "kg"},
                                                                          {"_deg", "deg"},
                                                                          {"_hz", "Hz"},
                                                                          {"_px", "px"},
                                                                          {"_ppm", "1e-6"},
                                                                          {"_s", "s"},
                                                                          {"_m", "m"},
                                                                          {"_n", "N"},
                                                                          {"_e", "e-"}};
  const std::size_t index = key.rfind('[');
  const std::string bare = key.back() == ']' && index != std::string::npos ? key.substr(0, index) : key;
  for (const auto& [ending, unit] : kUnits) {
    if (bare.ends_with(ending)) return unit;
  }
  return {};
}

std::string run_table(const Sweep& sweep) {
  std::string sql =
      "CREATE TABLE run (run INTEGER PRIMARY KEY, point INTEGER NOT NULL, replicate INTEGER NOT NULL, seed INTEGER NOT "
      "NULL, status TEXT NOT NULL, why TEXT";
  for (const Axis& axis : sweep.axes) sql += ", " + sql_name(axis.name);
  return sql + ")";
}

}  // namespace

void make_tables(Database& database, const Sweep& sweep) {
  database.run(kTables);
  database.run(run_table(sweep));
  SqlStatement column = database.prepare("INSERT INTO \"schema\" VALUES ('run', ?1, ?2, ?3)");
  for (const Axis& axis : sweep.axes) {
    column.bind(1, axis.name).bind(2, axis.choices.empty() ? unit_of_key(axis.keys.front()) : "");
    column.bind(3, fmt::format("varied: {}", fmt::join(axis.keys, ", "))).run();
  }
}

namespace {

[[noreturn]] void refuse(const Database& database, const std::string& where, const std::string& found,
                         const std::string& expected) {
  throw base::InputError(base::Issue{database.file().string(), 0, where, found, expected});
}

/// The statement that made a table; empty if there is none of that name.
std::optional<std::string> made_by(Database& database, const std::string& table) {
  SqlStatement select = database.prepare("SELECT sql FROM sqlite_master WHERE type = 'table' AND name = ?1");
  if (!select.bind(1, std::string_view(table)).step()) return std::nullopt;
  return select.text(0);
}

std::vector<std::pair<std::string, std::string>> columns_of(Database& database, const std::string& table) {
  std::vector<std::pair<std::string, std::string>> columns;  // name, type
  SqlStatement select = database.prepare("SELECT name, type FROM pragma_table_info(?1)");
  select.bind(1, std::string_view(table));
  while (select.step()) columns.emplace_back(select.text(0), select.text(1));
  return columns;
}

void check_table(Database& database, Database& model, const std::string& table) {
  const std::string where = fmt::format("table \"{}\"", table);
  const std::optional<std::string> found = made_by(database, table), expected = made_by(model, table);
  if (found == expected) return;
  if (!found) refuse(database, where, "no such table", "that of a sweep");
  const auto there = columns_of(database, table), wanted = columns_of(model, table);
  for (const auto& column : wanted) {
    if (std::find(there.begin(), there.end(), column) != there.end()) continue;
    refuse(database, where, fmt::format("no column \"{}\"", column.first),
           fmt::format("one{}{}", column.second.empty() ? "" : " of the type ", column.second));
  }
  refuse(database, where, *found, *expected);
}

/// An SQL condition: the value of a column does not have the column's declared type. Numbers must be finite.
std::string of_wrong_type(const std::string& column, const std::string& type) {
  const std::string name = sql_name(column);
  const std::string infinite = fmt::format("(typeof({0}) = 'real' AND abs({0}) > 1.7976931348623157e308)", name);
  if (type == "INTEGER") return fmt::format("typeof({}) NOT IN ('integer', 'null')", name);
  if (type == "REAL") return fmt::format("typeof({}) NOT IN ('real', 'null') OR {}", name, infinite);
  if (type == "TEXT") return fmt::format("typeof({}) NOT IN ('text', 'null')", name);
  return fmt::format("typeof({}) = 'blob' OR {}", name, infinite);
}

std::string words_of_type(const std::string& type) {
  return type == "INTEGER" ? "a whole number"
         : type == "REAL"  ? "a finite number"
         : type == "TEXT"  ? "text"
                           : "a finite number or text";
}

}  // namespace

void refuse_code(Database& database) {
  SqlStatement select = database.prepare(
      "SELECT type, name, tbl_name FROM sqlite_master WHERE type NOT IN ('table', 'index') OR "
      "(type = 'index' AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\') ORDER BY type, name");
  if (!select.step()) return;
  const std::string type = select.text(0);
  refuse(database, fmt::format("{} \"{}\"", type, select.text(1)),
         type == "view" ? type : fmt::format("{} {} on \"{}\"", type == "index" ? "an" : "a", type, select.text(2)),
         "tables only, as a sweep makes them");
}

bool has_entries(Database& database) {
  Database model(":memory:", Database::Mode::create);
  model.run(kTables);
  for (const char* table : {"sweep", "run", "result"}) {
    if (!made_by(database, table)) return false;
  }
  check_table(database, model, "sweep");
  return true;
}

void check_tables(Database& database, const Sweep& sweep) {
  Database model(":memory:", Database::Mode::create);
  make_tables(model, sweep);
  for (const char* table : {"sweep", "schema", "run", "result", "clip", "timing"}) check_table(database, model, table);
  SqlStatement check = database.prepare("PRAGMA quick_check(1)");
  if (check.step() && check.text(0) != "ok") {
    refuse(database, "", fmt::format("a damaged database ({})", check.text(0)),
           "a database that glidelab sweep has made, as it left it");
  }
}

void check_values(Database& database) {
  for (const char* table : {"run", "result", "clip", "timing"}) {
    const auto columns = columns_of(database, table);
    std::string which;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      which += fmt::format(" WHEN {} THEN {}", of_wrong_type(columns[c].first, columns[c].second), c);
    }
    SqlStatement wrong = database.prepare(
        fmt::format("SELECT run, wrong FROM (SELECT run, CASE{} END AS wrong FROM {}) WHERE wrong IS NOT NULL LIMIT 1",
                    which, table));
    if (!wrong.step()) continue;
    const auto& [name, type] = columns[static_cast<std::size_t>(wrong.integer(1))];
    SqlStatement value =
        database.prepare(fmt::format("SELECT substr(quote({0}), 1, 40) FROM {1} WHERE run IS ?1 AND ({2}) LIMIT 1",
                                     sql_name(name), table, of_wrong_type(name, type)));
    value.bind_column(1, wrong, 0);
    value.step();
    refuse(database, fmt::format("table \"{}\", run {}, column \"{}\"", table, wrong.text(0), name), value.text(0),
           words_of_type(type));
  }
}

}  // namespace glidelab::validate
