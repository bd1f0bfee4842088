#include "diagnose/lines/line_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <utility>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "base/text/csv.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSmallest = 1e-6, kLargest = 1e6;  // kg, m/s², 1/s: beyond all tables, and their squares remain finite

}  // namespace

std::vector<TableLine> read_lines(const std::filesystem::path& file) {
  const base::CsvTable table =
      base::read_csv(file, {"mass_kg", "incline_deg", "direction", "a0_m_s2", "k_over_m_1_s"}, {"r2"}, true);
  std::vector<TableLine> lines;
  std::vector<base::Issue> issues;
  const auto& mass = table.column("mass_kg");
  const auto& incline = table.column("incline_deg");
  const auto& direction = table.column("direction");
  const auto& a0 = table.column("a0_m_s2");
  const auto& k = table.column("k_over_m_1_s");
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto wrong = [&](const char* key, double value, const char* expected) {
      issues.push_back({file.string(), table.line[i], key, fmt::format("{}", value), expected});
    };
    if (!(mass[i] >= kSmallest && mass[i] <= kLargest)) wrong("mass_kg", mass[i], "a number from 1e-6 to 1e6");
    if (!(std::abs(incline[i]) < 90.0)) wrong("incline_deg", incline[i], "an angle between -90 and 90");
    if (direction[i] != 1.0 && direction[i] != -1.0) wrong("direction", direction[i], "1 or -1, the sign of v");
    if (!(std::abs(a0[i]) <= kLargest)) wrong("a0_m_s2", a0[i], "a number from -1e6 to 1e6");
    if (!(k[i] >= kSmallest && k[i] <= kLargest)) wrong("k_over_m_1_s", k[i], "a number from 1e-6 to 1e6");
    lines.push_back({mass[i], incline[i], direction[i] > 0.0 ? 1 : -1, a0[i], k[i], table.last_digit_of("a0_m_s2"),
                     table.last_digit_of("k_over_m_1_s")});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (lines.size() < kFewestLines) throw base::InputError(too_few_lines(file.string(), lines.size()));
  return lines;
}

namespace {

/// The first line that is neither empty nor a comment names the lines' K/m. Only the head of a file is read.
bool is_table_of_lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string head(64 * 1024, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  std::istringstream lines(head);
  std::string line;
  while (std::getline(lines, line)) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    return line.find("k_over_m_1_s") != std::string::npos;
  }
  return false;
}

}  // namespace

core::Experiment read_recording(const std::filesystem::path& path, const core::TrackFileOptions& bare) {
  if (!core::is_bare_track(path) || !is_table_of_lines(path)) return core::read_tracks(path, bare);
  if (!bare.column.empty() || bare.mass_kg || bare.incline_deg || !bare.runs.empty() || !bare.masses_kg.empty() ||
      !bare.mass_of_file.empty() || bare.gravity_sd_m_s2) {
    throw base::InputError(
        base::Issue{path.string(), 0, "--column, --mass, --masses, --incline, --runs, --gravity-sd", "a table of lines",
                    "none of them: the table has its masses and inclinations, and gravity is exact"});
  }
  core::Experiment experiment;
  experiment.folder = path.parent_path();
  experiment.file = path;
  experiment.name = path.stem().string();
  experiment.lines = path;
  experiment.gravity_m_s2 = bare.gravity_m_s2.value_or(experiment.gravity_m_s2);
  return experiment;
}

base::Issue too_few_lines(const std::string& file, std::size_t lines) {
  return {file, 0, "lines", fmt::format("{} of them", lines), fmt::format("{} or more", kFewestLines)};
}

std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member) {
  std::set<double> values;
  for (const TableLine& line : lines) values.insert(line.*member);
  return {values.begin(), values.end()};
}

namespace {

constexpr double kUnlimited = 1e9;  // a size that no table reaches

Eigen::Index count(const std::vector<TableLine>& lines) {
  return static_cast<Eigen::Index>(lines.size());
}

const TableLine& at(const std::vector<TableLine>& lines, Eigen::Index i) {
  return lines[static_cast<std::size_t>(i)];
}

bool contains(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Lines of one mass, of one set-up, or of one mass on one set-up.
std::vector<LineCell> cells_of(const std::vector<TableLine>& lines, LinesOver over) {
  std::map<std::pair<double, double>, LineCell> cells;
  for (Eigen::Index i = 0; i < count(lines); ++i) {
    const TableLine& line = at(lines, i);
    const std::string mass = fmt::format("{:.6g} g", 1e3 * line.mass_kg),
                      set_up = fmt::format("{:.6g}°", line.incline_deg);
    const auto key =
        std::pair(over == LinesOver::set_up ? 0.0 : line.mass_kg, over == LinesOver::mass ? 0.0 : line.incline_deg);
    LineCell& cell = cells[key];
    cell.name = over == LinesOver::mass ? mass : over == LinesOver::set_up ? set_up : mass + ", " + set_up;
    cell.lines.push_back(i);
  }
  std::vector<LineCell> list;
  for (auto& [key, cell] : cells) list.push_back(std::move(cell));
  return list;
}

/// A mu, or ln K, of each cell except the first, relative to the nominal one.
std::vector<LineTerm> own_terms(const LineData& data, const std::vector<LineCell>& cells, bool drag) {
  std::vector<LineTerm> terms;
  for (std::size_t c = 1; c < cells.size(); ++c) {
    LineTerm term{drag ? "log_k" : "mu", Eigen::VectorXd::Zero(data.a0.size()), Eigen::VectorXd::Zero(data.a0.size()),
                  true, kUnlimited};
    for (const Eigen::Index i : cells[c].lines) {
      if (drag) term.of_log_k[i] = 1.0;
      if (!drag) term.of_a0[i] = data.base_a0(i, data.base_a0.cols() - 1);
    }
    terms.push_back(std::move(term));
  }
  return terms;
}

/// Whether the nominal model reproduces the term almost completely, as with a single mass.
bool is_nominal(const LineData& data, const LineTerm& term) {
  const auto beside = [](const Eigen::MatrixXd& columns, const Eigen::VectorXd& of) {
    return (of - base::product(columns, base::least_squares(columns, of)).col(0)).squaredNorm();
  };
  // Of the term's square: what cos(alpha) of two set-ups, or the scatter of K/m, makes.
  constexpr double kMostOwnShare = 3e-3;
  return beside(data.base_log_k, term.of_log_k) <= kMostOwnShare * term.of_log_k.squaredNorm() &&
         beside(data.base_a0, term.of_a0) <= kMostOwnShare * term.of_a0.squaredNorm();
}

LineCause cause_of_one_size(const std::vector<TableLine>& lines, const EffectInfo& effect) {
  LineTerm term{std::string(effect.lines.key), Eigen::VectorXd(count(lines)), Eigen::VectorXd(count(lines)),
                effect.both_signs, effect.lines.largest};
  for (Eigen::Index i = 0; i < count(lines); ++i) {
    const TableLine& line = at(lines, i);
    const LineChange change =
        effect.lines.change({line.mass_kg, static_cast<double>(line.direction), line.a0_m_s2, line.k_over_m_1_s});
    term.of_log_k[i] = change.of_log_k;
    term.of_a0[i] = change.of_a0_m_s2;
  }
  return {std::string(effect.id), effect.stage, std::string(effect.words), {std::move(term)}};
}

/// All forms in which these lines differ, the finest last.
std::vector<LineCause> causes_of_own_sizes(const std::vector<TableLine>& lines, const LineData& data,
                                           const EffectInfo& effect) {
  const bool drag = effect.lines.own == OwnOfLines::drag;
  std::vector<LinesOver> forms;
  const bool masses = different(lines, &TableLine::mass_kg).size() > 1;
  const bool setups = different(lines, &TableLine::incline_deg).size() > 1;
  if (masses) forms.push_back(LinesOver::mass);
  if (setups) forms.push_back(LinesOver::set_up);
  if (masses && setups) forms.push_back(LinesOver::mass_and_set_up);
  std::vector<LineCause> causes;
  for (const LinesOver over : forms) {
    std::vector<LineCell> cells = cells_of(lines, over);
    std::vector<LineTerm> terms = own_terms(data, cells, drag);
    causes.push_back({std::string(effect.id), effect.stage, std::string(effect.words), std::move(terms),
                      1.0 / static_cast<double>(forms.size()), over, std::move(cells), drag});
  }
  return causes;
}

}  // namespace

std::vector<LineCause> line_causes(const std::vector<TableLine>& lines, const LineData& data,
                                   const std::vector<std::string>& without) {
  std::vector<LineCause> causes, own;
  for (const EffectInfo& effect : all_effects()) {
    if (contains(without, std::string(effect.id))) continue;
    if (effect.lines.change != nullptr) {
      LineCause cause = cause_of_one_size(lines, effect);
      if (!is_nominal(data, cause.terms.front())) causes.push_back(std::move(cause));
    }
    if (effect.lines.own == OwnOfLines::nothing) continue;
    for (LineCause& cause : causes_of_own_sizes(lines, data, effect)) own.push_back(std::move(cause));
  }
  // Effects on intercepts alone come first, and the parameters of each configuration last.
  std::stable_partition(causes.begin(), causes.end(),
                        [](const LineCause& cause) { return cause.terms.front().of_log_k.isZero(0.0); });
  std::move(own.begin(), own.end(), std::back_inserter(causes));
  return causes;
}

std::vector<LineCause> own_of_each_configuration(const std::vector<TableLine>& lines, const LineData& data) {
  std::vector<LineCause> causes;
  for (const EffectInfo& effect : all_effects()) {
    if (effect.lines.own == OwnOfLines::nothing) continue;
    std::vector<LineCause> forms = causes_of_own_sizes(lines, data, effect);
    if (!forms.empty()) causes.push_back(std::move(forms.back()));
  }
  return causes;
}

std::vector<std::string> same_on_lines_as(const std::vector<std::string>& named,
                                          const std::vector<std::string>& without) {
  std::vector<std::string> alike;
  for (const EffectInfo& effect : all_effects()) {
    if (contains(named, std::string(effect.lines.same_as))) alike.emplace_back(effect.id);
  }
  std::erase_if(alike, [&](const std::string& id) { return contains(without, id); });
  return alike;
}

namespace {

constexpr double kLeastLeft = 1e-6;                     // of lines with very many digits: log of K/m, and m/s²
constexpr double kRoundingVariance = 1.0 / 12.0;        // of one last digit's worth
constexpr double kSettled = 1e-9;                       // relative change of a scatter from one iteration to the next
constexpr double kFirstSd_k = 0.02, kFirstSd_a = 0.01;  // start of the iteration: relative, and m/s²
constexpr int kMostTurns = 50;                          // iterations that fit sizes and scatters in turn
constexpr double kLeastUnseen =
    0.05;  // of a line that the others leave undetermined; its held-out residual is divided by no less

std::optional<ImpossibleSize> impossible(const LineTerm& term, double size) {
  if (!term.both_signs && !(size > 0.0)) return ImpossibleSize{term.key, size, {}};
  if (std::abs(size) > term.largest) return ImpossibleSize{term.key, size, term.largest};
  return {};
}

/// Mean of the intercepts of one mass and set-up over both directions; empty if one is missing.
std::vector<double> means_over_directions(const std::vector<TableLine>& lines, double incline) {
  std::vector<double> means;
  for (const double mass : different(lines, &TableLine::mass_kg)) {
    double up = 0.0, down = 0.0, ups = 0.0, downs = 0.0;
    for (const TableLine& line : lines) {
      if (line.mass_kg != mass || line.incline_deg != incline) continue;
      (line.direction < 0 ? up : down) += line.a0_m_s2;
      (line.direction < 0 ? ups : downs) += 1.0;
    }
    if (ups > 0.0 && downs > 0.0) means.push_back(0.5 * (up / ups + down / downs));
  }
  return means;
}

double squares_about_mean(const std::vector<double>& values) {
  double mean = 0.0, sum = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

/// The number of terms of each kind of data; a term that acts on both counts half in each.
struct TermCounts {
  double log_k = 0.0, a0 = 0.0;
};

TermCounts term_counts(const std::vector<LineTerm>& terms) {
  TermCounts counts;
  for (const LineTerm& term : terms) {
    const double k = term.of_log_k.isZero(0.0) ? 0.0 : 1.0, a = term.of_a0.isZero(0.0) ? 0.0 : 1.0;
    counts.log_k += k / std::max(1.0, k + a);
    counts.a0 += a / std::max(1.0, k + a);
  }
  return counts;
}

double root_mean_square(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

}  // namespace

LineData line_data(const std::vector<TableLine>& lines, double g) {
  const std::vector<double> inclines = different(lines, &TableLine::incline_deg);
  const auto n = static_cast<Eigen::Index>(lines.size());
  LineData data{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::MatrixXd::Ones(n, 1),
                Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(inclines.size()) + 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const TableLine& line = lines[static_cast<std::size_t>(i)];
    data.log_k[i] = std::log(line.k_over_m_1_s * line.mass_kg);
    data.a0[i] = line.a0_m_s2;
    const auto at = std::find(inclines.begin(), inclines.end(), line.incline_deg) - inclines.begin();
    data.base_a0(i, at) = 1.0;
    data.base_a0(i, data.base_a0.cols() - 1) = -line.direction * g * std::cos(line.incline_deg * base::kRadPerDegree);
  }
  double of_k = 0.0, of_a = 0.0;  // squares of errors, relative ones of K/m
  for (const TableLine& line : lines) {
    of_k += std::pow(line.k_digit_1_s / line.k_over_m_1_s, 2) * kRoundingVariance / static_cast<double>(n);
    of_a += std::pow(line.a0_digit_m_s2, 2) * kRoundingVariance / static_cast<double>(n);
  }
  data.rounding_log_k = std::max(std::sqrt(of_k), kLeastLeft);
  data.rounding_a0 = std::max(std::sqrt(of_a), kLeastLeft);
  return data;
}

LineSolution solve_lines(const LineData& data, const std::vector<LineTerm>& terms) {
  const auto n = data.a0.size();
  const auto pk = data.base_log_k.cols(), pa = data.base_a0.cols(), pt = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(2 * n, pk + pa + pt);
  Eigen::VectorXd y(2 * n);
  x.block(0, 0, n, pk) = data.base_log_k;
  x.block(n, pk, n, pa) = data.base_a0;
  for (Eigen::Index t = 0; t < pt; ++t) {
    x.block(0, pk + pa + t, n, 1) = terms[static_cast<std::size_t>(t)].of_log_k;
    x.block(n, pk + pa + t, n, 1) = terms[static_cast<std::size_t>(t)].of_a0;
  }
  y << data.log_k, data.a0;
  LineSolution s;
  s.sd_k = kFirstSd_k;
  s.sd_a = kFirstSd_a;
  Eigen::VectorXd weight(2 * n), off, fit;
  const auto inverse_of = [&](const Eigen::VectorXd& weights) {
    const Eigen::MatrixXd wx = weights.asDiagonal() * x;
    Eigen::MatrixXd normal = base::transposed_product(wx, wx);
    const Eigen::VectorXd scale = (normal.diagonal().array() + 1e-300).sqrt().inverse();
    normal = scale.asDiagonal() * normal * scale.asDiagonal();
    normal.diagonal().array() += 1e-10;
    return Eigen::MatrixXd(scale.asDiagonal() * base::inverse_positive(normal) * scale.asDiagonal());
  };
  Eigen::MatrixXd inverse;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    weight << Eigen::VectorXd::Constant(n, 1.0 / s.sd_k), Eigen::VectorXd::Constant(n, 1.0 / s.sd_a);
    const Eigen::MatrixXd wx = weight.asDiagonal() * x;
    inverse = inverse_of(weight);
    fit = base::product(inverse, base::transposed_product(wx, Eigen::VectorXd(weight.cwiseProduct(y))));
    off = y - base::product(x, fit);
    const double sd_k = std::max(root_mean_square(off.head(n)), data.rounding_log_k);
    const double sd_a = std::max(root_mean_square(off.tail(n)), data.rounding_a0);
    const bool settled = std::abs(sd_k - s.sd_k) <= kSettled * sd_k && std::abs(sd_a - s.sd_a) <= kSettled * sd_a;
    s.sd_k = sd_k;
    s.sd_a = sd_a;
    if (settled) break;
  }
  s.off_k = off.head(n);
  s.off_a = off.tail(n);
  s.size = fit.tail(pt);
  s.all = fit;
  // With the degrees of freedom that the fit uses in each kind.
  const auto of_kind = term_counts(terms);
  const auto widened = [&](double sd, double parameters) {
    const auto values = static_cast<double>(n);
    return sd * std::sqrt(values / std::max(1.0, values - parameters));
  };
  weight << Eigen::VectorXd::Constant(n, 1.0 / widened(s.sd_k, static_cast<double>(pk) + of_kind.log_k)),
      Eigen::VectorXd::Constant(n, 1.0 / widened(s.sd_a, static_cast<double>(pa) + of_kind.a0));
  s.covariance = inverse_of(weight);
  s.sd = s.covariance.diagonal().tail(pt).cwiseSqrt();
  for (Eigen::Index t = 0; t < pt && !s.left_out; ++t) {
    s.left_out = impossible(terms[static_cast<std::size_t>(t)], s.size[t]);
  }
  // Each line predicted by the others: residual over 1 - leverage.
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd row_k = x.row(i).transpose() / s.sd_k, row_a = x.row(n + i).transpose() / s.sd_a;
    const double leverage_k = row_k.dot(base::product(inverse, row_k).col(0));
    const double leverage_a = row_a.dot(base::product(inverse, row_a).col(0));
    s.held_out_k.push_back(off[i] / std::max(kLeastUnseen, 1.0 - leverage_k));
    s.held_out_a.push_back(off[n + i] / std::max(kLeastUnseen, 1.0 - leverage_a));
  }
  return s;
}

OwnScatter own_scatter(const std::vector<TableLine>& lines) {
  double sum_a = 0.0, count_a = 0.0, sum_k = 0.0, count_k = 0.0;
  for (const double incline : different(lines, &TableLine::incline_deg)) {
    const std::vector<double> means = means_over_directions(lines, incline);
    sum_a += 2.0 * squares_about_mean(means);  // a mean of two has half the variance
    if (!means.empty()) count_a += static_cast<double>(means.size()) - 1.0;
  }
  for (const double mass : different(lines, &TableLine::mass_kg)) {
    std::vector<double> logs;
    for (const TableLine& line : lines) {
      if (line.mass_kg == mass) logs.push_back(std::log(line.k_over_m_1_s));
    }
    sum_k += squares_about_mean(logs);
    count_k += static_cast<double>(logs.size()) - 1.0;
  }
  return {count_a > 0.0 ? std::sqrt(sum_a / count_a) : 0.0, count_k > 0.0 ? std::sqrt(sum_k / count_k) : 0.0,
          static_cast<std::size_t>(count_a + count_k)};
}

double log_bayes_factor(double left, double nominal_left, double lines, double nominal_parameters, double terms) {
  const double freedom = lines - nominal_parameters;
  if (!(freedom > terms)) return 0.0;
  const double ratio = std::pow(left / nominal_left, 2);
  // Integral over ln g; equal steps are exact to rounding for a function that decays smoothly at both ends.
  constexpr double kFrom = -8.0, kTo = 45.0, kStep = 0.05;
  std::vector<double> logs;
  for (double u = kFrom; u < kTo; u += kStep) {
    const double g = std::exp(u);
    const double prior = 0.5 * std::log(lines / (2.0 * std::numbers::pi)) - 0.5 * u - 0.5 * lines / g;
    logs.push_back(prior + 0.5 * (freedom - terms) * std::log1p(g) - 0.5 * freedom * std::log1p(g * ratio));
  }
  return base::log_sum(logs) + std::log(kStep);
}

double log_line_evidence(const LineData& data, const std::vector<LineTerm>& terms, const LineSolution& with,
                         const LineSolution& nominal) {
  const auto [of_k, of_a] = term_counts(terms);
  const auto lines = static_cast<double>(data.a0.size());
  double sum = 0.0;
  if (of_k > 0.0) {
    sum += log_bayes_factor(with.sd_k, nominal.sd_k, lines, static_cast<double>(data.base_log_k.cols()), of_k);
  }
  if (of_a > 0.0) {
    sum += log_bayes_factor(with.sd_a, nominal.sd_a, lines, static_cast<double>(data.base_a0.cols()), of_a);
  }
  return sum;
}

double log_likelihood_gain_of(const LineSolution& with, const LineSolution& nominal) {
  return static_cast<double>(with.off_a.size()) * std::log(nominal.sd_k / with.sd_k * nominal.sd_a / with.sd_a);
}

double chi_square_of(const LineSolution& solution, const OwnScatter& scatter) {
  return solution.off_k.squaredNorm() / std::pow(scatter.slope, 2) +
         solution.off_a.squaredNorm() / std::pow(scatter.intercept_m_s2, 2);
}

double gap_of_line(const LineSolution& solution, const OwnScatter& scatter, std::size_t i) {
  return std::sqrt(0.5 * (std::pow(solution.held_out_k[i] / scatter.slope, 2) +
                          std::pow(solution.held_out_a[i] / scatter.intercept_m_s2, 2)));
}

double gap_of_lines(const LineSolution& solution, const OwnScatter& scatter) {
  double sum = 0.0;
  for (std::size_t i = 0; i < solution.held_out_a.size(); ++i) sum += std::pow(gap_of_line(solution, scatter, i), 2);
  return std::sqrt(sum / static_cast<double>(solution.held_out_a.size()));
}

}  // namespace glidelab::diagnose
