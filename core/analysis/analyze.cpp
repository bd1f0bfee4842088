#include "core/analysis/analyze.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>

#include "base/errors.h"
#include "core/analysis/clip_to_track.h"
#include "core/experiment/local_gravity.h"
#include "core/math/parabola.h"
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

// Of a suspected fall.
constexpr std::size_t kFewestFalling = 8;             // positions
constexpr double kLeastFall = 0.5, kMostFall = 1.05;  // acceleration, in g
constexpr double kSlowStart = 0.5;                    // speed at the start, of that at the end
constexpr std::size_t kRunParts = 3;                  // drag makes the acceleration too small beyond the first

/// The mean acceleration of positions that begin slowly; 0 if they do not.
double speeding_up(const std::vector<double>& t_s, const std::vector<double>& x_m) {
  const Parabola parabola = parabola_through(t_s, x_m);
  const double half_change = 0.5 * parabola.a * (t_s.back() - t_s.front());
  return std::abs(parabola.v - half_change) < kSlowStart * std::abs(parabola.v + half_change) ? parabola.a : 0.0;
}

/// Whether the body slows down where it goes on in the same direction, until nearly the farthest position: a cart does
/// that after a push. A fall gains speed, or keeps it, until the body meets the floor.
bool slows_down(const std::vector<double>& t_s, const std::vector<double>& x_m, double direction) {
  constexpr double kFirstPart = 0.25, kLastPart = 0.75, kNearlyAll = 0.9;  // of the way
  constexpr double kSlower = 0.9;                                          // of the speed at first
  if (t_s.size() < kFewestFalling) return false;
  double farthest = 0.0;
  for (const double x : x_m) farthest = std::max(farthest, direction * (x - x_m[0]));
  const auto time_at = [&](double part) {
    std::size_t i = 0;
    while (direction * (x_m[i] - x_m[0]) < part * farthest) ++i;
    return t_s[i] - t_s[0];
  };
  const double early = time_at(kFirstPart), late = time_at(kNearlyAll) - time_at(kLastPart);
  return farthest > 0.0 && (kNearlyAll - kLastPart) * early < kSlower * kFirstPart * late;
}

/// The longest run of positions taken for those in a hand, if the body speeds up there as it falls: in its first third
/// by 0.5 g to 1.05 g, from rest or nearly so. None if the body slows down by a tenth or more as it goes on: so does a
/// cart after a push, and no fall before it meets the floor.
std::optional<MayBeAFall> suspected_fall(const ClipResult& clip) {
  std::vector<double> t_s, x_m, longest_t_s, longest_x_m;
  std::size_t after_longest = 0;
  const auto end_run = [&](std::size_t after) {
    if (t_s.size() > longest_t_s.size()) {
      longest_t_s = t_s;
      longest_x_m = x_m;
      after_longest = after;
    }
    t_s.clear();
    x_m.clear();
  };
  for (std::size_t i = 0; i < clip.motion.size(); ++i) {
    const MotionPoint& point = clip.motion[i];
    if (point.left_out != LeftOut::hand) {
      end_run(i);
    } else if (point.measured_m) {
      t_s.push_back(point.t_s);
      x_m.push_back(*point.measured_m);
    }
  }
  end_run(clip.motion.size());
  const std::size_t positions = longest_t_s.size();
  if (positions < kFewestFalling) return {};
  longest_t_s.resize(std::max(kFewestFalling, positions / kRunParts));
  longest_x_m.resize(longest_t_s.size());
  const double a = speeding_up(longest_t_s, longest_x_m) / kStandardGravity_m_s2;
  if (std::abs(a) < kLeastFall || std::abs(a) > kMostFall) return {};
  t_s.clear();
  x_m.clear();
  for (std::size_t i = after_longest; i < clip.motion.size(); ++i) {
    if (!clip.motion[i].measured_m) continue;
    t_s.push_back(clip.motion[i].t_s);
    x_m.push_back(*clip.motion[i].measured_m);
  }
  if (slows_down(t_s, x_m, std::copysign(1.0, a))) return {};
  return MayBeAFall{positions, std::abs(a) * kStandardGravity_m_s2};
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
