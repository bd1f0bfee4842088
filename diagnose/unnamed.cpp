#include "diagnose/unnamed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace glidelab::diagnose {
namespace {

constexpr int kCoarse = 12, kFine = 36;
constexpr double kSure = 2.0;  // standard deviations at which a place is named

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

UnnamedFamily solve(const ScoreSpace& space, const std::vector<ScoreColumn>& columns, UnnamedFamily family,
                    SpreadEvidence& evidence) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd products(n, n);
  Eigen::VectorXd scores(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const auto& column = columns[static_cast<std::size_t>(a)];
    scores[a] = space.dot(column, space.residual());
    for (Eigen::Index b = 0; b <= a; ++b) {
      products(a, b) = products(b, a) = space.dot(column, columns[static_cast<std::size_t>(b)]);
    }
  }
  evidence = products.allFinite() ? log_spread_evidence(products, scores) : SpreadEvidence{};
  family.log_evidence = evidence.log_evidence;
  family.gain = evidence.gain;
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
UnnamedFamily force_family(const ScoreSpace& space, const Grid& grid, int variable, const std::string& name,
                           const std::string& what, bool with_mass, bool friction) {
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
  UnnamedFamily family = family_of(name, what, with_mass ? "m/s²" : "N");
  SpreadEvidence evidence;
  family = solve(space, columns, family, evidence);
  draw(grid, evidence, family);
  return family;
}

/// A displacement d(place) of any smooth shape: what a camera does.
UnnamedFamily displacement_family(const ScoreSpace& space, const Grid& grid, bool in_time) {
  const TrackSet& set = space.set();
  std::vector<ScoreColumn> columns;
  for (int b = 0; b < grid.bumps; ++b) {
    std::vector<Eigen::VectorXd> changes;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const auto& place = in_time ? set.motions[i].t_s : space.modelled(i);
      Eigen::VectorXd change(static_cast<Eigen::Index>(place.size()));
      for (std::size_t p = 0; p < place.size(); ++p) {
        change[static_cast<Eigen::Index>(p)] = bump(place[p], grid.at(b), grid.width());
      }
      changes.push_back(std::move(change));
    }
    columns.push_back(space.project(changes));
  }
  UnnamedFamily family = family_of(in_time ? "t_s" : "x_m", "displacement", "m");
  SpreadEvidence evidence;
  family = solve(space, columns, family, evidence);
  draw(grid, evidence, family);
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
    families.push_back(force_family(space, v, 1, "v_m_s", "force", false, false));
    families.push_back(force_family(space, x, 0, "x_m", "acceleration", true, false));
    families.push_back(force_family(space, x, 0, "x_m", "friction", true, true));
  }
  families.push_back(force_family(space, ranges.t, 2, "t_s", "acceleration", true, false));
  families.push_back(displacement_family(space, ranges.x, false));
  families.push_back(displacement_family(space, ranges.t, true));
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
  return families;
}

double log_unnamed_evidence(const std::vector<UnnamedFamily>& families) {
  double most = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const UnnamedFamily& family : families) most = std::max(most, family.log_evidence);
  for (const UnnamedFamily& family : families) sum += std::exp(family.log_evidence - most);
  return most + std::log(sum / static_cast<double>(families.size()));
}

}  // namespace glidelab::diagnose
