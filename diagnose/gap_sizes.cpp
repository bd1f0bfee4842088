#include "diagnose/gap_sizes.h"

#include <algorithm>
#include <cmath>

#include "diagnose/clip_interval.h"
#include "diagnose/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kPlotted = 250;

std::vector<ClipSquares> squares_of(const HeldOutGap& gap) {
  std::vector<ClipSquares> squares;
  for (const ClipGap& clip : gap.clips) squares.push_back({clip.chi2, clip.freedom});
  return squares;
}

std::vector<ClipSquares> acceleration_squares_of(const HeldOutGap& gap) {
  std::vector<ClipSquares> squares;
  for (const ClipGap& clip : gap.clips) squares.push_back({clip.acceleration_square, clip.acceleration_count});
  return squares;
}

GapIntervals intervals_of(const TrackSet& set, const HeldOutGap& before, const HeldOutGap& after, bool shrinks) {
  GapIntervals of;
  of.why_none = why_no_interval(set.pieces ? 1 : set.clips.size());
  if (!of.why_none.empty()) return of;
  of.before = rms_interval(squares_of(before));
  of.after = rms_interval(squares_of(after));
  if (shrinks) of.shrink = shrink_interval(squares_of(before), squares_of(after));
  of.acceleration_before = rms_interval(acceleration_squares_of(before));
  of.acceleration_after = rms_interval(acceleration_squares_of(after));
  return of;
}

}  // namespace

GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, std::vector<std::string>& notes) {
  GapSizes gap;
  TrackSet split;
  HeldOutGap before, after;
  if (set.clips.size() < 2) {
    split = split_clip(set);
    const MotionFit first = fit_nominal(split);
    before = held_out_gap(split, first);
    after = before;
    if (!best.effects.empty() && best.late.empty()) {
      // From the fit to the whole clip: each stretch starts where that fit is at its beginning.
      FitPoint start{best.at.global, {}};
      for (const TrackedMotion& part : split.motions) {
        std::size_t whole = 0;
        while (whole + 1 < set.motions.size() && set.motions[whole].t_s.back() < part.t_s.front()) ++whole;
        Eigen::VectorXd own = best.at.own[whole];
        const auto at = static_cast<std::size_t>(
            std::lower_bound(set.motions[whole].t_s.begin(), set.motions[whole].t_s.end(), part.t_s.front()) -
            set.motions[whole].t_s.begin());
        own[0] = part.x_m.front();
        own[1] = best.motions[whole].v_m_s[std::min(at, best.motions[whole].v_m_s.size() - 1)];
        start.own.push_back(own);
      }
      after = held_out_gap(split, fit_motions(split, best.effects, start));
    }
    notes.push_back(
        "There is one clip only, so that none can be held out: the gap is measured on held-out quarters of it.");
  } else {
    before = held_out_gap(set, nominal);
    after = held_out_gap(set, best);
  }
  gap.before = before.value;
  gap.after = after.value;
  gap.standard_error = before.standard_error;
  if (gap.before > 1.0 + gap.standard_error) gap.shrink = (gap.before - gap.after) / (gap.before - 1.0);
  gap.acceleration_before = before.acceleration_m_s2;
  gap.acceleration_after = after.acceleration_m_s2;
  for (std::size_t c = 0; c < before.clips.size(); ++c) {
    gap.held_out.push_back(before.clips[c].clip);
    gap.before_by_clip.push_back(std::sqrt(before.clips[c].chi2 / before.clips[c].freedom));
    gap.after_by_clip.push_back(c < after.clips.size() ? std::sqrt(after.clips[c].chi2 / after.clips[c].freedom)
                                                       : gap.before_by_clip.back());
  }
  gap.interval95 = intervals_of(set, before, after, gap.shrink.has_value());
  const std::vector<StatementPull> was = statement_pulls(set, nominal), is = statement_pulls(set, best);
  for (std::size_t p = 0; p < was.size() && p < is.size(); ++p) {
    gap.parameters.push_back({was[p].quantity, was[p].against, was[p].group, was[p].z, is[p].z});
  }
  return gap;
}

std::vector<ResidualCurve> residuals_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best) {
  std::vector<ResidualCurve> curves;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    ResidualCurve curve;
    curve.clip = set.clips[motion.clip].name;
    const std::size_t step = std::max<std::size_t>(1, motion.t_s.size() / kPlotted);
    for (std::size_t p = 0; p < motion.t_s.size(); p += step) {
      if (motion.outlier[p]) continue;
      curve.t_s.push_back(motion.t_s[p]);
      curve.x_m.push_back(motion.x_m[p]);
      curve.v_m_s.push_back(nominal.motions[i].v_m_s[p]);
      curve.before_m.push_back(nominal.motions[i].plain[static_cast<Eigen::Index>(p)] * motion.sd_of(p));
      curve.after_m.push_back(best.motions[i].plain[static_cast<Eigen::Index>(p)] * motion.sd_of(p));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace glidelab::diagnose
