#include "diagnose/unnamed/unnamed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "base/long_work.h"
#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/unnamed/unnamed_family.h"
#include "diagnose/unnamed/unnamed_places.h"

namespace glidelab::diagnose {
namespace {

/// Any smooth displacement of each clip by itself. The motions share no bump, so their evidence adds up except for the
/// common size tau; what the common parameters absorb is neglected.
UnnamedFamily own_family(const ScoreSpace& space, double apart_s, int fewest, int most) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of(GapVariable::clip, GapKind::displacement, "m");
  std::vector<ScoreColumn> columns;
  std::vector<Grid> grids;  // of each motion
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& t = set.motions[i].t_s;
    Grid grid;
    grid.add(t.front());
    grid.add(t.back());
    grid.bumps = bumps_over(t.back() - t.front(), apart_s, fewest, most);
    for (int b = 0; b < grid.bumps; ++b) {
      std::vector<Eigen::VectorXd> changes(set.motions.size());
      changes[i].resize(static_cast<Eigen::Index>(t.size()));
      for (std::size_t p = 0; p < t.size(); ++p) {
        changes[i][static_cast<Eigen::Index>(p)] = bump(t[p], grid.at(b), grid.width());
      }
      columns.push_back(space.project(changes));
    }
    grids.push_back(grid);
  }
  SpreadEvidence evidence;
  family = solve(space, columns, family, evidence);
  // For each clip: the largest value of the curve that its bumps make together, and the significance where that is
  // highest.
  family.size.assign(set.clips.size(), 0.0);
  family.sd.assign(set.clips.size(), 0.0);
  std::vector<double> surest(set.clips.size(), 0.0);
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < set.motions.size() && evidence.mean.size() > 0; ++i) {
    UnnamedFamily curve;
    draw_curve(grids[i], evidence.mean.segment(first, grids[i].bumps),
               evidence.covariance.block(first, first, grids[i].bumps, grids[i].bumps), curve);
    first += grids[i].bumps;
    name_regions(curve);
    const std::size_t c = set.motions[i].clip;
    for (const UnnamedRegion& region : curve.regions) {
      if (region.excess <= surest[c]) continue;
      surest[c] = region.excess;
      family.size[c] = region.size;
      family.sd[c] = std::abs(region.size) / region.excess;
    }
  }
  for (std::size_t c = 0; c < set.clips.size(); ++c) {
    family.at.push_back(static_cast<double>(c));
    family.names.push_back(set.clips[c].name);
  }
  name_regions(family);
  return family;
}

/// Sizes minus their mean: the fitted parameters absorb what all members have in common, and no data determine it.
void relative_to_mean(SpreadEvidence& evidence) {
  const Eigen::Index n = evidence.mean.size();
  const Eigen::MatrixXd less =
      Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));
  evidence.mean = base::product(less, evidence.mean);
  evidence.covariance = base::product(base::product(less, evidence.covariance), less);
}

/// The part of a settling displacement that is left at t: 1 at the start, about a half at `time_s`; slowly (like creep)
/// or quickly.
double unsettled(double t_s, double time_s, bool quickly) {
  return quickly ? std::pow(1.0 + t_s / (3.0 * time_s), -3.0) : 1.0 / (1.0 + t_s / time_s);
}

/// The members' sizes, each at its index.
void draw_members(const SpreadEvidence& evidence, UnnamedFamily& family) {
  family.at.clear();
  family.size.clear();
  family.sd.clear();
  for (Eigen::Index m = 0; m < evidence.mean.size(); ++m) {
    family.at.push_back(static_cast<double>(m));
    family.size.push_back(evidence.mean[m]);
    family.sd.push_back(std::sqrt(std::max(0.0, evidence.covariance(m, m))));
  }
}

/// One size times the part of it that is left over time, until that falls to a tenth.
void draw_settling(double size, double sd, double longest_s, const std::function<double(double)>& left,
                   UnnamedFamily& family) {
  constexpr int kDrawn = 72;
  constexpr double kSettled = 0.1;
  double until_s = longest_s;
  while (left(until_s) < kSettled) until_s *= 0.9;
  family.at.clear();
  family.size.clear();
  family.sd.clear();
  for (int j = 0; j <= kDrawn; ++j) {
    family.at.push_back(until_s * j / kDrawn);
    family.size.push_back(size * left(family.at.back()));
    family.sd.push_back(sd * left(family.at.back()));
  }
}

/// Whatever decays from the start of each clip, at one rate in all: a displacement, with a size for each clip, or a
/// delay common to all.
UnnamedFamily settling_family(const ScoreSpace& space, bool late) {
  const TrackSet& set = space.set();
  UnnamedFamily family = late ? family_of(GapVariable::time, GapKind::lateness, "s")
                              : family_of(GapVariable::clip, GapKind::displacement, "m");
  double longest = 0.0, frame = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    longest = std::max(longest, motion.t_s.back());
    frame = std::max(frame, 1.0 / set.clips[motion.clip].frame_rate_hz);
  }
  std::vector<double> logs;
  for (const bool quickly : {false, true}) {
    for (double time_s = 0.5 * frame; time_s < longest; time_s *= 1.7) {
      std::vector<std::vector<Eigen::VectorXd>> changes(late ? 1 : set.clips.size(),
                                                        std::vector<Eigen::VectorXd>(set.motions.size()));
      for (std::size_t i = 0; i < set.motions.size(); ++i) {
        const TrackedMotion& motion = set.motions[i];
        const auto& v = space.fit().motions[i].v_m_s;
        Eigen::VectorXd& change = changes[late ? 0 : motion.clip][i];
        change.resize(static_cast<Eigen::Index>(motion.t_s.size()));
        for (std::size_t p = 0; p < motion.t_s.size(); ++p) {
          change[static_cast<Eigen::Index>(p)] = (late ? v[p] : 1.0) * unsettled(motion.t_s[p], time_s, quickly);
        }
      }
      std::vector<ScoreColumn> columns;
      for (const auto& of_one : changes) columns.push_back(space.project(of_one));
      SpreadEvidence evidence;
      const Tried tried = try_one(space, columns, family, evidence);
      logs.push_back(tried.log_evidence);
      if (!tried.better) continue;
      if (!late) {
        draw_members(evidence, family);
      } else if (evidence.mean.size() > 0) {
        const auto left = [&](double t_s) { return unsettled(t_s, time_s, quickly); };
        draw_settling(evidence.mean[0], std::sqrt(std::max(0.0, evidence.covariance(0, 0))), longest, left, family);
      }
    }
  }
  if (!logs.empty()) family.log_evidence = base::log_mean(logs);
  if (!late) {
    for (const TrackedClip& clip : set.clips) family.names.push_back(clip.name);
  }
  name_regions(family);
  return family;
}

/// A scale for each clip, as if the camera was moved between clips.
UnnamedFamily scale_family(const ScoreSpace& space) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of(GapVariable::clip, GapKind::scale, "m/m");
  std::vector<ScoreColumn> columns;
  for (std::size_t c = 0; c < set.clips.size(); ++c) {
    std::vector<Eigen::VectorXd> changes(set.motions.size());
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const std::vector<double>& x = space.modelled(i);
      if (set.motions[i].clip == c) changes[i] = Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
    }
    columns.push_back(space.project(changes));
    family.names.push_back(set.clips[c].name);
  }
  SpreadEvidence evidence;
  family = solve(space, columns, family, evidence);
  if (evidence.mean.size() > 0) relative_to_mean(evidence);
  draw_members(evidence, family);
  name_regions(family);
  return family;
}

/// A force of one kind whose size differs between members (masses, set-ups, motions).
UnnamedFamily member_family(const ScoreSpace& space, GapVariable variable, GapKind what,
                            std::size_t TrackedMotion::*member, std::size_t members, int kind) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of(variable, what, kind == 1 ? "N s/m" : "N");
  std::vector<ScoreColumn> columns;
  for (std::size_t m = 0; m < members; ++m) {
    std::vector<UnnamedForce> forces(set.motions.size());
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      if (set.motions[i].*member != m) continue;
      if (kind == 0) forces[i] = [](double, double, double) { return 1.0; };
      if (kind == 1) forces[i] = [](double, double v, double) { return -v; };
      if (kind == 2) forces[i] = [](double, double v, double) { return v < 0.0 ? 1.0 : -1.0; };
    }
    columns.push_back(space.of_force(forces, 1e-4));
  }
  SpreadEvidence evidence;
  family = solve(space, columns, family, evidence);
  if (evidence.mean.size() > 0) relative_to_mean(evidence);
  draw_members(evidence, family);
  for (std::size_t m = 0; m < family.at.size(); ++m) {
    if (variable == GapVariable::mass) family.at[m] = set.masses[m].mass_kg;
    if (variable == GapVariable::set_up) family.names.push_back(set.groups[m].name);
    if (variable == GapVariable::clip) family.names.push_back(set.clips[m].name);
  }
  name_regions(family);
  return family;
}

/// Families that differ between members: clips, masses or set-ups. `space` must outlive the searches.
void add_member_families(const ScoreSpace& space, std::vector<FamilySearch>& searches) {
  const TrackSet& set = space.set();
  const auto add = [&](auto find) {
    searches.emplace_back([find, &space](std::vector<UnnamedFamily>& families) { families.push_back(find(space)); });
  };
  const auto member = [&](GapVariable variable, GapKind what, std::size_t TrackedMotion::*of, std::size_t members,
                          int kind) {
    add([=](const ScoreSpace& around) { return member_family(around, variable, what, of, members, kind); });
  };
  add([](const ScoreSpace& around) { return own_family(around, 0.5, 3, 5); });
  add([](const ScoreSpace& around) { return own_family(around, 0.2, 5, 12); });
  add([](const ScoreSpace& around) { return settling_family(around, false); });
  add([](const ScoreSpace& around) { return settling_family(around, true); });
  if (set.masses.size() > 1) {
    member(GapVariable::mass, GapKind::friction, &TrackedMotion::mass, set.masses.size(), 2);
    member(GapVariable::mass, GapKind::viscous_drag, &TrackedMotion::mass, set.masses.size(), 1);
  }
  if (set.groups.size() > 1) {
    member(GapVariable::set_up, GapKind::force, &TrackedMotion::group, set.groups.size(), 0);
    member(GapVariable::set_up, GapKind::friction, &TrackedMotion::group, set.groups.size(), 2);
  }
  if (set.clips.size() > 1) {
    member(GapVariable::clip, GapKind::force, &TrackedMotion::clip, set.clips.size(), 0);
    member(GapVariable::clip, GapKind::viscous_drag, &TrackedMotion::clip, set.clips.size(), 1);
    add(scale_family);
  }
}

}  // namespace

std::vector<UnnamedFamily> unnamed_families(const ScoreSpace& space, int jobs) {
  std::vector<FamilySearch> searches;
  add_place_families(space, searches);
  add_member_families(space, searches);
  std::vector<std::vector<UnnamedFamily>> found(searches.size());
  base::for_each_parallel(searches.size(), jobs, [&](std::size_t s) { searches[s](found[s]); });
  std::vector<UnnamedFamily> families;
  for (auto& of_one : found) std::move(of_one.begin(), of_one.end(), std::back_inserter(families));
  // One size for each clip; curves of each clip by itself have many sizes.
  for (UnnamedFamily& family : families) {
    if (family.variable == GapVariable::clip && family.columns.cols() > std::ssize(space.set().clips))
      family.columns.resize(0, 0);
  }
  const UnnamedFamily *shared = likeliest_shared(families), *of_clips = likeliest_of_clips(families);
  for (UnnamedFamily& family : families) {
    if (&family != shared && &family != of_clips) family.columns.resize(0, 0);
  }
  return families;
}

namespace {

const UnnamedFamily* likeliest_with_columns(const std::vector<UnnamedFamily>& families, bool of_clips) {
  const UnnamedFamily* likeliest = nullptr;
  for (const UnnamedFamily& family : families) {
    if ((family.variable == GapVariable::clip) != of_clips || family.columns.cols() == 0) continue;
    if (likeliest == nullptr || family.log_evidence > likeliest->log_evidence) likeliest = &family;
  }
  return likeliest;
}

}  // namespace

const UnnamedFamily* likeliest_shared(const std::vector<UnnamedFamily>& families) {
  return likeliest_with_columns(families, false);
}

const UnnamedFamily* likeliest_of_clips(const std::vector<UnnamedFamily>& families) {
  return likeliest_with_columns(families, true);
}

MotionFit with_unnamed(const TrackSet& set, const MotionFit& fit, const UnnamedFamily& family) {
  MotionFit with = fit;
  const Eigen::Index before = fit.at.global.size(), more = family.columns.cols();
  with.at.global.conservativeResize(before + more);
  with.at.global.tail(more).setZero();
  Eigen::Index from = 0;
  for (FitMotion& motion : with.motions) {
    const Eigen::Index n = motion.residual.size();
    motion.global.conservativeResize(Eigen::NoChange, before + more);
    motion.global.rightCols(more) = family.columns.middleRows(from, n);
    from += n;
  }
  for (Eigen::Index b = 0; b < more && std::isfinite(family.tau); ++b) {
    with.statements.push_back({static_cast<std::size_t>(before + b), 0.0, family.tau, {}, false});
  }
  return at_linear_minimum(set, std::move(with));
}

double log_unnamed_evidence(const std::vector<UnnamedFamily>& families) {
  std::map<GapVariable, std::vector<double>> by_variable;
  for (const UnnamedFamily& family : families) by_variable[family.variable].push_back(family.log_evidence);
  std::vector<double> logs;
  for (const auto& [variable, of_one] : by_variable) logs.push_back(base::log_mean(of_one));
  return base::log_mean(logs);
}

}  // namespace glidelab::diagnose
