#include "diagnose/line_table.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/csv.h"
#include "base/dense.h"
#include "base/errors.h"
#include "diagnose/alike_effects.h"
#include "diagnose/clip_interval.h"
#include "diagnose/effect_list.h"
#include "diagnose/verdict_words.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1, kPriorUnnamed = 0.2;
constexpr double kSameEvidence = 3.0;
constexpr std::size_t kFewestLines = 6;
constexpr double kRegion = 3.0;     // log evidence from which a family of terms says where
constexpr double kReadAngle = 0.3;  // degrees: what a person reads off a plumb, where a table says nothing

/// What one term adds to ln(k) and to a0 of every line.
struct Term {
  std::string id, key, stage, words;
  Eigen::VectorXd of_k, of_a;
  bool both_signs = false;
  double largest = 0.0;
};

struct Data {
  Eigen::VectorXd log_k, a0;
  Eigen::MatrixXd base_k, base_a;  // the nominal model's columns
};

struct Solution {
  double log_evidence = 0.0;
  Eigen::VectorXd size, sd;  // of the terms
  Eigen::VectorXd off_k, off_a;
  double sd_k = 0.0, sd_a = 0.0;
  double gap = 0.0;  // held-out residuals over `noise`
  std::vector<double> held_out;
  bool allowed = true;
};

base::Issue too_few(const std::string& file, std::size_t lines) {
  return {file, 0, "lines", fmt::format("{} of them", lines), fmt::format("{} or more", kFewestLines)};
}

std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member) {
  std::set<double> values;
  for (const TableLine& line : lines) values.insert(line.*member);
  return {values.begin(), values.end()};
}

Data data_of(const std::vector<TableLine>& lines, double g) {
  const std::vector<double> inclines = different(lines, &TableLine::incline_deg);
  const auto n = static_cast<Eigen::Index>(lines.size());
  Data data{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::MatrixXd::Ones(n, 1),
            Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(inclines.size()) + 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const TableLine& line = lines[static_cast<std::size_t>(i)];
    data.log_k[i] = std::log(line.k_over_m_1_s * line.mass_kg);
    data.a0[i] = line.a0_m_s2;
    const auto at = std::find(inclines.begin(), inclines.end(), line.incline_deg) - inclines.begin();
    data.base_a(i, at) = 1.0;
    data.base_a(i, data.base_a.cols() - 1) =
        -line.direction * g * std::cos(line.incline_deg * std::numbers::pi / 180.0);
  }
  return data;
}

/// Weighted least squares of both kinds together; their errors from the residuals, in turn.
Solution solve(const Data& data, const std::vector<Term>& terms) {
  const auto n = data.a0.size();
  const auto pk = data.base_k.cols(), pa = data.base_a.cols(), pt = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(2 * n, pk + pa + pt);
  Eigen::VectorXd y(2 * n);
  x.block(0, 0, n, pk) = data.base_k;
  x.block(n, pk, n, pa) = data.base_a;
  for (Eigen::Index t = 0; t < pt; ++t) {
    x.block(0, pk + pa + t, n, 1) = terms[static_cast<std::size_t>(t)].of_k;
    x.block(n, pk + pa + t, n, 1) = terms[static_cast<std::size_t>(t)].of_a;
  }
  y << data.log_k, data.a0;
  Solution s;
  s.sd_k = 0.02;
  s.sd_a = 0.01;
  Eigen::VectorXd weight(2 * n), off;
  Eigen::MatrixXd inverse;
  Eigen::VectorXd fit;
  for (int turn = 0; turn < 50; ++turn) {
    weight << Eigen::VectorXd::Constant(n, 1.0 / s.sd_k), Eigen::VectorXd::Constant(n, 1.0 / s.sd_a);
    const Eigen::MatrixXd wx = weight.asDiagonal() * x;
    Eigen::MatrixXd normal = base::transposed_product(wx, wx);
    const Eigen::VectorXd scale = (normal.diagonal().array() + 1e-300).sqrt().inverse();
    normal = scale.asDiagonal() * normal * scale.asDiagonal();
    normal.diagonal().array() += 1e-10;
    inverse = scale.asDiagonal() * base::inverse_positive(normal) * scale.asDiagonal();
    fit = base::product(inverse, base::transposed_product(wx, Eigen::VectorXd(weight.cwiseProduct(y))));
    off = y - base::product(x, fit);
    s.sd_k = std::max(std::sqrt(off.head(n).squaredNorm() / static_cast<double>(n)), 1e-6);
    s.sd_a = std::max(std::sqrt(off.tail(n).squaredNorm() / static_cast<double>(n)), 1e-6);
  }
  const auto m = static_cast<double>(n);
  const auto parameters = static_cast<double>(pk + pa + pt);
  s.off_k = off.head(n);
  s.off_a = off.tail(n);
  s.size = fit.tail(pt);
  // With the degrees of freedom that the fit takes.
  const double inflate = std::sqrt(2.0 * m / std::max(1.0, 2.0 * m - parameters));
  s.sd = inverse.diagonal().tail(pt).cwiseSqrt() * inflate;
  for (Eigen::Index t = 0; t < pt; ++t) {
    const Term& term = terms[static_cast<std::size_t>(t)];
    if ((!term.both_signs && s.size[t] <= 0.0) || std::abs(s.size[t]) > term.largest) s.allowed = false;
  }
  // Each line predicted by the others: residual over 1 - leverage.
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::VectorXd row_k = x.row(i).transpose() / s.sd_k, row_a = x.row(n + i).transpose() / s.sd_a;
    const double leverage_k = row_k.dot(base::product(inverse, row_k).col(0));
    const double leverage_a = row_a.dot(base::product(inverse, row_a).col(0));
    const double of_k = off[i] / std::max(0.05, 1.0 - leverage_k), of_a = off[n + i] / std::max(0.05, 1.0 - leverage_a);
    s.held_out.push_back(of_k);
    s.held_out.push_back(of_a);
  }
  return s;
}

/// Of terms beside the nominal model, from what each leaves of one kind of data (header).
double log_bayes_factor(double left, double nominal_left, double lines, double nominal_parameters, double terms) {
  const double freedom = lines - nominal_parameters;
  if (!(freedom > terms)) return 0.0;  // as many parameters as lines say nothing
  return 0.5 * (freedom - terms) * std::log1p(lines) -
         0.5 * freedom * std::log1p(lines * left * left / (nominal_left * nominal_left));
}

/// Log evidence against nothing of both kinds together. A term that acts on both is half a one of each.
double log_evidence_of(const Data& data, const std::vector<Term>& terms, const Solution& with,
                       const Solution& nominal) {
  double of_k = 0.0, of_a = 0.0;
  for (const Term& term : terms) {
    const double k = term.of_k.isZero(0.0) ? 0.0 : 1.0, a = term.of_a.isZero(0.0) ? 0.0 : 1.0;
    of_k += k / std::max(1.0, k + a);
    of_a += a / std::max(1.0, k + a);
  }
  const auto lines = static_cast<double>(data.a0.size());
  double sum = 0.0;
  if (of_k > 0.0) {
    sum += log_bayes_factor(with.sd_k, nominal.sd_k, lines, static_cast<double>(data.base_k.cols()), of_k);
  }
  if (of_a > 0.0) {
    sum += log_bayes_factor(with.sd_a, nominal.sd_a, lines, static_cast<double>(data.base_a.cols()), of_a);
  }
  return sum;
}

std::vector<Term> terms_of(const std::vector<TableLine>& lines) {
  const auto n = static_cast<Eigen::Index>(lines.size());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd per_mass(n), square(n), inertia_k(n), inertia_a(n), sign(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const TableLine& line = lines[static_cast<std::size_t>(i)];
    sign[i] = line.direction;
    per_mass[i] = -line.direction / line.mass_kg;
    square[i] = -line.direction * line.k_over_m_1_s * line.k_over_m_1_s;
    inertia_k[i] = -1.0 / line.mass_kg;
    inertia_a[i] = -line.a0_m_s2 / line.mass_kg;
  }
  std::vector<Term> terms;
  terms.push_back({"load_independent_friction", "force_n", "dynamics",
                   "a dry friction that does not depend on the load", zero, per_mass, false, 1.0});
  terms.push_back({"smoothing_bias", "intercept_s2_m_s2", "analysis",
                   "the smoothing's own bias, which bends a(v) near v = 0 as (K/m)²", zero, square, false, 1.0});
  terms.push_back({"rotational_inertia", "mass_kg", "dynamics",
                   "inertia that is not in the weighed mass, such as wheels'", inertia_k, inertia_a, false, 0.3});
  return terms;
}

/// Terms without a name: friction, or drag, of each mass, set-up or direction by itself.
std::vector<std::pair<std::string, std::vector<Term>>> unnamed_of(const std::vector<TableLine>& lines) {
  const auto n = static_cast<Eigen::Index>(lines.size());
  std::vector<std::pair<std::string, std::vector<Term>>> families;
  const auto add = [&](const std::string& variable, double TableLine::*member, bool friction) {
    const std::vector<double> values = different(lines, member);
    std::vector<Term> terms;
    for (std::size_t v = 1; v < values.size(); ++v) {
      Term term{variable,
                friction ? "friction" : "drag",
                "dynamics",
                "",
                Eigen::VectorXd::Zero(n),
                Eigen::VectorXd::Zero(n),
                true,
                1e9};
      for (Eigen::Index i = 0; i < n; ++i) {
        const TableLine& line = lines[static_cast<std::size_t>(i)];
        if (line.*member != values[v]) continue;
        if (friction) term.of_a[i] = -line.direction;
        if (!friction) term.of_k[i] = 1.0;
      }
      terms.push_back(term);
    }
    if (!terms.empty()) families.emplace_back(variable, terms);
  };
  for (const bool friction : {true, false}) {
    add("mass_kg", &TableLine::mass_kg, friction);
    add("group", &TableLine::incline_deg, friction);
  }
  Term ways{"direction", "drag", "dynamics", "", Eigen::VectorXd(n), Eigen::VectorXd::Zero(n), true, 1e9};
  for (Eigen::Index i = 0; i < n; ++i) ways.of_k[i] = lines[static_cast<std::size_t>(i)].direction;
  families.emplace_back("direction", std::vector<Term>{ways});
  return families;
}

/// Scatter of a0 and ln(k) that no model of friction goes into: of the mean over both directions between masses of one
/// set-up, and of ln(k m) about the mean of each mass.
std::pair<double, double> own_scatter(const std::vector<TableLine>& lines, std::size_t& freedom) {
  double sum_a = 0.0, count_a = 0.0, sum_k = 0.0, count_k = 0.0;
  for (const double incline : different(lines, &TableLine::incline_deg)) {
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
    double mean = 0.0;
    for (const double value : means) mean += value / static_cast<double>(means.size());
    for (const double value : means)
      sum_a += 2.0 * (value - mean) * (value - mean);  // a mean of two has half the variance
    if (!means.empty()) count_a += static_cast<double>(means.size()) - 1.0;
  }
  for (const double mass : different(lines, &TableLine::mass_kg)) {
    std::vector<double> logs;
    for (const TableLine& line : lines) {
      if (line.mass_kg == mass) logs.push_back(std::log(line.k_over_m_1_s));
    }
    double mean = 0.0;
    for (const double value : logs) mean += value / static_cast<double>(logs.size());
    for (const double value : logs) sum_k += (value - mean) * (value - mean);
    count_k += static_cast<double>(logs.size()) - 1.0;
  }
  freedom = static_cast<std::size_t>(count_a + count_k);
  return {count_a > 0.0 ? std::sqrt(sum_a / count_a) : 0.0, count_k > 0.0 ? std::sqrt(sum_k / count_k) : 0.0};
}

double gap_of(const Solution& s, double sd_k, double sd_a) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.held_out.size(); ++i) sum += std::pow(s.held_out[i] / (i % 2 == 0 ? sd_k : sd_a), 2);
  return std::sqrt(sum / static_cast<double>(s.held_out.size()));
}

/// Over lines, each of which is held out by itself.
void add_intervals(GapSizes& gap) {
  std::vector<ClipSquares> before, after;
  for (const double one : gap.before_by_clip) before.push_back({one * one, 1.0});
  for (const double one : gap.after_by_clip) after.push_back({one * one, 1.0});
  gap.interval95.why_none = why_no_interval(before.size());
  gap.interval95.before = rms_interval(before);
  gap.interval95.after = rms_interval(after);
  if (gap.shrink) gap.interval95.shrink = shrink_interval(before, after);
}

struct Weighed {
  std::vector<std::size_t> terms;
  bool unnamed = false;
  std::string variable;
  Solution solution;
  double probability = 0.0;
};

void join_sets(const std::vector<Term>& terms, const std::vector<Weighed>& all, Diagnosis& diagnosis) {
  std::vector<NamedExplanation> named;
  for (const Weighed& w : all) {
    if (w.unnamed) continue;
    NamedExplanation& one = named.emplace_back(NamedExplanation{{}, w.probability});
    for (const std::size_t t : w.terms) one.ids.push_back(terms[t].id);
  }
  const auto words = [&](const std::string& id) {
    const auto term = std::find_if(terms.begin(), terms.end(), [&](const Term& t) { return t.id == id; });
    return term != terms.end() ? term->words : std::string(effect_list()[effect_index(id)].words);
  };
  join_alike(named, words, diagnosis);
}

std::string next_of(const std::vector<TableLine>& lines, const Solution& friction, const Solution& bias) {
  const std::vector<double> masses = different(lines, &TableLine::mass_kg);
  double k = 0.0;
  for (const TableLine& line : lines) k += line.k_over_m_1_s * line.mass_kg / static_cast<double>(lines.size());
  const double f = friction.size.size() > 0 ? friction.size[0] : 0.0, c = bias.size.size() > 0 ? bias.size[0] : 0.0;
  const double heavy = 3.0 * masses.back();
  return fmt::format(
      "Analyse the same clips with half and with twice the kernel's width: a smoothing bias changes with its square, a "
      "friction force does not change. Or record a glider of {:.0f} g both ways: a friction force of {:.2g} N moves "
      "its "
      "intercepts by {:.2g} m/s² each, the smoothing bias by {:.2g} m/s².",
      1000.0 * heavy, f, f / heavy, c * std::pow(k / heavy, 2));
}

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
    if (!(mass[i] > 0.0)) wrong("mass_kg", mass[i], "a number above 0");
    if (!(std::abs(incline[i]) < 90.0)) wrong("incline_deg", incline[i], "an angle between -90 and 90");
    if (direction[i] != 1.0 && direction[i] != -1.0) wrong("direction", direction[i], "1 or -1, the sign of v");
    if (!(k[i] > 0.0)) wrong("k_over_m_1_s", k[i], "a number above 0");
    lines.push_back({mass[i], incline[i], direction[i] > 0.0 ? 1 : -1, a0[i], k[i]});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (lines.size() < kFewestLines) throw base::InputError(too_few(file.string(), lines.size()));
  return lines;
}

Diagnosis diagnose_lines(const std::vector<TableLine>& lines, double g) {
  if (lines.size() < kFewestLines) throw base::InputError(too_few("", lines.size()));
  const Data data = data_of(lines, g);
  std::vector<Term> terms = terms_of(lines);
  const bool masses = different(lines, &TableLine::mass_kg).size() > 1;
  if (!masses) terms.clear();  // with one mass they are K and mu themselves
  std::vector<Weighed> all;
  all.push_back({{}, false, "", solve(data, {}), kPriorNone});
  const Solution nominal = all.front().solution;
  const auto solved = [&](const std::vector<Term>& with) {
    Solution solution = solve(data, with);
    solution.log_evidence = log_evidence_of(data, with, solution, nominal);
    return solution;
  };
  const auto one = static_cast<double>(std::max<std::size_t>(1, terms.size()));
  for (std::size_t t = 0; t < terms.size(); ++t) {
    all.push_back({{t}, false, "", solved({terms[t]}), kPriorOne / one});
    for (std::size_t u = 0; u < t; ++u) {
      all.push_back({{u, t}, false, "", solved({terms[u], terms[t]}), kPriorTwo / (0.5 * one * (one - 1.0))});
    }
  }
  const auto families = unnamed_of(lines);
  for (const auto& [variable, family] : families) {
    all.push_back({{}, true, variable, solved(family), kPriorUnnamed / static_cast<double>(families.size())});
  }
  double sum = 0.0, most = 0.0;
  for (const Weighed& w : all) most = std::max(most, w.solution.log_evidence);
  for (Weighed& w : all) {
    w.probability *= w.solution.allowed ? std::exp(w.solution.log_evidence - most) : 0.0;
    sum += w.probability;
  }
  for (Weighed& w : all) w.probability /= sum;

  Diagnosis diagnosis;
  std::size_t freedom = 0;
  const std::pair<double, double> scatter = own_scatter(lines, freedom);
  const double sd_a = scatter.first, sd_k = scatter.second;
  const Weighed* best = nullptr;
  for (const Weighed& w : all) {
    if (w.unnamed) diagnosis.unknown += w.probability;
    if (!w.unnamed && w.terms.empty()) diagnosis.none += w.probability;
    if (w.unnamed || w.terms.empty()) continue;
    std::string id;
    for (const std::size_t t : w.terms) id += (id.empty() ? "" : " + ") + terms[t].id;
    diagnosis.ranking.push_back(
        {id, w.probability, w.solution.allowed ? w.solution.log_evidence : 0.0, 0.0, w.terms.size(), {}});
    if (best == nullptr || w.probability > best->probability) best = &w;
  }
  std::stable_sort(diagnosis.ranking.begin(), diagnosis.ranking.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  diagnosis.verdict = verdict_by(diagnosis.none, diagnosis.unknown);
  if (diagnosis.verdict == "effect" && best != nullptr) {
    for (std::size_t k = 0; k < best->terms.size(); ++k) {
      const Term& term = terms[best->terms[k]];
      DiagnosedEffect effect{term.id, term.stage, term.words, 0.0, {}, {}};
      const auto at = static_cast<Eigen::Index>(k);
      effect.parameters.push_back({term.key, best->solution.size[at], best->solution.sd[at]});
      for (const Weighed& w : all) {
        if (w.unnamed) continue;
        if (std::find(w.terms.begin(), w.terms.end(), best->terms[k]) != w.terms.end())
          effect.probability += w.probability;
        const bool single = w.terms.size() == 1 && best->terms.size() == 1 && w.terms != best->terms;
        if (single && w.solution.allowed && w.solution.log_evidence > best->solution.log_evidence - kSameEvidence) {
          effect.equivalent_to.push_back(terms[w.terms.front()].id);
        }
      }
      // About the typical speed V the bend of a rolled-off drag is a force of 2 K V³/v_c², opposed to the motion.
      if (term.id == "load_independent_friction") effect.equivalent_to.emplace_back("eddy_rolloff");
      diagnosis.effects.push_back(effect);
    }
    join_sets(terms, all, diagnosis);
    diagnosis.stage = diagnosis.effects.front().stage;
  }
  const auto by = [](const Weighed& a, const Weighed& b) {
    return (a.unnamed ? a.solution.log_evidence : -1e300) < (b.unnamed ? b.solution.log_evidence : -1e300);
  };
  const Weighed& family = *std::max_element(all.begin(), all.end(), by);
  if (diagnosis.verdict != "none" && family.solution.log_evidence > kRegion && family.solution.size.size() > 0) {
    Eigen::Index at = 0;
    const double excess = (family.solution.size.cwiseAbs().cwiseQuotient(family.solution.sd)).maxCoeff(&at);
    const auto values =
        family.variable == "mass_kg" ? different(lines, &TableLine::mass_kg) : std::vector<double>{0.0, 1.0};
    diagnosis.regions.push_back(
        {family.variable, values.front(), values.back(), excess, family.solution.size[at], "m/s²", "friction", ""});
    if (diagnosis.verdict == "unknown") diagnosis.stage = "dynamics";
  }
  if (sd_a > 0.0 && sd_k > 0.0) {
    GapSizes gap;
    gap.before = gap_of(all.front().solution, sd_k, sd_a);
    gap.after = diagnosis.verdict == "effect" && best != nullptr ? gap_of(best->solution, sd_k, sd_a) : gap.before;
    gap.standard_error = std::sqrt(0.5 / static_cast<double>(lines.size()) + 0.5 / static_cast<double>(freedom));
    if (gap.before > 1.0 + gap.standard_error) gap.shrink = (gap.before - gap.after) / (gap.before - 1.0);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      gap.held_out.push_back(fmt::format("{:.0f} g, {} deg, v {} 0", 1000.0 * lines[i].mass_kg, lines[i].incline_deg,
                                         lines[i].direction > 0 ? ">" : "<"));
      const auto of = [&](const Solution& s) {
        return std::sqrt(0.5 * (std::pow(s.held_out[2 * i] / sd_k, 2) + std::pow(s.held_out[2 * i + 1] / sd_a, 2)));
      };
      gap.before_by_clip.push_back(of(all.front().solution));
      gap.after_by_clip.push_back(
          of(diagnosis.verdict == "effect" && best != nullptr ? best->solution : all.front().solution));
    }
    add_intervals(gap);
    for (const double incline : different(lines, &TableLine::incline_deg)) {
      double mean = 0.0, count = 0.0;
      for (const TableLine& line : lines) {
        if (line.incline_deg != incline) continue;
        mean += line.a0_m_s2;
        count += 1.0;
      }
      const double degrees = std::asin(std::clamp(mean / count / g, -1.0, 1.0)) * 180.0 / std::numbers::pi;
      const double z = (degrees - incline) / kReadAngle;
      gap.parameters.push_back({"alpha_deg", "stated", fmt::format("{} deg", incline), z, z});
      diagnosis.notes.push_back(
          fmt::format("Lines stated at {} degrees have a mean intercept of {:.3f} degrees; a table does not say how "
                      "well the angle was "
                      "read ({} degrees are taken).",
                      incline, degrees, kReadAngle));
    }
    diagnosis.gap = gap;
  }
  if (terms.size() >= 2) diagnosis.next_experiment = next_of(lines, all[1].solution, solve(data, {terms[1]}));
  if (terms.empty()) diagnosis.next_experiment = "Record a second mass: with one, a friction force is simply mu.";
  diagnosis.notes.push_back(fmt::format(
      "A table of {} lines: their errors are not stated and are taken from their scatter; the speeds that they rest on "
      "are "
      "not known, so that effects of the speed (quadratic_drag, power_law_drag, stribeck) cannot be weighed.",
      lines.size()));
  diagnosis.summary = summary_of(diagnosis);
  return diagnosis;
}

}  // namespace glidelab::diagnose
