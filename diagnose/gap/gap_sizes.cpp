#include "diagnose/gap/gap_sizes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "core/result/estimate.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/domain_gaps.h"
#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

/// Root mean square without clip `left_out`; of all clips if that is not the index of a clip.
double rms(std::span<const ClipSquares> clips, std::size_t left_out) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    if (c == left_out) continue;
    sum += clips[c].sum;
    count += clips[c].count;
  }
  return std::sqrt(sum / count);
}

/// `of`: the index of the clip that is left out, or n.
template <class Pooled>
std::optional<GapInterval> jackknife(std::size_t n, const Pooled& of) {
  std::vector<double> without;
  double mean = 0.0, square = 0.0;
  for (std::size_t c = 0; c < n; ++c) mean += without.emplace_back(of(c)) / static_cast<double>(n);
  for (const double value : without) square += (value - mean) * (value - mean);
  const double se = std::sqrt(square * (static_cast<double>(n) - 1.0) / static_cast<double>(n));
  const double half = core::student_t975(static_cast<double>(n) - 1.0) * se;
  const double all = of(n);
  if (!std::isfinite(all) || !std::isfinite(half)) return {};
  return GapInterval{all - half, all + half};
}

}  // namespace

std::optional<std::size_t> too_few_clips(std::size_t clips) {
  return clips < kFewestClips ? std::optional(clips) : std::nullopt;
}

std::optional<GapInterval> rms_interval(std::span<const ClipSquares> clips) {
  std::vector<ClipSquares> counted;
  std::copy_if(clips.begin(), clips.end(), std::back_inserter(counted), [](const auto& c) { return c.count > 0.0; });
  if (counted.size() < kFewestClips) return {};
  const auto log = jackknife(counted.size(), [&](std::size_t c) { return std::log(rms(counted, c)); });
  if (!log) return {};
  return GapInterval{std::exp(log->low), std::exp(log->high)};
}

double floor_of(double gap_after, double standard_error) {
  return gap_after < 1.0 - kClearGap * standard_error ? gap_after : 1.0;
}

std::optional<GapInterval> shrink_interval(std::span<const ClipSquares> before, std::span<const ClipSquares> after,
                                           double floor) {
  if (before.size() < kFewestClips || before.size() != after.size()) return {};
  for (std::size_t c = 0; c <= before.size(); ++c) {
    if (!(rms(before, c) > floor)) return {};
  }
  return jackknife(before.size(), [&](std::size_t c) {
    const double was = rms(before, c), is = rms(after, c);
    return (was - is) / (was - floor);
  });
}

std::optional<GapInterval> share_interval(std::span<const ClipSquares> first, std::span<const ClipSquares> before,
                                          std::span<const ClipSquares> after, double floor) {
  if (first.size() < kFewestClips || first.size() != before.size() || first.size() != after.size()) return {};
  for (std::size_t c = 0; c <= first.size(); ++c) {
    if (!(rms(first, c) > floor)) return {};
  }
  const auto square = [](std::span<const ClipSquares> of, std::size_t c) { return rms(of, c) * rms(of, c); };
  return jackknife(first.size(), [&](std::size_t c) {
    return (square(before, c) - square(after, c)) / (square(first, c) - floor * floor);
  });
}

namespace {

constexpr std::size_t kPlotted = 250;  // residuals of a motion

/// A single clip in quarters, and both fits to them, for the comparison in the phase plane.
struct SplitFits {
  TrackSet set;
  MotionFit nominal, best;
};

SplitFits split_fits(const TrackSet& set, const MotionFit& best) {
  SplitFits split{split_clip(set), {}, {}};
  split.nominal = fit_nominal(split.set);
  split.best = split.nominal;
  if (best.effects.empty() || !best.late.empty()) return split;
  // Starting from the fit to the whole clip: each stretch starts at that fit's position and speed at its beginning.
  FitPoint start{best.at.global, {}};
  for (const TrackedMotion& part : split.set.motions) {
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
  split.best = fit_motions(split.set, best.effects, start);
  return split;
}

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

GapIntervals intervals_of(const TrackSet& set, const HeldOutGap& before, const HeldOutGap& after, const GapSizes& gap) {
  GapIntervals of;
  of.too_few = too_few_clips(set.pieces ? 1 : set.clips.size());
  if (of.too_few) return of;
  of.before = rms_interval(squares_of(before));
  of.after = rms_interval(squares_of(after));
  if (gap.shrink) of.shrink = shrink_interval(squares_of(before), squares_of(after), gap.floor);
  of.acceleration_before = rms_interval(acceleration_squares_of(before));
  of.acceleration_after = rms_interval(acceleration_squares_of(after));
  return of;
}

/// Root mean square; empty if there are no values.
class RootMeanSquare {
 public:
  void add(double z) {
    sum_ += z * z;
    count_ += 1.0;
  }
  std::optional<double> value() const {
    return count_ > 0.0 ? std::optional<double>(std::sqrt(sum_ / count_)) : std::nullopt;
  }

 private:
  double sum_ = 0.0, count_ = 0.0;
};

double most_seen(const std::vector<ImageFinding>& images, const std::vector<DiagnosedEffect>& but) {
  double most = 1.0;
  for (const ImageFinding& finding : images) {
    const bool named =
        std::any_of(but.begin(), but.end(), [&](const DiagnosedEffect& effect) { return effect.id == finding.id; });
    if (!named && !finding.stated) most = std::max(most, std::sqrt(2.0 * std::max(0.0, finding.log_evidence)));
  }
  return most;
}

}  // namespace

GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, bool unnamed,
                std::vector<Note>& notes) {
  GapSizes gap;
  const HeldOutGap before = held_out_gap(set, nominal), after = held_out_gap(set, best);
  if (set.clips.size() < 2) {
    const SplitFits split = split_fits(set, best);
    gap.phase_plane = phase_gaps(split.set, split.nominal, split.best);
    notes.emplace_back(QuartersHeldOut{});
  } else {
    gap.phase_plane = phase_gaps(set, nominal, best);
  }
  gap.before = before.value;
  gap.after = after.value;
  gap.standard_error = before.standard_error;
  gap.floor = floor_of(gap.after, gap.standard_error);
  if (gap.before > 1.0 + gap.standard_error) gap.shrink = (gap.before - gap.after) / (gap.before - gap.floor);
  gap.acceleration_before = before.acceleration_m_s2;
  gap.acceleration_after = after.acceleration_m_s2;
  for (std::size_t c = 0; c < before.clips.size(); ++c) {
    gap.held_out.push_back(before.clips[c].clip);
    gap.before_by_clip.push_back(std::sqrt(before.clips[c].chi2 / before.clips[c].freedom));
    gap.after_by_clip.push_back(c < after.clips.size() ? std::sqrt(after.clips[c].chi2 / after.clips[c].freedom)
                                                       : gap.before_by_clip.back());
  }
  gap.interval95 = intervals_of(set, before, after, gap);
  const std::vector<StatementPull> was = statement_pulls(set, nominal), is = statement_pulls(set, best);
  for (std::size_t p = 0; p < was.size() && p < is.size(); ++p) {
    gap.parameters.push_back({was[p].quantity, was[p].against, was[p].group, was[p].z, is[p].z});
  }
  for (GapOfParameter& of : parameter_gaps(set, nominal, unnamed ? nullptr : &best)) {
    gap.parameters.push_back(std::move(of));
  }
  return gap;
}

std::vector<GapDomain> gap_domains(const GapSizes& gap, const std::vector<ImageFinding>& images,
                                   const std::vector<DiagnosedEffect>& named) {
  std::vector<GapDomain> domains = {{GapDomainKind::positions, gap.before, gap.after}};
  RootMeanSquare a_before, a_after, q_before, q_after;
  bool all_after = true;  // whether every parameter with a value before has one after
  for (const PhaseGap& of : gap.phase_plane) {
    if (gap.phase_plane.size() > 1 && !of.mass_kg) continue;  // these are the same points again
    for (const PhaseBin& bin : of.bins) {
      a_before.add(bin.before.value / bin.before.sd);
      a_after.add(bin.after.value / bin.after.sd);
    }
  }
  if (a_before.value()) domains.push_back({GapDomainKind::phase_plane, *a_before.value(), a_after.value()});
  for (const GapOfParameter& of : gap.parameters) {
    if (!of.z_before) continue;
    q_before.add(*of.z_before);
    all_after = all_after && of.z_after.has_value();
    q_after.add(of.z_after.value_or(0.0));
  }
  if (q_before.value()) {
    domains.push_back({GapDomainKind::parameters, *q_before.value(), all_after ? q_after.value() : std::nullopt});
  }
  if (!images.empty()) domains.push_back({GapDomainKind::images, most_seen(images, {}), most_seen(images, named)});
  return domains;
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
      curve.noise_m.push_back(motion.sd_of(p));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

bool holds_within(double gap_within, double gap_of_all) {
  constexpr double kMostExcessWithin = 0.15;
  return gap_within * gap_within - 1.0 < kMostExcessWithin * (gap_of_all * gap_of_all - 1.0);
}

}  // namespace glidelab::diagnose
