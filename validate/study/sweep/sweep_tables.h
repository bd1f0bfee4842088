/// The tables of sweep.sqlite (sweep_database.h): how they are made, and how to tell whether a file holds those of a
/// sweep.
///
/// A file is one of a sweep where each entry of its table `sweep` is the sweep's: texts, seed, number of runs and the
/// program's version. A row is one where its run has that number and that seed in the sweep's design.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sqlite.h"

namespace glidelab::validate {

/// Name and value of each entry of the table `sweep`.
using SweepEntries = std::vector<std::pair<std::string, std::string>>;

/// What a sweep's file says of it, whichever of its runs the file is for.
SweepEntries entries_of(const Sweep& sweep, const std::string& version);

/// The sweep that a database is of, for who has only the database.
SweepEntries sweep_entries(Database& database);

/// All tables, their schema and the sweep's entries, in an empty database.
void make_tables(Database& database, const Sweep& sweep, const SweepEntries& entries);

/// InputError if the database is not one of these entries; it says which one differs.
void check_entries(Database& database, const SweepEntries& expected);

/// InputError if a row is of no run of the sweep, or of one that has another seed there.
void check_runs(Database& database, const Sweep& sweep);

}  // namespace glidelab::validate
