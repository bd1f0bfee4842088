#include "core/analyze.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>
#include <thread>

#include "base/errors.h"
#include "core/clip_to_track.h"
#include "core/phase_diagram.h"
#include "core/track_csv.h"

namespace glidelab::core {
namespace {

/// Calls work(0 … count-1) on up to `jobs` threads; the first exception ends it and is thrown on.
template <typename Work>
void parallel_for(std::size_t count, int jobs, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_guard;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {  // handed to the caller's thread below
        const std::lock_guard lock(failure_guard);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> threads;
  const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(jobs, 1)));
  for (std::size_t i = 1; i < wanted; ++i) threads.emplace_back(run);
  run();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

int downhill_of(const Experiment& experiment, const ClipSetup& clip) {
  for (const GroupSetup& group : experiment.groups) {
    if (group.name == clip.group && group.downhill) return *group.downhill;
  }
  return experiment.track.downhill;
}

/// Folders of tracks alone need no pictures.
PictureResults tracks_alone(const Experiment& experiment) {
  PictureResults results;
  for (const ClipSetup& clip : experiment.clips) {
    results.tracks.push_back(read_track_csv(clip.track, downhill_of(experiment, clip)));
  }
  return results;
}

std::vector<Experiment> read_all(const std::vector<std::filesystem::path>& folders) {
  std::vector<Experiment> experiments;
  for (const auto& folder : folders) {
    experiments.push_back(read_experiment(folder));
    const Experiment& read = experiments.back();
    if (read.clips.empty()) {
      throw base::InputError(base::Issue{read.file.string(), 0, "clip", "none", "one or more clips or tracks"});
    }
    if (read.gravity_m_s2 != experiments.front().gravity_m_s2) {
      throw base::InputError(
          base::Issue{read.file.string(), 0, "gravity_m_s2", fmt::format("{}", read.gravity_m_s2),
                      fmt::format("{} as in {}: folders analysed together share the track",
                                  experiments.front().gravity_m_s2, experiments.front().file.string())});
    }
  }
  return experiments;
}

/// Names of clips that occur in one folder only stay; the others get their folder's in front.
void name_uniquely(const std::vector<Experiment>& experiments, std::vector<ClipSetup>& setups) {
  std::multiset<std::string> names;
  for (const ClipSetup& setup : setups) names.insert(setup.name);
  std::set<std::string> taken;
  std::size_t clip = 0;
  for (const Experiment& experiment : experiments) {
    const std::string folder = std::filesystem::absolute(experiment.folder / "x").parent_path().filename().string();
    for (std::size_t i = 0; i < experiment.clips.size(); ++i, ++clip) {
      std::string& name = setups[clip].name;
      if (names.count(name) > 1) name = folder + "-" + name;
      const std::string wanted = name;
      for (int again = 2; !taken.insert(name).second; ++again) name = fmt::format("{}-{}", wanted, again);
    }
  }
}

}  // namespace

AnalysisResults analyze(const std::vector<std::filesystem::path>& folders, const AnalysisOptions& options,
                        const base::Progress& progress) {
  const std::vector<Experiment> experiments = read_all(folders);
  AnalysisResults results;
  std::vector<ClipSetup> setups;
  std::vector<TrackData> tracks;
  std::vector<const Experiment*> experiment_of;
  for (const Experiment& experiment : experiments) {
    const bool pictures = std::any_of(experiment.clips.begin(), experiment.clips.end(),
                                      [](const ClipSetup& clip) { return clip.track.empty(); });
    PictureResults seen = pictures ? tracks_of(experiment, options.jobs, progress) : tracks_alone(experiment);
    for (std::size_t i = 0; i < experiment.clips.size(); ++i) {
      setups.push_back(experiment.clips[i]);
      tracks.push_back(std::move(seen.tracks[i]));
      experiment_of.push_back(&experiment);
    }
    if (seen.calibration) results.calibrations.push_back(std::move(*seen.calibration));
    for (PlumbResult& plumb : seen.plumbs) results.plumbs.push_back(std::move(plumb));
  }
  name_uniquely(experiments, setups);
  results.clips.resize(setups.size());
  std::atomic<std::size_t> done = 0;
  parallel_for(setups.size(), options.jobs, [&](std::size_t i) {
    results.clips[i] = analyze_motion(setups[i], tracks[i], options.bandwidth_s, experiments.front().gravity_m_s2);
    results.clips[i].experiment = experiment_of[i]->name;
    progress("phase diagram", static_cast<double>(++done) / static_cast<double>(setups.size()));
  });
  results.configurations = join_configurations(setups, results.clips, experiments.front().gravity_m_s2);
  return results;
}

}  // namespace glidelab::core
