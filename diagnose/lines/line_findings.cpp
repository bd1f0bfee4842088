#include "diagnose/lines/line_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "base/math/dense.h"
#include "diagnose/effects/effect_list.h"
#include "diagnose/gap/gap_sizes.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1;

Eigen::VectorXd column(const LineTerm& term, double sd_log_k, double sd_a0) {
  Eigen::VectorXd both(2 * term.of_a0.size());
  both << term.of_log_k / sd_log_k, term.of_a0 / sd_a0;
  return both;
}

/// The part of the column that the nominal model and the terms cannot absorb.
Eigen::VectorXd beside(const LineData& data, const std::vector<LineTerm>& terms, const Eigen::VectorXd& of,
                       double sd_log_k, double sd_a0) {
  const auto n = data.a0.size();
  const auto pk = data.base_log_k.cols(), pa = data.base_a0.cols();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(2 * n, pk + pa + static_cast<Eigen::Index>(terms.size()));
  x.block(0, 0, n, pk) = data.base_log_k / sd_log_k;
  x.block(n, pk, n, pa) = data.base_a0 / sd_a0;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    x.col(pk + pa + static_cast<Eigen::Index>(t)) = column(terms[t], sd_log_k, sd_a0);
  }
  return of - base::product(x, base::least_squares(x, of));
}

}  // namespace

Isolability line_isolability(const LineData& data, const std::vector<LineCause>& causes, double sd_log_k,
                             double sd_a0) {
  Isolability alike;
  std::vector<Eigen::VectorXd> columns;
  for (const LineCause& cause : causes) {
    if (cause.over) continue;
    const Eigen::VectorXd seen = beside(data, {}, column(cause.terms.front(), sd_log_k, sd_a0), sd_log_k, sd_a0);
    if (!(seen.norm() > 0.0)) continue;
    alike.ids.push_back(cause.id);
    alike.least_seen.push_back(1.0 / seen.norm());
    columns.push_back(seen.normalized());
  }
  for (const Eigen::VectorXd& a : columns) {
    std::vector<double> row;
    for (const Eigen::VectorXd& b : columns) row.push_back(std::min(1.0, std::abs(a.dot(b))));
    alike.cosine.push_back(std::move(row));
  }
  return alike;
}

bool taken_up(const LineData& data, const LineTerm& term, const std::vector<LineTerm>& by, double sd_log_k,
              double sd_a0) {
  const Eigen::VectorXd whole = beside(data, {}, column(term, sd_log_k, sd_a0), sd_log_k, sd_a0);
  const Eigen::VectorXd rest = beside(data, by, whole, sd_log_k, sd_a0);
  return rest.squaredNorm() <= (1.0 - kAlike * kAlike) * whole.squaredNorm();
}

std::vector<LineTerm> terms_of(const std::vector<LineCause>& causes, const std::vector<std::size_t>& which) {
  std::vector<LineTerm> terms;
  for (const std::size_t c : which) terms.insert(terms.end(), causes[c].terms.begin(), causes[c].terms.end());
  return terms;
}

namespace {

/// Whether one of two causes adds nothing to the other.
bool one_takes_up(const LineData& data, const LineCause& a, const LineCause& b, const LineSolution& nominal) {
  const auto takes_up = [&](const LineCause& by, const LineCause& of) {
    return std::all_of(of.terms.begin(), of.terms.end(), [&](const LineTerm& term) {
      return taken_up(data, term, by.terms, nominal.sd_k, nominal.sd_a);
    });
  };
  return takes_up(a, b) || takes_up(b, a);
}

}  // namespace

std::vector<LineExplanation> weigh_lines(const LineData& data, const std::vector<LineCause>& causes) {
  std::vector<LineExplanation> all;
  const auto add = [&](const std::vector<std::size_t>& which, double prior) {
    const std::vector<LineTerm> terms = terms_of(causes, which);
    LineExplanation explanation{which, solve_lines(data, terms), 0.0, prior};
    if (!all.empty()) {
      explanation.log_evidence = log_line_evidence(data, terms, explanation.solution, all.front().solution);
    }
    all.push_back(std::move(explanation));
  };
  std::set<std::string> effects;
  for (const LineCause& cause : causes) effects.insert(cause.id);
  const auto many = static_cast<double>(effects.size());
  add({}, kPriorNone);
  const LineSolution nominal = all.front().solution;
  for (std::size_t c = 0; c < causes.size(); ++c) add({c}, kPriorOne / many * causes[c].share);
  for (std::size_t c = 0; c < causes.size(); ++c) {
    for (std::size_t b = 0; b < c; ++b) {
      if (causes[b].id == causes[c].id) continue;
      // Two effects of one size are weighed however alike they are: their evidence shows it.
      const bool forms = causes[b].over || causes[c].over;
      if (forms && one_takes_up(data, causes[b], causes[c], nominal)) continue;
      add({b, c}, kPriorTwo / (0.5 * many * (many - 1.0)) * causes[b].share * causes[c].share);
    }
  }
  double most = 0.0, sum = 0.0;
  for (const LineExplanation& e : all) {
    if (!e.solution.left_out) most = std::max(most, e.log_evidence);
  }
  for (LineExplanation& e : all) {
    e.probability *= !e.solution.left_out ? std::exp(e.log_evidence - most) : 0.0;
    sum += e.probability;
  }
  for (LineExplanation& e : all) e.probability /= sum;
  return all;
}

namespace {

constexpr double kReadAngle = 0.3;    // degrees: accuracy with which a person reads a plumb line, if the table does not
                                      // say
constexpr double kLeastOff_sd = 3.0;  // standard deviations above which a group of lines is off
constexpr int kPoints = 60;           // of a curve

/// The projection onto what the columns do not explain.
Eigen::MatrixXd leaves(const Eigen::MatrixXd& columns) {
  const auto n = columns.rows();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  return unit - base::product(columns, base::least_squares(columns, unit));
}

struct Mean {
  double value = 0.0, sd = 0.0;
};

Mean mean_of(const Eigen::VectorXd& residual, const Eigen::MatrixXd& leaving, const Eigen::VectorXd& group,
             double scatter) {
  const Eigen::VectorXd w = group / group.sum();
  return {w.dot(residual), scatter * std::sqrt(std::max(0.0, w.dot(base::product(leaving, w).col(0))))};
}

double drag_of(const std::vector<TableLine>& lines) {
  double sum = 0.0;
  for (const TableLine& line : lines) sum += std::log(line.k_over_m_1_s * line.mass_kg);
  return std::exp(sum / static_cast<double>(lines.size()));
}

/// For lines, each of which is held out by itself.
void add_intervals(GapSizes& gap) {
  std::vector<ClipSquares> before, after;
  for (const double one : gap.before_by_clip) before.push_back({one * one, 1.0});
  for (const double one : gap.after_by_clip) after.push_back({one * one, 1.0});
  gap.interval95.too_few = too_few_clips(before.size());
  gap.interval95.before = rms_interval(before);
  gap.interval95.after = rms_interval(after);
  if (gap.shrink) gap.interval95.shrink = shrink_interval(before, after);
}

double mean_intercept(const std::vector<TableLine>& lines, double incline_deg) {
  double mean = 0.0, count = 0.0;
  for (const TableLine& line : lines) {
    if (line.incline_deg != incline_deg) continue;
    mean += line.a0_m_s2;
    count += 1.0;
  }
  return mean / count;
}

void compare_inclination(double stated_deg, double intercept_m_s2, double g, LineGap& gap) {
  const std::string stated = fmt::format("{} deg", stated_deg);
  if (!(std::abs(intercept_m_s2) <= g)) {
    gap.sizes.parameters.push_back({"alpha_deg", Against::stated, stated});
    gap.notes.emplace_back(BeyondGravity{stated_deg, intercept_m_s2, g});
    return;
  }
  const double degrees = std::asin(intercept_m_s2 / g) * 180.0 / std::numbers::pi;
  const double z = (degrees - stated_deg) / kReadAngle;
  gap.sizes.parameters.push_back({"alpha_deg", Against::stated, stated, z, z});
  gap.notes.emplace_back(MeanIncline{stated_deg, degrees, kReadAngle});
}

}  // namespace

LineGap line_gap(const std::vector<TableLine>& lines, double g, const LineSolution& before, const LineSolution& after,
                 const OwnScatter& scatter) {
  LineGap result;
  GapSizes& gap = result.sizes;
  gap.before = gap_of_lines(before, scatter);
  gap.after = gap_of_lines(after, scatter);
  gap.standard_error = std::sqrt(0.5 / static_cast<double>(lines.size()) + 0.5 / static_cast<double>(scatter.freedom));
  if (gap.before > 1.0 + gap.standard_error) gap.shrink = (gap.before - gap.after) / (gap.before - 1.0);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    gap.held_out.push_back(fmt::format("{:.0f} g, {}°, v {} 0", 1000.0 * lines[i].mass_kg, lines[i].incline_deg,
                                       lines[i].direction > 0 ? ">" : "<"));
    gap.before_by_clip.push_back(gap_of_line(before, scatter, i));
    gap.after_by_clip.push_back(gap_of_line(after, scatter, i));
  }
  add_intervals(gap);
  for (const double incline : different(lines, &TableLine::incline_deg)) {
    compare_inclination(incline, mean_intercept(lines, incline), g, result);
  }
  return result;
}

namespace {

/// The contribution of each line to the gap's mean square.
std::vector<ClipSquares> squares_of(const LineSolution& solution, const OwnScatter& scatter) {
  std::vector<ClipSquares> squares;
  for (std::size_t i = 0; i < solution.held_out_a.size(); ++i) {
    squares.push_back({std::pow(gap_of_line(solution, scatter, i), 2), 1.0});
  }
  return squares;
}

}  // namespace

std::vector<ExplainedCause> explained_by(const LineData& data, const std::vector<LineCause>& causes,
                                         const LineSolution& nominal, const OwnScatter& scatter,
                                         double standard_error) {
  const double first = gap_of_lines(nominal, scatter);
  if (!(first > 1.0 + kClearGap * standard_error)) return {};
  std::vector<ExplainedCause> explained;
  std::vector<std::size_t> beside, left(causes.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  LineSolution before = nominal;
  while (!left.empty()) {
    // Of the remaining causes, the one that leaves the smallest gap.
    std::optional<LineSolution> best;
    std::size_t which = 0;
    for (std::size_t t = 0; t < left.size(); ++t) {
      std::vector<std::size_t> with = beside;
      with.push_back(left[t]);
      LineSolution solution = solve_lines(data, terms_of(causes, with));
      if (best && !(gap_of_lines(solution, scatter) < gap_of_lines(*best, scatter))) continue;
      best = std::move(solution);
      which = t;
    }
    const double gap_before = gap_of_lines(before, scatter), gap = gap_of_lines(*best, scatter);
    explained.push_back(
        {causes[left[which]].id, (gap_before * gap_before - gap * gap) / (first * first - 1.0),
         share_interval(squares_of(nominal, scatter), squares_of(before, scatter), squares_of(*best, scatter)), gap});
    beside.push_back(left[which]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(which));
    before = std::move(*best);
  }
  return explained;
}

GapLevels line_levels(const std::vector<TableLine>& lines, const LineData& data, const LineSolution& nominal,
                      const OwnScatter& scatter, double standard_error) {
  GapLevels levels;
  levels.all = gap_of_lines(nominal, scatter);
  const std::vector<LineCause> own = own_of_each_configuration(lines, data);
  if (own.empty()) return levels;
  levels.configuration = gap_of_lines(solve_lines(data, terms_of(own, {0, 1})), scatter);
  levels.holds_within =
      levels.all > 1.0 + kClearGap * standard_error && holds_within(*levels.configuration, levels.all);
  return levels;
}

namespace {

/// A value and its derivatives with respect to all fitted parameters.
struct Derived {
  double value = 0.0;
  Eigen::VectorXd by;
};

}  // namespace

std::vector<DiagnosedParameter> own_of_cells(const LineData& data, const LineCause& cause, const LineSolution& with,
                                             std::size_t first) {
  const Eigen::Index common = cause.drag ? 0 : data.base_log_k.cols() + data.base_a0.cols() - 1;
  const Eigen::Index own = data.base_log_k.cols() + data.base_a0.cols() + static_cast<Eigen::Index>(first);
  const auto as = [&](std::string key, const Derived& of) {
    const double variance = of.by.dot(base::product(with.covariance, of.by).col(0));
    return DiagnosedParameter{std::move(key), of.value, std::sqrt(std::max(0.0, variance))};
  };
  std::vector<Derived> values;
  Derived spread{0.0, Eigen::VectorXd::Zero(with.all.size())};
  double mean = 0.0;
  for (std::size_t c = 0; c < cause.cells.size(); ++c) {
    Derived one{with.all[common], Eigen::VectorXd::Unit(with.all.size(), common)};
    if (c > 0) {
      const Eigen::Index at = own + static_cast<Eigen::Index>(c) - 1;
      one.value += with.all[at];
      one.by[at] = 1.0;
    }
    if (cause.drag) {
      one.value = std::exp(one.value);
      one.by *= one.value;
    }
    mean += one.value / static_cast<double>(cause.cells.size());
    values.push_back(std::move(one));
  }
  const double freedom = static_cast<double>(values.size()) - 1.0;
  double square = 0.0;
  for (const Derived& one : values) {
    square += (one.value - mean) * (one.value - mean) / freedom;
    spread.by += (one.value - mean) / freedom * one.by;
  }
  spread.value = std::sqrt(square);
  if (spread.value > 0.0) spread.by /= spread.value;
  std::vector<DiagnosedParameter> told = {as(cause.drag ? "sd_n_s_m" : "sd", spread)};
  for (std::size_t c = 0; c < values.size(); ++c) {
    told.push_back(as((cause.drag ? "k_n_s_m." : "mu.") + cause.cells[c].name, values[c]));
  }
  return told;
}

std::vector<GapRegion> line_regions(const std::vector<TableLine>& lines, const LineData& data,
                                    const LineSolution& nominal, const OwnScatter& scatter) {
  std::vector<GapRegion> regions;
  if (!scatter.known()) return regions;
  const Eigen::MatrixXd leaves_a = leaves(data.base_a0), leaves_k = leaves(data.base_log_k);
  const double drag = drag_of(lines);
  const auto look = [&](GapVariable variable, double TableLine::*member, double value, int direction) {
    Eigen::VectorXd group(data.a0.size());
    for (Eigen::Index i = 0; i < group.size(); ++i) {
      const TableLine& line = lines[static_cast<std::size_t>(i)];
      group[i] = line.*member == value && (direction == 0 || line.direction == direction) ? 1.0 : 0.0;
    }
    if (!(group.sum() > 0.0)) return;
    const bool slopes = direction == 0;
    const Mean mean = slopes ? mean_of(nominal.off_k, leaves_k, group, scatter.slope)
                             : mean_of(nominal.off_a, leaves_a, group, scatter.intercept_m_s2);
    if (!(mean.sd > 0.0) || std::abs(mean.value) < kLeastOff_sd * mean.sd) return;
    GapRegion region{variable,           value, value, std::abs(mean.value) / mean.sd, mean.value, "m/s²",
                     GapKind::intercept, ""};
    region.size_sd = mean.sd;
    region.direction = direction;
    if (slopes) {
      region.what = GapKind::drag;
      region.unit = "N s/m";
      region.size *= drag;
      *region.size_sd *= drag;
    }
    regions.push_back(region);
  };
  for (const int direction : {-1, 1, 0}) {
    for (const double mass : different(lines, &TableLine::mass_kg)) {
      look(GapVariable::mass, &TableLine::mass_kg, mass, direction);
    }
    for (const double incline : different(lines, &TableLine::incline_deg)) {
      look(GapVariable::set_up, &TableLine::incline_deg, incline, direction);
    }
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const GapRegion& a, const GapRegion& b) { return a.excess > b.excess; });
  return regions;
}

std::vector<LineOff> lines_off(const std::vector<TableLine>& lines, const LineSolution& nominal) {
  std::vector<LineOff> off;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const TableLine& line = lines[i];
    const auto at = static_cast<Eigen::Index>(i);
    off.push_back({line.mass_kg, line.incline_deg, line.direction, line.k_over_m_1_s,
                   -line.direction * nominal.off_a[at], nominal.off_k[at]});
  }
  return off;
}

LineCurve line_curve(const std::vector<TableLine>& lines, const LineData& data, const LineCause& cause,
                     const LineSolution& with) {
  LineCurve curve{cause.id, {}, {}, {}};
  const OnLines& on_lines = effect_of(cause.id).lines;
  if (on_lines.change == nullptr || on_lines.change({1.0, 1.0, 0.0, 1.0}).of_log_k != 0.0) return curve;
  // The part that the term takes from mu is removed with it: the part of its column that the nominal model would have
  // fitted.
  const Eigen::VectorXd fitted = base::least_squares(data.base_a0, cause.terms.front().of_a0).col(0);
  const double taken = fitted[fitted.size() - 1] * -data.base_a0.col(data.base_a0.cols() - 1).cwiseAbs().mean();
  const std::vector<double> masses = different(lines, &TableLine::mass_kg);
  const double drag = drag_of(lines), from = 1.0 / masses.back(), to = 1.0 / masses.front();
  for (int i = 0; i <= kPoints; ++i) {
    const double mass = 1.0 / (from + (to - from) * (1.1 * i / kPoints - 0.05));
    const double k = drag / mass, column = -on_lines.change({mass, 1.0, 0.0, k}).of_a0_m_s2;
    curve.mass_kg.push_back(mass);
    curve.k_over_m_1_s.push_back(k);
    curve.friction_m_s2.push_back(with.size[0] * (column + taken));
  }
  return curve;
}

}  // namespace glidelab::diagnose
