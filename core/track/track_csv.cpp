#include "core/track/track_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string_view>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "base/text/csv.h"
#include "core/math/quantile.h"
#include "core/track/track_import.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kMostTimeIssues = 10;  // unsorted times are wrong on many lines

void check_times(const base::CsvTable& table, const std::vector<double>& t_s) {
  std::vector<base::Issue> issues;
  for (std::size_t i = 1; i < t_s.size() && issues.size() < kMostTimeIssues; ++i) {
    if (t_s[i] > t_s[i - 1]) continue;
    issues.push_back({table.file, table.line[i], "column \"t_s\"",
                      fmt::format("{}{}", t_s[i], t_s[i] == t_s[i - 1] ? " twice" : ""),
                      fmt::format("a time above {} (line {})", t_s[i - 1], table.line[i - 1])});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (t_s.size() < kFewestTrackPoints) {
    throw base::InputError(base::Issue{table.file, 0, "", fmt::format("{} points", t_s.size()),
                                       fmt::format("at least {}", kFewestTrackPoints)});
  }
}

bool has_field(std::string_view line, std::string_view name) {
  while (!line.empty()) {
    const auto end = line.find_first_of(",;\t");
    std::string_view field = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    constexpr std::string_view kAround = " \r\"";
    field.remove_prefix(std::min(field.find_first_not_of(kAround), field.size()));
    field = field.substr(0, field.find_last_not_of(kAround) + 1);
    if (field == name) return true;
  }
  return false;
}

/// The first line that is neither empty nor a comment has a field `t_s`.
bool has_own_header(const std::filesystem::path& file) {
  const std::string text = base::read_file(file);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const auto newline = rest.find('\n');
    const std::string_view line = rest.substr(0, newline);
    rest.remove_prefix(newline == std::string_view::npos ? rest.size() : newline + 1);
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    return has_field(line, "t_s");
  }
  return true;  // an empty file: its error is the plain one
}

}  // namespace

TrackData read_track_csv(const std::filesystem::path& file, int downhill, const std::string& column) {
  assert(downhill == 1 || downhill == -1);
  if (!column.empty() || !has_own_header(file)) return import_track(file, column, downhill);
  const base::CsvTable table = base::read_csv(file, {"t_s", "x_m"}, {"force_n"});
  TrackData track;
  track.t_s = table.column("t_s");
  check_times(table, track.t_s);
  track.x_m = table.column("x_m");
  for (double& x : track.x_m) x *= downhill;
  if (table.has("force_n")) {
    track.force_n = table.column("force_n");
    for (double& force : track.force_n) force *= downhill;
  }
  take_rows_as_frames(track);
  return track;
}

}  // namespace glidelab::core
