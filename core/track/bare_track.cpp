#include "core/track/bare_track.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/experiment/clip_setup.h"
#include "core/track/column_table.h"
#include "core/track/tracker_project.h"

namespace glidelab::core {

bool is_bare_track(const std::filesystem::path& path) {
  std::error_code ignored;  // a path that cannot be read is not a track
  return std::filesystem::is_regular_file(path, ignored) && path.filename() != "experiment.toml";
}

std::vector<TrackRun> runs_in(const std::filesystem::path& file) {
  std::vector<TrackRun> runs;
  if (looks_like_tracker_project(file)) {
    for (const std::string& mass : point_masses_of(file)) runs.push_back({mass, mass});
    return runs;
  }
  const ColumnTable table = read_column_table(file);
  // Heights if there is nothing else, as for falls.
  const bool places = std::any_of(table.columns.begin(), table.columns.end(), is_place_column);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const TableColumn& column = table.columns[c];
    if (!(places ? is_place_column(column) : is_height_column(column))) continue;
    runs.push_back({std::to_string(c + 1), column.run.empty() ? column.text : column.run});
  }
  return runs;
}

namespace {

/// "1: Run #1, 2: Run #2".
std::string runs_text(const std::vector<TrackRun>& runs) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) names.push_back(fmt::format("{}: {}", i + 1, runs[i].label));
  return names.empty() ? "no column called x or position" : fmt::format("{}", fmt::join(names, ", "));
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

/// `one` holds what all clips take from the file.
std::vector<ClipSetup> clips_of_runs(const std::filesystem::path& file, const ClipSetup& one,
                                     const TrackFileOptions& options) {
  const std::vector<TrackRun> runs = chosen_runs(file, options.runs);
  if (!options.masses_kg.empty() && options.masses_kg.size() != runs.size()) {
    throw base::InputError(base::Issue{file.string(), 0, "--masses",
                                       fmt::format("{} of them", options.masses_kg.size()),
                                       fmt::format("one for each of the {} runs: {}", runs.size(), runs_text(runs))});
  }
  std::vector<ClipSetup> clips;
  std::set<std::string> names;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    ClipSetup clip = one;
    clip.name = names.insert(runs[i].label).second ? runs[i].label : fmt::format("{} ({})", runs[i].label, i + 1);
    clip.column = runs[i].column;
    if (!options.masses_kg.empty()) clip.mass_kg = options.masses_kg[i];
    clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace

TrackFileOptions masses_of_files(TrackFileOptions options, const std::vector<std::filesystem::path>& files) {
  if (options.masses_kg.empty() || !options.runs.empty()) return options;
  if (options.masses_kg.size() != files.size()) {
    throw base::InputError(
        base::Issue{"", 0, "--masses", fmt::format("{} of them", options.masses_kg.size()),
                    fmt::format("one for each of the {} file{}, or with --runs one for each run of a file",
                                files.size(), files.size() == 1 ? "" : "s")});
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto [at, is_new] = options.mass_of_file.emplace(files[i], options.masses_kg[i]);
    if (!is_new && at->second != options.masses_kg[i]) {
      throw base::InputError(base::Issue{files[i].string(), 0, "--masses", "two masses of one file", "one of each"});
    }
  }
  options.masses_kg.clear();
  return options;
}

Experiment read_tracks(const std::filesystem::path& path, const TrackFileOptions& options) {
  const bool speeds = options.speeds == SpeedsAlone::taken;
  if (!is_bare_track(path)) {
    Experiment folder = read_experiment(path, options.permitted);
    for (ClipSetup& clip : folder.clips) clip.speeds_alone = speeds;
    return folder;
  }
  Experiment experiment;
  experiment.folder = path.parent_path();
  experiment.file = path;
  experiment.name = path.stem().string();
  const Gravity gravity = stated_gravity(options.gravity_m_s2, options.gravity_sd_m_s2);
  experiment.gravity_m_s2 = gravity.m_s2;
  experiment.gravity_sd_m_s2 = gravity.sd_m_s2;
  ClipSetup clip;
  clip.name = experiment.name;
  clip.track = path;
  clip.speeds_alone = speeds;
  clip.column = options.column;
  clip.recorded_by = options.recorded_by;
  clip.image_units = {options.frame_rate_hz, options.px_per_m, 0.0, true};
  const auto own_mass = options.mass_of_file.find(path);
  const bool has_own_mass = own_mass != options.mass_of_file.end();
  clip.mass_kg = has_own_mass ? own_mass->second : options.mass_kg.value_or(1.0);
  clip.mass_assumed = !has_own_mass && !options.mass_kg && options.masses_kg.empty();
  clip.incline_rad = options.incline_deg.value_or(0.0) * base::kRadPerDegree;
  clip.incline_assumed = !options.incline_deg;
  if (options.incline_sd_deg) clip.incline_sd_rad = *options.incline_sd_deg * base::kRadPerDegree;
  clip.launched = Launched::unknown;
  clip.group = "all";
  if (options.runs.empty()) {
    experiment.clips.push_back(std::move(clip));
  } else {
    experiment.clips = clips_of_runs(path, clip, options);
  }
  return experiment;
}

TrackData read_track(const std::filesystem::path& file, std::optional<Downhill> downhill, const std::string& column,
                     SpeedsAlone speeds, const ImageUnits& units) {
  if (looks_like_tracker_project(file)) {
    refuse_unneeded(units, file.string(), "a Tracker project, with times and a scale of its own");
    return read_tracker_project(file, downhill, column);
  }
  if (downhill && is_along_y(*downhill)) {
    throw base::InputError(base::Issue{file.string(), 0, "downhill",
                                       fmt::format("\"{}\" for a table of positions", name_of(*downhill)),
                                       "\"+X\" or \"-X\": x is the column that `column` names, whatever it is called"});
  }
  return read_track_csv(file, downhill ? std::optional(sign_of(*downhill)) : std::nullopt, column, speeds, units);
}

}  // namespace glidelab::core
