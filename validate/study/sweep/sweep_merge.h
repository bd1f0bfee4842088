/// Sweep databases of several processes put together into one.
///
/// All runs of all files, or none: one transaction. A run that several files have counts once where all its rows but
/// its time are the same to the last bit; what differs is refused, so that the result does not depend on the files'
/// order.
#pragma once

#include <filesystem>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sqlite.h"
#include "validate/study/sweep/sweep_tables.h"

namespace glidelab::validate {

/// Takes over all runs of the other files into a database of the sweep. `expected`: the entries that each of them must
/// have. InputError for a file that is not there, is damaged, is another sweep's, has rows of a run that the sweep has
/// not or that is not in it with its seed, or has other rows of a run than another file, which is named.
void take_over(Database& into, const Sweep& sweep, const SweepEntries& expected,
               const std::vector<std::filesystem::path>& others);

}  // namespace glidelab::validate
