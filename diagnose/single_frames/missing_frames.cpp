#include "diagnose/single_frames/missing_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/long_work.h"
#include "base/math/dense.h"
#include "core/math/quantile.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/single_frames/plain_losses.h"

namespace glidelab::diagnose {
namespace {

constexpr int kMostMissing = 60;       // of those that only the whole fit shows: rounds of one more in each motion
constexpr double kMostOffWhole = 0.5;  // frames
constexpr int kRounds = 8;
constexpr std::size_t kMostMoreInMotion = 4;
constexpr double kMostOff = 50.0;          // log likelihood that one position may cost
constexpr double kMostChi2PerPoint = 2.0;  // chi² a point
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Distance from one point to the next around the step to point f: the median of three steps on each side, so that
/// other nearby jumps do not count.
double usual_step(const std::vector<double>& x_m, std::size_t f) {
  std::vector<double> steps;
  for (std::size_t to = f > 3 ? f - 3 : 1; to < std::min(x_m.size(), f + 4); ++to) {
    if (to != f) steps.push_back(x_m[to] - x_m[to - 1]);
  }
  return core::median_of(steps);
}

/// Best place for one more missing frame in a motion: the gain (for the likeliest number of frames, if that need not be
/// one), and the point from which on all are late.
struct Place {
  double gain = 0.0;
  std::size_t motion = 0, point = 0;
  double step_s = 0.0;
  ScoreColumn column;
};

/// `known`: frames are missing elsewhere for certain, so that one more needs no jump that shows by itself.
Place best_place(const ScoreSpace& space, std::size_t i, bool known, bool one) {
  const TrackedMotion& data = space.set().motions[i];
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  const auto& v = space.fit().motions[i].v_m_s;
  const double step = 1.0 / space.set().clips[data.clip].frame_rate_hz;
  Place best;
  const Eigen::Index margin = known ? 1 : 3;
  for (Eigen::Index from = margin; from + margin <= n - (known ? 0 : 1); ++from) {
    const auto f = static_cast<std::size_t>(from);
    if (std::abs(v[f]) * step < (known ? 1.0 : 5.0) * data.sd_of(f)) continue;  // too slow to tell
    // The neighbours must show the jump themselves.
    // Compared with the six steps around, or, if these differ much, as near a reversal, with the two beside it.
    const auto& late = space.fit().late[i];
    const double moved = data.x_m[f] - data.x_m[f - 1] - v[f] * (late[f] - late[f - 1]);  // without the known losses
    const double after = f + 1 < data.x_m.size() ? data.x_m[f + 1] - data.x_m[f] : data.x_m[f - 1] - data.x_m[f - 2];
    const double before = f < 2 ? after : data.x_m[f - 1] - data.x_m[f - 2];
    double jump = moved - usual_step(data.x_m, f);
    const double beside = moved - 0.5 * (before + after);
    if (std::abs(beside - v[f] * step) < std::abs(jump - v[f] * step)) jump = beside;
    if (std::abs(jump - v[f] * step) > 0.35 * std::abs(v[f] * step) + 5.0 * data.sd_of(f)) continue;
    if (!known && std::abs(jump) < 3.0 * data.sd_of(f)) continue;
    std::vector<Eigen::VectorXd> change(space.set().motions.size());
    change[i] = Eigen::VectorXd::Zero(n);
    for (Eigen::Index p = from; p < n; ++p) change[i][p] = v[static_cast<std::size_t>(p)] * step;
    // K, mu and the inclination absorb most of the effect of a loss near a reversal.
    ScoreColumn c = space.project(change);
    const double score = space.dot(c, space.residual()), square = space.dot(c, c);
    const double gain = one ? score - 0.5 * square : score > 0.0 && square > 0.0 ? 0.5 * score * score / square : 0.0;
    if (gain > best.gain) best = {gain, i, f, step, std::move(c)};
  }
  return best;
}

/// How many frames are lost before each point of a motion, for the fit's path: the likeliest of all sequences that
/// never decrease (Viterbi), with a penalty for each loss.
std::vector<double> likeliest_lateness(const TrackSet& set, const MotionFit& fit, std::size_t i, double loss) {
  const TrackedMotion& data = set.motions[i];
  const TrackModel model = model_of(set, *fit.layout, fit.at, i);
  const double step_s = 1.0 / set.clips[data.clip].frame_rate_hz;
  const std::size_t n = data.t_s.size();
  const auto states = static_cast<std::size_t>(std::lround(fit.late[i].back() / step_s)) + kMostMoreInMotion + 1;
  std::vector<double> best(states, kNever);
  best[0] = 0.0;
  std::vector<std::vector<std::size_t>> came(n, std::vector<std::size_t>(states, 0));
  std::vector<std::vector<double>> seen;  // modelled positions, by delay
  for (std::size_t k = 0; k < states; ++k) {
    const std::vector<double> late(n, static_cast<double>(k) * step_s);
    seen.push_back(move(model, data.t_s, late).x_m);
    const std::vector<double> shared = shared_errors(set, *fit.layout, fit.at, i, seen.back());
    for (std::size_t p = 0; p < n; ++p) seen.back()[p] += shared[p];
  }
  for (std::size_t p = 0; p < n; ++p) {
    std::vector<double> next(states, kNever);
    double least = kNever;  // of best[from] + loss (k - from), for all from up to k
    std::size_t from = 0;
    for (std::size_t k = 0; k < states; ++k) {
      least += loss;
      if (p == 0 || best[k] < least) {  // a loss before the first frame is none
        least = best[k];
        from = k;
      }
      next[k] = least;
      came[p][k] = from;
      const double off = (data.x_m[p] - seen[k][p]) / data.sd_of(p);
      next[k] += data.outlier[p] ? 0.0 : std::min(0.5 * off * off, kMostOff);
    }
    best = std::move(next);
  }
  auto k = static_cast<std::size_t>(std::min_element(best.begin(), best.end()) - best.begin());
  std::vector<double> late(n);
  for (std::size_t p = n; p-- > 0;) {
    late[p] = static_cast<double>(k) * step_s;
    k = came[p][k];
  }
  return late;
}

/// Whether this many losses in all, with their penalties, are likelier than those found.
bool lowers(const MotionFit& next, std::size_t count, const MissingFrames& found) {
  const double more = static_cast<double>(count) - static_cast<double>(found.count);
  return next.cost + 2.0 * kLeastFrameGain * more < found.fit.cost;
}

/// How many frames are lost at each place, all fitted together: the effects of two losses on K, mu and the inclination
/// may hide both.
Eigen::VectorXd sizes_together(const ScoreSpace& space, const std::vector<Place>& places) {
  const auto n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd products(n, n);
  Eigen::VectorXd scores(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const ScoreColumn& column = places[static_cast<std::size_t>(a)].column;
    scores[a] = space.dot(column, space.residual());
    for (Eigen::Index b = 0; b <= a; ++b) {
      products(a, b) = products(b, a) = space.dot(column, places[static_cast<std::size_t>(b)].column);
    }
  }
  return base::solve_positive(products, scores);
}

/// Adds one more loss in each motion if that raises the likelihood: each by itself, or all `together`. Returns false if
/// none does.
bool add_hidden(const TrackSet& set, bool together, int jobs, MissingFrames& found) {
  const ScoreSpace space(set, found.fit);
  std::vector<Place> places(set.motions.size());
  base::for_each_parallel(places.size(), jobs,
                          [&](std::size_t i) { places[i] = best_place(space, i, found.count > 0, !together); });
  std::erase_if(places, [](const Place& place) { return !(place.gain > kLeastFrameGain); });
  if (together && !places.empty()) {
    const Eigen::VectorXd sizes = sizes_together(space, places);
    std::size_t k = 0;
    std::erase_if(places,
                  [&](const Place&) { return std::abs(sizes[static_cast<Eigen::Index>(k++)] - 1.0) > kMostOffWhole; });
  }
  if (places.empty()) return false;
  Lateness tried = found.fit.late;
  for (const Place& place : places) {
    for (std::size_t p = place.point; p < tried[place.motion].size(); ++p) tried[place.motion][p] += place.step_s;
  }
  MotionFit next = fit_motions(set, found.fit.effects, found.fit.at, tried);
  if (!lowers(next, found.count + places.size(), found)) return false;
  found.fit = std::move(next);
  found.count += places.size();
  return true;
}

/// Places all losses anew along the fitted path, as long as that raises the likelihood.
void place_anew(const TrackSet& set, MissingFrames& found) {
  for (int round = 0; round < kRounds; ++round) {
    Lateness tried;
    double count = 0.0;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      tried.push_back(likeliest_lateness(set, found.fit, i, kLeastFrameGain));
      count += tried.back().back() * set.clips[set.motions[i].clip].frame_rate_hz;
    }
    if (tried == found.fit.late) return;
    MotionFit next = fit_motions(set, found.fit.effects, found.fit.at, tried);
    const auto all = static_cast<std::size_t>(std::lround(count));
    if (!lowers(next, all, found)) return;
    found.fit = std::move(next);
    found.count = all;
  }
}

/// The losses, with those that only the whole fit shows.
MissingFrames with_hidden(const TrackSet& set, MissingFrames all, int jobs) {
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = all.count;
    for (int more = 0; more < kMostMissing && add_hidden(set, false, jobs, all); ++more) {
    }
    if (all.count > 0) add_hidden(set, true, jobs, all);
    if (all.count > 0) place_anew(set, all);
    if (all.count == before) break;
  }
  return all;
}

/// Where each one is costs the logarithm of the places; the fraction, evenly over its logarithm from 1e-4 to 0.1.
double penalty_of(std::size_t count, double points) {
  const double share = static_cast<double>(count) / points;
  return -static_cast<double>(count) * std::log(share) + points * share + std::log(7.0);
}

/// What stands of it as an effect, `gain` better than without.
void describe(double gain, double penalty, double points, MissingFrames& found) {
  const auto count = static_cast<double>(found.count);
  found.effect.gain = gain;
  found.effect.log_evidence = gain - penalty;
  found.effect.value = count / points;
  found.effect.sd = std::sqrt(count) / points;
}

}  // namespace

std::size_t missing_in(const TrackSet& set, const MotionFit& fit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < fit.late.size(); ++i) {
    const double rate_hz = set.clips[set.motions[i].clip].frame_rate_hz;
    count += static_cast<std::size_t>(std::lround(fit.late[i].back() * rate_hz));
  }
  return count;
}

MissingFrames find_missing_frames(const TrackSet& set, const MotionFit& fit, int jobs) {
  MissingFrames found;
  found.effect.effect = effect_index(ids::dropped_frames);
  found.fit = fit;
  found.fit.late.clear();
  const auto points = static_cast<double>(points_of(set));
  for (const TrackedMotion& motion : set.motions) found.fit.late.emplace_back(motion.t_s.size(), 0.0);
  // If losses are close together, each search finds some that another misses: the likeliest result counts.
  const LostBefore by_parabolas = plain_losses(set), by_analysis = analysed_losses(set);
  const MissingFrames nothing = found;
  MissingFrames all = nothing;
  const auto try_out = [&](const LostBefore& lost) {
    if (lost.count == 0) return;
    MissingFrames seen = nothing;
    seen.fit = fit_motions(set, fit.effects, fit.at, lost.late);
    seen.count = lost.count;
    if (!lowers(seen.fit, seen.count, nothing)) return;
    MissingFrames more = with_hidden(set, seen, jobs);
    if (lowers(seen.fit, seen.count, found)) found = std::move(seen);
    if (lowers(more.fit, more.count, all)) all = std::move(more);
  };
  try_out(by_parabolas);
  if (by_analysis.late != by_parabolas.late) try_out(by_analysis);
  if (found.count == 0) all = with_hidden(set, nothing, jobs);
  // Losses that no single jump shows count only if nothing remains: many curves look like a series of losses.
  if (all.fit.cost < kMostChi2PerPoint * points) found = std::move(all);
  if (found.count == 0) return found;
  describe(0.5 * (fit.cost - found.fit.cost), penalty_of(found.count, points), points, found);
  return found;
}

MissingFrames find_more_missing_frames(const TrackSet& set, const MotionFit& with_losses) {
  MissingFrames known;
  known.effect.effect = effect_index(ids::dropped_frames);
  known.fit = with_losses;
  known.count = missing_in(set, with_losses);
  const auto points = static_cast<double>(points_of(set));
  MissingFrames all = with_hidden(set, known, 1);
  if (!lowers(all.fit, all.count, known) || all.fit.cost >= kMostChi2PerPoint * points) all = known;
  describe(0.5 * (with_losses.cost - all.fit.cost), penalty_of(all.count, points) - penalty_of(known.count, points),
           points, all);
  return all;
}

}  // namespace glidelab::diagnose
