/// How the runs of an outside estimator went (fit/outside/outside_tally.h), in words and as JSON.
#pragma once

#include <string>

#include "fit/outside/outside_tally.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// {"name", "command", "runs", "failed", "failures": {"exit_status": {"count", "first"}, …}, "mean_s", "longest_s"};
/// it contains only kinds of failure that occurred, and times only if they were recorded.
Json outside_json(const fit::OutsideTally& tally);

/// "mine: 2 of 50 runs failed (2 were not done in time, the first: …); 0.12 s a run, 1.3 s at most"; printable, no
/// newline.
std::string outside_text(const fit::OutsideTally& tally);

/// "“mine” failed in 2 of 50 runs: 2 were not done in time.", to begin an answer with; empty if none failed.
std::string outside_failed(const fit::OutsideTally& tally);

}  // namespace glidelab::report
