#include "report/text/outside_text.h"

#include <fmt/format.h>

#include <string_view>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

/// Calls `use` with each kind of failure that occurred.
template <typename Use>
void for_failures(const fit::OutsideTally& tally, const Use& use) {
  for (std::size_t i = 0; i < fit::kOutsideFailures.size(); ++i) {
    if (tally.failures[i].count > 0) use(fit::kOutsideFailures[i], tally.failures[i]);
  }
}

/// Of so many runs: "3 ended with an exit status other than 0".
std::string failure_words(fit::OutsideFailure failure, std::size_t runs) {
  const char* const was = runs == 1 ? "was" : "were";
  switch (failure) {
    case fit::OutsideFailure::exit_status:
      return fmt::format("{} ended with an exit status other than 0", runs);
    case fit::OutsideFailure::raised:
      return fmt::format("{} raised an exception", runs);
    case fit::OutsideFailure::signal:
      return fmt::format("{} {} ended by a signal", runs, was);
    case fit::OutsideFailure::time_out:
      return fmt::format("{} {} not done in time", runs, was);
    case fit::OutsideFailure::no_output:
      return fmt::format("{} left no results.json in {{out}}", runs);
    case fit::OutsideFailure::bad_output:
      return fmt::format("{} left an invalid results.json", runs);
    case fit::OutsideFailure::none:
      break;
  }
  return fmt::format("{} {} done", runs, was);
}

/// "2 ended with an exit status other than 0, the first: exit status 1: skipped: no pynumdiff; 1 was not done in time,
/// …".
std::string kinds_text(const fit::OutsideTally& tally) {
  std::string kinds;
  for_failures(tally, [&](fit::OutsideFailure failure, const fit::OutsideTally::Kind& kind) {
    kinds += (kinds.empty() ? "" : "; ") + failure_words(failure, kind.count);
    if (failure != fit::OutsideFailure::no_output)
      kinds += fmt::format(", the first: {}", base::printable_text(kind.first));
  });
  return kinds;
}

}  // namespace

Json outside_json(const fit::OutsideTally& tally) {
  Json object;
  object["name"] = tally.name;
  object["command"] = tally.command;
  object["runs"] = tally.runs;
  object["failed"] = tally.failed();
  object["failures"] = Json::object();
  for_failures(tally, [&](fit::OutsideFailure failure, const fit::OutsideTally::Kind& kind) {
    object["failures"][std::string(fit::key_of(failure))] = {{"count", kind.count}, {"first", kind.first}};
  });
  if (tally.longest_s > 0.0) {
    put(object, "mean_s", tally.seconds);
    put(object, "longest_s", tally.longest_s);
  }
  return object;
}

std::string outside_text(const fit::OutsideTally& tally) {
  const std::string failed = tally.failed() == 0
                                 ? fmt::format("{} {}, none failed", tally.runs, tally.runs == 1 ? "run" : "runs")
                                 : fmt::format("{} of {} {} failed ({})", tally.failed(), tally.runs,
                                               tally.runs == 1 ? "run" : "runs", kinds_text(tally));
  const std::string times = tally.longest_s > 0.0
                                ? fmt::format("; {} s a run, {} s at most", base::number_text(tally.seconds, 2),
                                              base::number_text(tally.longest_s, 2))
                                : std::string();
  return fmt::format("{}: {}{}", base::printable_text(tally.name), failed, times);
}

std::string outside_failed(const fit::OutsideTally& tally) {
  if (tally.failed() == 0) return {};
  return fmt::format("“{}” failed in {} of {} {}: {}.", base::printable_text(tally.name), tally.failed(), tally.runs,
                     tally.runs == 1 ? "run" : "runs", kinds_text(tally));
}

}  // namespace glidelab::report
