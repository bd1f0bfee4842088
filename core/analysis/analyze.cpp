#include "core/analysis/analyze.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "core/analysis/clip_to_track.h"
#include "core/analysis/suspected_fall.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/configurations.h"

namespace glidelab::core {
namespace {

std::vector<Experiment> read_all(const std::vector<std::filesystem::path>& folders, const TrackFileOptions& bare) {
  if (folders.empty()) throw base::InputError(base::Issue{"", 0, "", "no folder", "one or more experiment folders"});
  std::vector<Experiment> experiments;
  std::set<std::filesystem::path> seen;
  for (const auto& folder : folders) {
    const auto file = is_bare_track(folder) ? folder : folder / "experiment.toml";
    if (!seen.insert(std::filesystem::weakly_canonical(file)).second) {
      throw base::InputError(base::Issue{folder.string(), 0, "", "the folder a second time", "each folder once"});
    }
    experiments.push_back(read_tracks(folder, bare));
    const Experiment& read = experiments.back();
    require_clips(read);
    if (read.gravity_m_s2 != experiments.front().gravity_m_s2) {
      throw base::InputError(
          base::Issue{read.file.string(), 0, "gravity_m_s2", fmt::format("{}", read.gravity_m_s2),
                      fmt::format("{} as in {}: folders analysed together share the track",
                                  experiments.front().gravity_m_s2, experiments.front().file.string())});
    }
  }
  return experiments;
}

/// All have the same value, and one folder that knows its place is enough.
Gravity gravity_of(const std::vector<Experiment>& experiments) {
  const auto best = std::ranges::min_element(experiments, {}, &Experiment::gravity_sd_m_s2);
  return {best->gravity_m_s2, best->gravity_sd_m_s2};
}

struct NameInFolder {
  std::string name;
  std::filesystem::path folder;
};

/// Names that occur once are kept; the others get their folder's name before them and, where that is not enough, a
/// number behind them, since results are told apart by them.
std::vector<std::string> unique_names(const std::vector<NameInFolder>& given) {
  std::multiset<std::string> names;
  for (const NameInFolder& one : given) names.insert(one.name);
  std::vector<std::string> unique;
  std::set<std::string> taken;
  for (const NameInFolder& one : given) {
    std::string name = one.name;
    if (names.count(name) > 1) {
      name = std::filesystem::absolute(one.folder / "x").parent_path().filename().string() + "-" + name;
    }
    const std::string wanted = name;
    for (int again = 2; !taken.insert(name).second; ++again) name = fmt::format("{}-{}", wanted, again);
    unique.push_back(std::move(name));
  }
  return unique;
}

void note_assumptions(const TrackFileOptions& stated, const std::vector<ClipSetup>& setups,
                      const std::vector<const Experiment*>& experiment_of, AnalysisResults& results) {
  for (ConfigurationResult& configuration : results.configurations) {
    for (std::size_t i = 0; i < setups.size(); ++i) {
      if (setups[i].name != configuration.clips.front() || !is_bare_track(experiment_of[i]->file)) continue;
      AssumedStatements assumed{{}, !stated.incline_deg};
      if (setups[i].mass_assumed) assumed.mass_kg = setups[i].mass_kg;
      for (const Note& note : results.clips[i].notes) {
        const auto* const taken = std::get_if<HeightTaken>(&note);
        if (assumed.level && taken != nullptr) configuration.notes.emplace_back(*taken);  // it may be a fall
      }
      if (assumed.mass_kg || assumed.level) configuration.notes.emplace_back(assumed);
      std::optional<MayBeAFall> longest;
      for (const ClipResult& clip : results.clips) {
        if (std::find(configuration.clips.begin(), configuration.clips.end(), clip.name) == configuration.clips.end()) {
          continue;
        }
        const std::optional<MayBeAFall> fall = suspected_fall(clip);
        if (fall && (!longest || fall->positions > longest->positions)) longest = fall;
      }
      if (longest && assumed.level) configuration.notes.emplace_back(*longest);
      break;
    }
  }
}

}  // namespace

AnalysisResults analyze(const std::vector<std::filesystem::path>& folders, const AnalysisOptions& options,
                        const base::Progress& progress) {
  check_bandwidth(options.bandwidth_s, options.bandwidth_rule);
  const MotionOptions how{options.bandwidth_s, options.bandwidth_rule, options.lines, options.lost_frames,
                          options.smoother};
  check_smoothing(how);
  const std::vector<Experiment> experiments = read_all(folders, options.bare);
  std::vector<NameInFolder> of_experiments, of_clips;
  for (const Experiment& experiment : experiments) of_experiments.push_back({experiment.name, experiment.folder});
  const std::vector<std::string> names = unique_names(of_experiments);
  std::vector<CalibrationResult> calibrations;
  std::vector<PlumbResult> plumbs;
  std::vector<ClipSetup> setups;
  std::vector<TrackData> tracks;
  std::size_t modes = 0;  // of the cameras so far: folders share no modes
  std::vector<const Experiment*> experiment_of;
  std::vector<std::string> name_of;
  std::vector<LeftOutClip> left_out;
  std::optional<MarkerNotFound> first_lost;
  std::size_t place_of_clip = 0;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    const Experiment& experiment = experiments[e];
    ImageResults seen = tracks_of(experiment, options.jobs, progress, options.open, options.images, nullptr,
                                  MarkerSearch::thorough, options.without_marker);
    for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
      if (seen.without_marker[i]) {
        left_out.push_back({experiment.clips[i].name, names[e], seen.without_marker[i]->what(), place_of_clip++, 0});
        if (!first_lost) first_lost = seen.without_marker[i];
        continue;
      }
      ++place_of_clip;
      setups.push_back(experiment.clips[i]);
      of_clips.push_back({experiment.clips[i].name, experiment.folder});
      tracks.push_back(std::move(seen.tracks[i]));
      tracks.back().shared_m.insert(tracks.back().shared_m.begin(), modes, {});
      experiment_of.push_back(&experiment);
      name_of.push_back(names[e]);
    }
    modes += seen.modes;
    if (seen.calibration) {
      seen.calibration->experiment = names[e];
      calibrations.push_back(std::move(*seen.calibration));
    }
    for (PlumbResult& plumb : seen.plumbs) {
      plumb.experiment = names[e];
      plumbs.push_back(std::move(plumb));
    }
  }
  if (setups.empty() && first_lost) throw MarkerNotFound(*first_lost);
  const std::vector<std::string> clips = unique_names(of_clips);
  for (std::size_t i = 0; i < setups.size(); ++i) setups[i].name = clips[i];
  AnalysisResults results = analyze_tracks(setups, tracks, gravity_of(experiments), how, options.jobs, progress);
  for (std::size_t i = 0; i < setups.size(); ++i) results.clips[i].experiment = name_of[i];
  results.calibrations = std::move(calibrations);
  results.plumbs = std::move(plumbs);
  for (LeftOutClip& clip : left_out) clip.of = place_of_clip;
  results.left_out = std::move(left_out);
  note_assumptions(options.bare, setups, experiment_of, results);
  return results;
}

}  // namespace glidelab::core
