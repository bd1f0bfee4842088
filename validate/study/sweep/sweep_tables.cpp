#include "validate/study/sweep/sweep_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "base/errors.h"
#include "validate/study/sweep/design/sweep_design.h"

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

std::string shorten(const std::string& text) {
  constexpr std::size_t kShownLength = 60;
  if (text.find('\n') != std::string::npos) return "another text";
  return fmt::format("\"{}\"", text.size() > kShownLength ? text.substr(0, kShownLength) + "…" : text);
}

}  // namespace

SweepEntries entries_of(const Sweep& sweep, const std::string& version) {
  SweepEntries entries = {{"format", "2"},
                          {"program version", version},
                          {"sweep", sweep.name},
                          {"sweep file's text", sweep.text},
                          {"scenario's text", sweep.scenario_text},
                          {"seed", fmt::format("{}", sweep.seed)},
                          {"runs", fmt::format("{}", run_count(sweep))}};
  for (std::size_t i = 0; i < sweep.camera_files.size(); ++i) {
    entries.emplace_back(fmt::format("camera file {}", i + 1), sweep.camera_files[i]);
  }
  return entries;
}

SweepEntries sweep_entries(Database& database) {
  SweepEntries entries;
  SqlStatement select = database.prepare("SELECT key, value FROM sweep ORDER BY key");
  while (select.step()) entries.emplace_back(select.text(0), select.text(1));
  return entries;
}

void make_tables(Database& database, const Sweep& sweep, const SweepEntries& entries) {
  database.run(kTables);
  database.run(run_table(sweep));
  SqlStatement column = database.prepare("INSERT INTO \"schema\" VALUES ('run', ?1, ?2, ?3)");
  for (const Axis& axis : sweep.axes) {
    column.bind(1, axis.name).bind(2, axis.choices.empty() ? unit_of_key(axis.keys.front()) : "");
    column.bind(3, fmt::format("varied: {}", fmt::join(axis.keys, ", "))).run();
  }
  SqlStatement entry = database.prepare("INSERT INTO sweep VALUES (?1, ?2)");
  for (const auto& [key, value] : entries) entry.bind(1, key).bind(2, value).run();
}

void check_entries(Database& database, const SweepEntries& expected) {
  SweepEntries found;
  SqlStatement tables = database.prepare("SELECT count(*) FROM sqlite_master WHERE name IN ('sweep', 'run', 'result')");
  tables.step();
  if (tables.integer(0) == 3) found = sweep_entries(database);
  for (const auto& wanted : expected) {
    const auto entry =
        std::find_if(found.begin(), found.end(), [&](const auto& pair) { return pair.first == wanted.first; });
    if (entry != found.end() && entry->second == wanted.second) continue;
    throw base::InputError(base::Issue{
        database.file().string(), 0, wanted.first, entry == found.end() ? "nothing" : shorten(entry->second),
        fmt::format("{}: a database is continued only by the sweep and the program that began it; give another --out",
                    wanted.second.find('\n') == std::string::npos ? shorten(wanted.second) : "that of this sweep")});
  }
}

void check_runs(Database& database, const Sweep& sweep) {
  const std::uint64_t count = run_count(sweep);
  const auto refuse = [&](std::int64_t run, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{database.file().string(), 0, fmt::format("run {}", run), found, expected});
  };
  SqlStatement runs = database.prepare("SELECT run, seed FROM run");
  while (runs.step()) {
    const std::int64_t run = runs.integer(0);
    if (run < 0 || static_cast<std::uint64_t>(run) >= count) {
      refuse(run, "no run of this sweep", fmt::format("the runs 0 to {}", count - 1));
    }
    const std::uint64_t seed = seed_of(sweep, static_cast<std::uint64_t>(run));
    if (static_cast<std::uint64_t>(runs.integer(1)) == seed) continue;
    refuse(run, fmt::format("the seed {}", static_cast<std::uint64_t>(runs.integer(1))),
           fmt::format("{}, which is that of this run", seed));
  }
  for (const char* const table : {"result", "clip", "timing"}) {
    SqlStatement stray =
        database.prepare(fmt::format("SELECT run FROM {} WHERE run NOT IN (SELECT run FROM run) LIMIT 1", table));
    if (stray.step()) refuse(stray.integer(0), fmt::format("rows in {} alone", table), "a row in run as well");
  }
}

}  // namespace glidelab::validate
