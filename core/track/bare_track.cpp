#include "core/track/bare_track.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/track/column_table.h"
#include "core/track/track_data.h"

namespace glidelab::core {

std::vector<TrackRun> runs_in(const std::filesystem::path& file) {
  const ColumnTable table = read_column_table(file);
  std::vector<TrackRun> runs;
  for (const std::size_t c : place_columns(table)) {
    const TableColumn& column = table.columns[c];
    runs.push_back({c + 1, column.run.empty() ? column.text : column.run});
  }
  return runs;
}

namespace {

/// "1: Run #1, 2: Run #2".
std::string runs_text(const std::vector<TrackRun>& runs) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) names.push_back(fmt::format("{}: {}", i + 1, runs[i].label));
  return names.empty() ? "no column that is called x or position" : fmt::format("{}", fmt::join(names, ", "));
}

base::InputError wrong_runs(const std::filesystem::path& file, const std::string& found,
                            const std::vector<TrackRun>& runs) {
  return base::InputError(base::Issue{file.string(), 0, "--runs", found, "all, or numbers of: " + runs_text(runs)});
}

std::vector<TrackRun> chosen_runs(const std::filesystem::path& file, const std::string& text) {
  const std::vector<TrackRun> all = runs_in(file);
  if (all.empty()) throw wrong_runs(file, fmt::format("\"{}\"", text), all);
  if (text == "all") return all;
  std::vector<TrackRun> chosen;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (error != std::errc{} || end != part.data() + part.size() || number < 1 || number > all.size()) {
      throw wrong_runs(file, fmt::format("\"{}\"", part), all);
    }
    chosen.push_back(all[number - 1]);
    if (comma == std::string_view::npos) return chosen;
    rest.remove_prefix(comma + 1);
  }
}

ClipSetup bare_clip(const std::filesystem::path& file, const BareTrackOptions& options) {
  ClipSetup clip;
  clip.name = file.stem().string();
  clip.track = file;
  clip.column = options.column;
  clip.mass_kg = options.mass_kg.value_or(1.0);
  clip.mass_assumed = !options.mass_kg;
  clip.incline_rad = options.incline_deg.value_or(0.0) / base::kDegreesPerRad;
  clip.incline_assumed = !options.incline_deg;
  clip.launched = Launched::unknown;
  clip.group = "all";
  return clip;
}

std::vector<ClipSetup> clips_of_runs(const std::filesystem::path& file, const BareTrackOptions& options) {
  const std::vector<TrackRun> runs = chosen_runs(file, options.runs);
  if (!options.masses_kg.empty() && options.masses_kg.size() != runs.size()) {
    throw base::InputError(base::Issue{file.string(), 0, "--masses", fmt::format("{} of them", options.masses_kg.size()),
                                       fmt::format("one for each of the {} runs: {}", runs.size(), runs_text(runs))});
  }
  std::vector<ClipSetup> clips;
  std::set<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ClipSetup clip = bare_clip(file, options);
    clip.name = names.insert(runs[i].label).second ? runs[i].label : fmt::format("{} ({})", runs[i].label, i + 1);
    clip.column = std::to_string(runs[i].column);
    if (!options.masses_kg.empty()) {
      clip.mass_kg = options.masses_kg[i];
      clip.mass_assumed = false;
    }
    clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace

bool is_bare_track(const std::filesystem::path& path) {
  std::error_code ignored;  // what cannot be looked at is none
  return std::filesystem::is_regular_file(path, ignored) && path.filename() != "experiment.toml";
}

Experiment read_input(const std::filesystem::path& path, const BareTrackOptions& options) {
  if (!is_bare_track(path)) return read_experiment(path, options.outside);
  Experiment experiment;
  experiment.folder = path.parent_path();
  experiment.file = path;
  experiment.name = path.stem().string();
  experiment.clips = options.runs.empty() ? std::vector{bare_clip(path, options)} : clips_of_runs(path, options);
  return experiment;
}

}  // namespace glidelab::core
