#include "diagnose/tracks/tracked_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/experiment/clip_setup.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostPositions = 30000;  // of all motions
constexpr double kFasterThanStokes_m_s = 0.5, kFaster_sd = 3.0;
constexpr double kFree_rad = 88.0 * std::numbers::pi / 180.0;  // below it something guides the body
constexpr double kNearlyAsCertain = 2.0;                       // relative error of sin(alpha) over that of g

}  // namespace

bool is_fall(const TrackGroup& group) {
  return core::is_fall(group.stated_rad);
}

std::size_t points_of(const TrackSet& set) {
  std::size_t points = 0;
  for (const TrackedMotion& motion : set.motions) points += motion.t_s.size();
  return points;
}

double lightest_kg(const TrackSet& set) {
  double lightest = std::numeric_limits<double>::infinity();
  for (const TrackedMass& mass : set.masses) lightest = std::min(lightest, mass.mass_kg);
  return lightest;
}

bool only_falls(const TrackSet& set) {
  return !set.groups.empty() && std::all_of(set.groups.begin(), set.groups.end(), is_fall);
}

bool falls_through_air(const TrackSet& set) {
  const bool free = std::all_of(set.groups.begin(), set.groups.end(),
                                [](const TrackGroup& group) { return std::abs(group.stated_rad) >= kFree_rad; });
  if (!only_falls(set) || !free || is_driven(set)) return false;
  return std::any_of(set.motions.begin(), set.motions.end(), [](const TrackedMotion& motion) {
    const std::size_t last = motion.t_s.size() - 1, quarter = std::max<std::size_t>(2, last / 4);
    const auto is_fast = [&](std::size_t from, std::size_t to) {
      const double noise_m = std::hypot(motion.sd_of(from), motion.sd_of(to));
      const double displacement_m = std::abs(motion.x_m[to] - motion.x_m[from]) - kFaster_sd * noise_m;
      return !motion.outlier[from] && !motion.outlier[to] &&
             displacement_m > kFasterThanStokes_m_s * (motion.t_s[to] - motion.t_s[from]);
    };
    for (std::size_t points = quarter; points <= last; points += quarter) {
      for (std::size_t from = 0; from + points <= last; ++from) {
        if (is_fast(from, from + points)) return true;
      }
    }
    return false;
  });
}

bool gravity_matters(const TrackSet& set) {
  if (!(set.gravity_sd_m_s2 > 0.0)) return false;
  const double part = kNearlyAsCertain * set.gravity_sd_m_s2 / set.gravity_m_s2;
  return std::any_of(set.groups.begin(), set.groups.end(), [part](const TrackGroup& group) {
    return is_fall(group) || std::any_of(group.statements.begin(), group.statements.end(), [part](const auto& stated) {
             return stated.sd_rad < part * std::abs(std::tan(stated.alpha_rad));
           });
  });
}

bool is_driven(const TrackSet& set) {
  return std::any_of(set.motions.begin(), set.motions.end(),
                     [](const TrackedMotion& motion) { return !motion.known.t_s.empty(); });
}

TrackedMotion some_points(const TrackedMotion& motion, std::size_t from, std::size_t to, std::size_t every) {
  TrackedMotion part = motion;
  part.whitening.clear();
  part.remainder = {};
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
  pick(part.coarser);
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

namespace {

constexpr double kLeastReturn_sd = 20.0;  // standard deviations of the noise,
constexpr double kPartOfRange = 0.02;     // or fraction of the whole distance, by which a motion comes back at a turn
constexpr std::size_t kMostTurns = 4;     // of a motion that is not cut
constexpr std::size_t kTurns = 2;         // of a piece
constexpr std::size_t kMostPieces = 40;
constexpr std::size_t kMostPoints = 8000;

/// Where to cut: half way between every second turn and the next.
std::vector<std::size_t> cuts_of(const TrackedMotion& motion) {
  const std::vector<std::size_t> turns = turns_of(motion);
  std::vector<std::size_t> cuts;
  if (turns.size() <= kMostTurns) return cuts;
  for (std::size_t k = kTurns; k < turns.size(); k += kTurns) {
    const double middle = 0.5 * (motion.x_m[turns[k - 1]] + motion.x_m[turns[k]]);
    const bool rises = motion.x_m[turns[k]] > motion.x_m[turns[k - 1]];
    std::size_t cut = turns[k - 1];
    while (cut < turns[k] && (motion.x_m[cut] < middle) == rises) ++cut;
    cuts.push_back(cut);
  }
  return cuts;
}

/// The force's samples that a piece needs: those around its times.
KnownForce force_between(const KnownForce& known, double from_s, double to_s) {
  const auto after = std::upper_bound(known.t_s.begin(), known.t_s.end(), from_s);
  const long first = std::max(0L, (after - known.t_s.begin()) - 1);
  const auto behind = std::lower_bound(known.t_s.begin(), known.t_s.end(), to_s);
  const long last = std::min(std::ssize(known.t_s), (behind - known.t_s.begin()) + 1);
  return {{known.t_s.begin() + first, known.t_s.begin() + last},
          {known.force_n.begin() + first, known.force_n.begin() + last}};
}

std::vector<TrackedMotion> pieces_of(const TrackedMotion& motion, std::size_t fewest) {
  std::vector<std::size_t> ends = cuts_of(motion);
  ends.push_back(motion.t_s.size());
  std::vector<TrackedMotion> pieces;
  std::size_t from = 0;
  for (const std::size_t to : ends) {
    TrackedMotion piece = some_points(motion, from, to);
    from = to;
    if (piece.t_s.size() < fewest) continue;
    piece.known = force_between(motion.known, piece.t_s.front(), piece.t_s.back());
    piece.start_s = piece.t_s.front();
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Makes every motion a clip of its own.
void name_pieces(TrackSet& set) {
  const TrackedClip whole = set.clips.front();
  set.pieces = true;
  set.clips.clear();
  for (TrackedMotion& motion : set.motions) {
    motion.clip = set.clips.size();
    TrackedClip clip = whole;
    clip.name = fmt::format("{}, {:.2f} to {:.2f} s", whole.name, motion.t_s.front(), motion.t_s.back());
    clip.duration_s = motion.t_s.back() - motion.t_s.front();
    clip.frames = motion.t_s.size();
    set.clips.push_back(std::move(clip));
  }
}

}  // namespace

std::vector<std::size_t> turns_of(const TrackedMotion& motion) {
  const auto [low, high] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
  const double back = std::max(kLeastReturn_sd * motion.sd_m, kPartOfRange * (*high - *low));
  std::vector<std::size_t> turns;
  std::size_t lowest = 0, highest = 0;  // since the last turn
  int direction = 0;
  for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
    if (motion.outlier[p]) continue;
    if (motion.x_m[p] < motion.x_m[lowest]) lowest = p;
    if (motion.x_m[p] > motion.x_m[highest]) highest = p;
    const bool falls = direction >= 0 && motion.x_m[highest] - motion.x_m[p] > back;
    const bool rises = direction <= 0 && motion.x_m[p] - motion.x_m[lowest] > back;
    if (!falls && !rises) continue;
    if (direction != 0) turns.push_back(falls ? highest : lowest);
    direction = falls ? -1 : 1;
    lowest = highest = p;
  }
  return turns;
}

void cut_driven_motions(TrackSet& set, std::size_t fewest) {
  std::vector<TrackedMotion> driven, others;
  std::size_t many = 0, turns = 0;
  for (TrackedMotion& motion : set.motions) {
    if (motion.known.t_s.empty()) {
      others.push_back(std::move(motion));
      continue;
    }
    std::vector<TrackedMotion> pieces = pieces_of(motion, fewest);
    if (pieces.size() > 1) {
      ++many;
      turns += turns_of(motion).size();
    }
    for (TrackedMotion& piece : pieces) driven.push_back(std::move(piece));
  }
  const std::size_t all = driven.size(), kept = std::min(all, kMostPieces);
  std::size_t points = 0, every = 1;
  std::vector<TrackedMotion> chosen;
  for (std::size_t k = 0; k < all; ++k) {
    if ((k + 1) * kept / all == k * kept / all) continue;
    points += driven[k].t_s.size();
    chosen.push_back(std::move(driven[k]));
  }
  if (points > kMostPoints) {
    every = (points + kMostPoints - 1) / kMostPoints;
    for (TrackedMotion& piece : chosen) piece = some_points(piece, 0, piece.t_s.size(), every);
    std::erase_if(chosen, [fewest](const TrackedMotion& piece) { return piece.t_s.size() < fewest; });
  }
  if (many > 0) {
    set.notes.emplace_back(CutAtTurns{turns, kTurns});
  }
  if (kept < all) {
    set.notes.emplace_back(SomePieces{all, kept});
  }
  if (every > 1) {
    set.notes.emplace_back(ThinnedPositions{points, every, true});
  }
  set.motions = std::move(chosen);
  for (TrackedMotion& motion : others) set.motions.push_back(std::move(motion));
  if (set.clips.size() == 1 && many > 0 && set.motions.size() > 1) {
    name_pieces(set);
    set.notes.emplace_back(PiecesHeldOut{});
  }
}

}  // namespace glidelab::diagnose
