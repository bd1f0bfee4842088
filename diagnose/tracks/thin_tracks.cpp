#include "diagnose/tracks/thin_tracks.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostPositions = 30000;  // of all motions

}  // namespace

TrackedMotion some_points(const TrackedMotion& motion, std::size_t from, std::size_t to, std::size_t every) {
  TrackedMotion part = motion;
  part.whitening.clear();
  const auto pick = [&](auto& values) {
    if (values.empty()) return;
    std::size_t kept = 0;
    for (std::size_t i = from; i < to; i += every) values[kept++] = values[i];
    values.resize(kept);
  };
  pick(part.t_s);
  pick(part.x_m);
  pick(part.outlier);
  pick(part.wider);
  pick(part.row_px);
  pick(part.along_px);
  for (auto& mode : part.shared_m) pick(mode);
  return part;
}

void thin_out(TrackSet& set, std::size_t fewest) {
  const auto driven = [](const TrackedMotion& motion) { return !motion.known.t_s.empty(); };
  std::size_t points = 0;
  for (const TrackedMotion& motion : set.motions) points += driven(motion) ? 0 : motion.t_s.size();
  if (points <= kMostPositions) return;
  const std::size_t every = (points + kMostPositions - 1) / kMostPositions;
  for (TrackedMotion& motion : set.motions) {
    if (!driven(motion)) motion = some_points(motion, 0, motion.t_s.size(), every);
  }
  std::erase_if(set.motions, [fewest](const TrackedMotion& motion) { return motion.t_s.size() < fewest; });
  set.notes.emplace_back(ThinnedPositions{points, every, false});
}

}  // namespace glidelab::diagnose
