#include "fit/outside/outside_tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glidelab::fit {

std::string_view key_of(OutsideFailure failure) {
  switch (failure) {
    case OutsideFailure::exit_status:
      return "exit_status";
    case OutsideFailure::raised:
      return "raised";
    case OutsideFailure::signal:
      return "signal";
    case OutsideFailure::time_out:
      return "time_out";
    case OutsideFailure::no_output:
      return "no_output";
    case OutsideFailure::bad_output:
      return "bad_output";
    case OutsideFailure::none:
      break;
  }
  return "none";
}

std::string why_begins(OutsideFailure failure) {
  return fmt::format("the estimator failed ({})", key_of(failure));
}

std::string why_of(const OutsideRun& failed) {
  return fmt::format("{}: {}", why_begins(failed.failure), failed.what);
}

std::size_t OutsideTally::failed() const {
  std::size_t sum = 0;
  for (const Kind& kind : failures) sum += kind.count;
  return sum;
}

OutsideTally tally_of(std::string name, std::string command, const std::vector<OutsideRun>& runs) {
  OutsideTally tally;
  tally.name = std::move(name);
  tally.command = std::move(command);
  tally.runs = runs.size();
  for (const OutsideRun& run : runs) {
    tally.seconds += run.seconds / static_cast<double>(runs.size());
    tally.longest_s = std::max(tally.longest_s, run.seconds);
    for (std::size_t kind = 0; kind < kOutsideFailures.size(); ++kind) {
      if (run.failure != kOutsideFailures[kind]) continue;
      if (tally.failures[kind].count++ == 0) tally.failures[kind].first = run.what;
    }
  }
  return tally;
}

}  // namespace glidelab::fit
