/// The tables of sweep.sqlite: how they are made, and whether those of a file are unchanged.
///
/// A file may come from elsewhere, or be damaged. SQLite would run its triggers and views, and reads any value from any
/// column; here a file is accepted only if it contains no code, its tables were made by the same statements as those of
/// a sweep, SQLite's own check finds its pages in order, and each value has its column's type.
#pragma once

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sqlite.h"

namespace glidelab::validate {

/// All tables and their descriptions (the table `schema`), in an empty database.
void make_tables(Database& database, const Sweep& sweep);

/// InputError, which names it, if the database has a trigger, a view or an index: before anything else is read, because
/// these can run arbitrary code.
void refuse_code(Database& database);

/// Whether it has the tables of a sweep. InputError if the table that identifies the sweep was changed.
bool has_entries(Database& database);

/// InputError, which names table and column, if a table is missing or differs from this sweep's, or if SQLite finds the
/// file damaged (PRAGMA quick_check, which reads all of it).
void check_tables(Database& database, const Sweep& sweep);

/// InputError, which names table, run and column, if a value is not of the type of its column, or infinite.
void check_values(Database& database);

}  // namespace glidelab::validate
