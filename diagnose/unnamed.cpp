#include "diagnose/unnamed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace glidelab::diagnose {
namespace {

constexpr int kCoarse = 12, kFine = 36;
constexpr double kSure = 2.0;        // standard deviations at which a place is named
constexpr double kUnseen = 1e-10;    // of the largest square: taken up by what is fitted
constexpr double kMostSeen = 2e4;    // standard deviations of one bump: four decades from what begins to show
constexpr double kMostSwings = 600;  // periods that are tried

UnnamedFamily family_of(std::string variable, std::string what, std::string unit) {
  UnnamedFamily family;
  family.variable = std::move(variable);
  family.what = std::move(what);
  family.unit = std::move(unit);
  return family;
}

struct Grid {
  int bumps = kCoarse;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double width() const { return (high - low) / (bumps - 1); }
  double at(int i) const { return low + width() * i; }
};

/// Gauss's bump of unit height, as wide as the bumps are apart.
double bump(double x, double middle, double width) {
  const double z = (x - middle) / width;
  return std::abs(z) > 5.0 ? 0.0 : std::exp(-0.5 * z * z);
}

/// Products of columns with each other and with the residual.
struct Normal {
  Eigen::MatrixXd products;
  Eigen::VectorXd scores;
};

Eigen::MatrixXd rests_of(const std::vector<ScoreColumn>& columns) {
  Eigen::MatrixXd rests(columns.front().rest.size(), std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c) rests.col(static_cast<Eigen::Index>(c)) = columns[c].rest;
  return rests;
}

Normal normal_of(const ScoreSpace& space, const std::vector<ScoreColumn>& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Normal normal{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
  for (Eigen::Index a = 0; a < n; ++a) {
    const auto& column = columns[static_cast<std::size_t>(a)];
    normal.scores[a] = space.dot(column, space.residual());
    for (Eigen::Index b = 0; b <= a; ++b) {
      normal.products(a, b) = normal.products(b, a) = space.dot(column, columns[static_cast<std::size_t>(b)]);
    }
  }
  return normal;
}

UnnamedFamily solve(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily family,
                    SpreadEvidence& evidence) {
  const Normal normal = normal_of(space, columns);
  evidence = normal.products.allFinite() ? log_spread_evidence(normal.products, normal.scores) : SpreadEvidence{};
  family.log_evidence = evidence.log_evidence;
  family.gain = evidence.gain;
  family.columns = rests_of(columns);
  family.tau = evidence.tau;
  return family;
}

void name_regions(UnnamedFamily& family) {
  for (std::size_t i = 0; i < family.at.size(); ++i) {
    const double z = family.sd[i] > 0.0 ? std::abs(family.size[i]) / family.sd[i] : 0.0;
    if (z < kSure) continue;
    const bool goes_on = !family.regions.empty() && i > 0 && family.regions.back().to == family.at[i - 1];
    if (!goes_on) family.regions.push_back({family.at[i], family.at[i], 0.0, 0.0});
    UnnamedRegion& region = family.regions.back();
    region.to = family.at[i];
    if (z > region.excess) {
      region.excess = z;
      region.size = family.size[i];
    }
  }
}

/// The function that the bumps' sizes make, and its band.
void draw(const Grid& grid, const SpreadEvidence& evidence, UnnamedFamily& family) {
  if (evidence.mean.size() == 0) return;
  constexpr int kDrawn = 72;
  for (int j = 0; j <= kDrawn; ++j) {
    const double x = grid.low + (grid.high - grid.low) * j / kDrawn;
    Eigen::VectorXd basis(grid.bumps);
    for (int i = 0; i < grid.bumps; ++i) basis[i] = bump(x, grid.at(i), grid.width());
    double variance = 0.0;
    for (int a = 0; a < grid.bumps; ++a) {
      for (int b = 0; b < grid.bumps; ++b) variance += basis[a] * evidence.covariance(a, b) * basis[b];
    }
    family.at.push_back(x);
    family.size.push_back(basis.dot(evidence.mean));
    family.sd.push_back(std::sqrt(std::max(0.0, variance)));
  }
  name_regions(family);
}

/// One bump alone, or one step (all bumps from some place on), wherever it explains most: the evidence is averaged over
/// the places. What acts at one place only is paid for once, and not for all the places where nothing is.
UnnamedFamily one_place(const Normal& normal, const std::vector<ScoreColumn>& columns, const Grid& grid, bool step,
                        UnnamedFamily family) {
  const Eigen::Index n = normal.scores.size();
  if (!normal.products.allFinite()) return family;
  const double largest = normal.products.diagonal().maxCoeff();
  std::vector<double> logs;
  SpreadEvidence best;
  best.gain = -1.0;
  Eigen::Index best_from = 0;
  for (Eigen::Index from = step ? 1 : 0; from < n; ++from) {
    const Eigen::Index many = step ? n - from : 1;
    const double square = normal.products.block(from, from, many, many).sum();
    const double score = normal.scores.segment(from, many).sum();
    if (!(square > kUnseen * largest)) {
      logs.push_back(0.0);  // says nothing
      continue;
    }
    const double z = score / std::sqrt(square);
    logs.push_back(log_amplitude_evidence(z, kMostSeen, true));
    if (0.5 * z * z <= best.gain) continue;
    best.gain = 0.5 * z * z;
    best.mean = Eigen::VectorXd::Zero(n);
    best.mean.segment(from, many).setConstant(score / square);
    best.covariance = Eigen::MatrixXd::Zero(n, n);
    best.covariance.block(from, from, many, many).setConstant(1.0 / square);
    best_from = from;
  }
  if (logs.empty() || best.gain < 0.0) return family;
  family.log_evidence = log_mean(logs);
  family.gain = best.gain;
  family.columns = Eigen::MatrixXd::Zero(columns.front().rest.size(), 1);
  for (Eigen::Index c = best_from; c < (step ? n : best_from + 1); ++c) {
    family.columns.col(0) += columns[static_cast<std::size_t>(c)].rest;
  }
  family.tau = std::numeric_limits<double>::infinity();
  draw(grid, best, family);
  return family;
}

/// The three shapes that a function over a grid may have: smooth anywhere, one bump, one step.
void add_shapes(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, const Grid& grid,
                const UnnamedFamily& family, std::vector<UnnamedFamily>& families) {
  const Normal normal = normal_of(space, columns);
  SpreadEvidence evidence;
  families.push_back(solve(space, columns, family, evidence));
  draw(grid, evidence, families.back());
  families.push_back(one_place(normal, columns, grid, false, family));
  families.push_back(one_place(normal, columns, grid, true, family));
}

struct Ranges {
  Grid x, v, t;
};

Ranges ranges_of(const ScoreSpace& space) {
  Ranges ranges;
  for (std::size_t i = 0; i < space.set().motions.size(); ++i) {
    for (const double x : space.set().motions[i].x_m) ranges.x.add(x);
    for (const double t : space.set().motions[i].t_s) ranges.t.add(t);
    for (const double v : space.fit().motions[i].v_m_s) ranges.v.add(v);
  }
  return ranges;
}

using Force = std::function<double(double mass_kg, double place, double v_m_s)>;

/// A force f(place) of any smooth shape.
void add_force(const ScoreSpace& space, const Grid& grid, int variable, const std::string& name,
               const std::string& what, bool with_mass, bool friction, std::vector<UnnamedFamily>& families) {
  const TrackSet& set = space.set();
  std::vector<ScoreColumn> columns;
  for (int b = 0; b < grid.bumps; ++b) {
    std::vector<UnnamedForce> forces;
    for (const TrackedMotion& motion : set.motions) {
      const double factor = with_mass ? set.masses[motion.mass].mass_kg : 1.0;
      const double middle = grid.at(b), width = grid.width();
      forces.push_back([=](double x, double v, double t) {
        const double place = variable == 0 ? x : variable == 1 ? v : t;
        return factor * (friction && v < 0.0 ? -1.0 : 1.0) * bump(place, middle, width);
      });
    }
    columns.push_back(space.of_force(forces, 1e-4));
  }
  add_shapes(space, columns, grid, family_of(name, what, with_mass ? "m/s²" : "N"), families);
}

enum class Seen { over_x, over_t, late };

/// A displacement d(place) of any smooth shape, what a camera does; or a lateness d(t), what its clock does.
void add_displacement(const ScoreSpace& space, const Grid& grid, Seen seen, std::vector<UnnamedFamily>& families) {
  const TrackSet& set = space.set();
  std::vector<ScoreColumn> columns;
  for (int b = 0; b < grid.bumps; ++b) {
    std::vector<Eigen::VectorXd> changes;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const auto& place = seen == Seen::over_x ? space.modelled(i) : set.motions[i].t_s;
      const auto& v = space.fit().motions[i].v_m_s;
      Eigen::VectorXd change(static_cast<Eigen::Index>(place.size()));
      for (std::size_t p = 0; p < place.size(); ++p) {
        change[static_cast<Eigen::Index>(p)] =
            (seen == Seen::late ? v[p] : 1.0) * bump(place[p], grid.at(b), grid.width());
      }
      changes.push_back(std::move(change));
    }
    columns.push_back(space.project(changes));
  }
  add_shapes(space, columns, grid,
             family_of(seen == Seen::over_x ? "x_m" : "t_s", seen == Seen::late ? "lateness" : "displacement",
                       seen == Seen::late ? "s" : "m"),
             families);
}

/// A displacement that swings with the place: sin and cos of 2 pi f x, one f for all motions, averaged over.
UnnamedFamily swing_family(const ScoreSpace& space, const Grid& x) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of("x_m", "displacement", "m");
  std::vector<double> ways;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& at = space.modelled(i);
    for (std::size_t p = 1; p < at.size(); ++p) ways.push_back(std::abs(at[p] - at[p - 1]));
  }
  const double range = x.high - x.low;
  if (ways.empty() || !(range > 0.0)) return family;
  std::nth_element(ways.begin(), ways.begin() + std::ssize(ways) / 2, ways.end());
  // Half of all frames lie closer than this: two of them a turn at least; and no more looks than kMostSwings.
  const double highest = std::min(0.5 / std::max(ways[ways.size() / 2], 1e-9), kMostSwings * 0.3 / range);
  std::vector<double> logs;
  for (double f = 2.0 / range; f < highest; f += 0.3 / range) {
    std::vector<ScoreColumn> columns;
    for (const double phase : {0.0, 0.25}) {
      std::vector<Eigen::VectorXd> changes;
      for (std::size_t i = 0; i < set.motions.size(); ++i) {
        const auto& at = space.modelled(i);
        Eigen::VectorXd change(static_cast<Eigen::Index>(at.size()));
        for (std::size_t p = 0; p < at.size(); ++p) {
          change[static_cast<Eigen::Index>(p)] = std::sin(2.0 * std::numbers::pi * (f * at[p] + phase));
        }
        changes.push_back(std::move(change));
      }
      columns.push_back(space.project(changes));
    }
    SpreadEvidence evidence;
    const UnnamedFamily one = solve(space, columns, family, evidence);
    logs.push_back(one.log_evidence);
    if (one.gain <= family.gain) continue;
    family.gain = one.gain;
    family.columns = one.columns;
    family.tau = one.tau;
    family.at.clear();
    family.size.clear();
    family.sd.clear();
    constexpr int kDrawn = 240;
    for (int j = 0; j <= kDrawn; ++j) {
      const double place = x.low + range * j / kDrawn, turn = 2.0 * std::numbers::pi * f * place;
      const Eigen::Vector2d basis(std::sin(turn), std::cos(turn));
      family.at.push_back(place);
      family.size.push_back(basis.dot(evidence.mean));
      family.sd.push_back(std::sqrt(std::max(0.0, basis.dot(evidence.covariance * basis))));
    }
  }
  if (!logs.empty()) family.log_evidence = log_mean(logs);
  name_regions(family);
  return family;
}

/// Any smooth displacement of each clip by itself. The motions share no bump, so that the evidence adds up but for the
/// common size tau; what the common parameters take up is left aside.
UnnamedFamily own_family(const ScoreSpace& space) {
  const TrackSet& set = space.set();
  const UnnamedFamily family = family_of("clip", "displacement", "m");
  std::vector<ScoreColumn> columns;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& t = set.motions[i].t_s;
    const double span = t.back() - t.front();
    const int bumps = std::clamp(static_cast<int>(span / 0.2), 5, 12);
    const double width = span / (bumps - 1);
    for (int b = 0; b < bumps; ++b) {
      std::vector<Eigen::VectorXd> changes(set.motions.size());
      changes[i].resize(static_cast<Eigen::Index>(t.size()));
      for (std::size_t p = 0; p < t.size(); ++p) {
        changes[i][static_cast<Eigen::Index>(p)] = bump(t[p], t.front() + width * b, width);
      }
      columns.push_back(space.project(changes));
    }
  }
  SpreadEvidence evidence;
  return solve(space, columns, family, evidence);
}

/// A force of one kind whose size differs between members (masses, set-ups, motions).
UnnamedFamily member_family(const ScoreSpace& space, const std::string& variable, const std::string& what,
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
  for (std::size_t m = 0; m < members && evidence.mean.size() > 0; ++m) {
    const auto e = static_cast<Eigen::Index>(m);
    family.at.push_back(variable == "mass_kg" ? set.masses[m].mass_kg : static_cast<double>(m));
    family.size.push_back(evidence.mean[e]);
    family.sd.push_back(std::sqrt(std::max(0.0, evidence.covariance(e, e))));
    if (variable == "group") family.names.push_back(set.groups[m].name);
    if (variable == "clip") family.names.push_back(set.clips[m].name);
  }
  name_regions(family);
  return family;
}

}  // namespace

std::vector<UnnamedFamily> unnamed_families(const ScoreSpace& space) {
  const TrackSet& set = space.set();
  const Ranges ranges = ranges_of(space);
  std::vector<UnnamedFamily> families;
  for (const int bumps : {kCoarse, kFine}) {
    Grid v = ranges.v, x = ranges.x;
    v.bumps = x.bumps = bumps;
    add_force(space, v, 1, "v_m_s", "force", false, false, families);
    add_force(space, x, 0, "x_m", "acceleration", true, false, families);
    add_force(space, x, 0, "x_m", "friction", true, true, families);
    add_displacement(space, x, Seen::over_x, families);
  }
  add_force(space, ranges.t, 2, "t_s", "acceleration", true, false, families);
  add_force(space, ranges.t, 2, "t_s", "friction", true, true, families);
  add_displacement(space, ranges.t, Seen::over_t, families);
  add_displacement(space, ranges.t, Seen::late, families);
  families.push_back(swing_family(space, ranges.x));
  families.push_back(own_family(space));
  if (set.masses.size() > 1) {
    families.push_back(member_family(space, "mass_kg", "friction", &TrackedMotion::mass, set.masses.size(), 2));
    families.push_back(member_family(space, "mass_kg", "viscous drag", &TrackedMotion::mass, set.masses.size(), 1));
  }
  if (set.groups.size() > 1) {
    families.push_back(member_family(space, "group", "force", &TrackedMotion::group, set.groups.size(), 0));
    families.push_back(member_family(space, "group", "friction", &TrackedMotion::group, set.groups.size(), 2));
  }
  if (set.clips.size() > 1) {
    families.push_back(member_family(space, "clip", "force", &TrackedMotion::clip, set.clips.size(), 0));
    families.push_back(member_family(space, "clip", "viscous drag", &TrackedMotion::clip, set.clips.size(), 1));
  }
  const auto likeliest = std::max_element(families.begin(), families.end(),
                                          [](const auto& a, const auto& b) { return a.log_evidence < b.log_evidence; });
  for (auto family = families.begin(); family != families.end(); ++family) {
    if (family != likeliest) family->columns.resize(0, 0);
  }
  return families;
}

MotionFit with_unnamed(const MotionFit& fit, const UnnamedFamily& family) {
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
    with.statements.push_back({static_cast<std::size_t>(before + b), 0.0, family.tau, "", false});
  }
  return with;
}

double log_unnamed_evidence(const std::vector<UnnamedFamily>& families) {
  std::vector<double> logs;
  for (const UnnamedFamily& family : families) logs.push_back(family.log_evidence);
  return log_mean(logs);
}

}  // namespace glidelab::diagnose
