#include "diagnose/causes/scatter_structure.h"

#include <algorithm>
#include <map>
#include <vector>

#include "diagnose/causes/spread_prior.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestSizes = 3;

/// The sizes of clip_scatter in a fit: which clip, and which of its two parameters.
struct ClipSizes {
  std::vector<Eigen::Index> global;
  std::vector<std::size_t> clip, kind;
};

ClipSizes clip_sizes(const MotionFit& fit) {
  ClipSizes sizes;
  const std::size_t scatter = effect_index(ids::clip_scatter);
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter == nullptr || globals[g].effect != scatter) continue;
    sizes.global.push_back(static_cast<Eigen::Index>(g));
    sizes.clip.push_back(globals[g].index);
    sizes.kind.push_back(globals[g].parameter->slot.parameter);
  }
  return sizes;
}

std::map<std::size_t, Configuration> configuration_of_clips(const TrackSet& set) {
  std::map<std::size_t, Configuration> of;
  for (const TrackedMotion& motion : set.motions) of[motion.clip] = {motion.group, motion.mass};
  return of;
}

}  // namespace

std::optional<double> gain_of_structure(const TrackSet& set, const MotionFit& clips, const RemainderSizes& sizes,
                                        std::size_t effect) {
  constexpr std::size_t kFriction = 0, kDrag = 1;  // of clip_scatter's parameters
  const AmongClips& among = effect_list()[effect].among_clips;
  if (among.of == AmongClips::Of::nothing) return {};
  const ClipSizes of = clip_sizes(clips);
  SharedPart shared{among.of == AmongClips::Of::drag ? kDrag : kFriction, {}};
  const auto many = static_cast<Eigen::Index>(of.global.size());
  if (static_cast<std::size_t>(std::count(of.kind.begin(), of.kind.end(), shared.kind)) < kFewestSizes) return {};
  double mean = 0.0, count = 0.0;
  for (std::size_t i = 0; i < of.clip.size(); ++i) {
    if (of.kind[i] != shared.kind) continue;
    mean += static_cast<double>(of.clip[i]);
    count += 1.0;
  }
  mean /= count;
  const std::map<std::size_t, Configuration> configuration = configuration_of_clips(set);
  shared.shape = Eigen::MatrixXd::Zero(many, many);
  for (std::size_t i = 0; i < of.clip.size(); ++i) {
    for (std::size_t j = 0; j < of.clip.size(); ++j) {
      if (of.kind[i] != shared.kind || of.kind[j] != shared.kind) continue;
      const double along = (static_cast<double>(of.clip[i]) - mean) * (static_cast<double>(of.clip[j]) - mean);
      const double same = configuration.at(of.clip[i]) == configuration.at(of.clip[j]) ? 1.0 : 0.0;
      shared.shape(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = among.steadily ? along : same;
    }
  }
  if (among.steadily) shared.shape *= count / shared.shape.trace();  // the width is that of one clip's size
  const RemainderSpace::Solution solution = RemainderSpace(set, clips).solve(sizes);
  const Eigen::VectorXd at = (clips.at.global + solution.change)(of.global);
  const Eigen::MatrixXd covariance = solution.covariance(of.global, of.global);
  return log_spread_prior(at, covariance, of.kind, &shared) - log_spread_prior(at, covariance, of.kind);
}

bool follows_structure(const TrackSet& set, const MotionFit& clips) {
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (gain_of_structure(set, clips, {}, e).value_or(0.0) > 0.0) return true;
  }
  return false;
}

}  // namespace glidelab::diagnose
