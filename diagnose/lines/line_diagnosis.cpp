#include "diagnose/lines/line_diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/effects/effect_library.h"
#include "diagnose/lines/line_findings.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSameLineEvidence = 3.0;  // log evidence within which effects share it

void check_names(const std::vector<std::string>& without) {
  const std::vector<std::string> known = effect_words();
  for (const std::string& id : without) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    throw base::InputError(
        base::Issue{"", 0, "without", fmt::format("\"{}\"", id), fmt::format("one of {}", fmt::join(known, ", "))});
  }
}

Explanation explanation_of(const LineExplanation& lines, const std::vector<LineTerm>& terms) {
  Explanation explanation;
  for (const std::size_t t : lines.named) explanation.effects.push_back(terms[t].id);
  explanation.unnamed = lines.family.has_value();
  return explanation;
}

LineCandidate candidate_of(const LineExplanation& explanation, const std::vector<LineTerm>& terms,
                           const std::vector<LineFamily>& families, const LineSolution& nominal,
                           const OwnScatter& scatter) {
  const LineSolution& solution = explanation.solution;
  LineCandidate candidate{explanation_of(explanation, terms),
                          explanation.family ? std::optional(families[*explanation.family].of) : std::nullopt,
                          explanation.probability,
                          explanation.log_evidence,
                          log_likelihood_gain_of(solution, nominal),
                          static_cast<std::size_t>(solution.size.size()),
                          {},
                          {},
                          {},
                          solution.left_out};
  for (std::size_t t = 0; t < explanation.named.size(); ++t) {
    const auto at = static_cast<Eigen::Index>(t);
    candidate.sizes.push_back({terms[explanation.named[t]].key, solution.size[at], solution.sd[at]});
  }
  if (scatter.known()) {
    candidate.chi2 = chi_square_of(solution, scatter);
    candidate.gap = gap_of_lines(solution, scatter);
  }
  return candidate;
}

/// Everything that was weighed, in the order of the explanations.
LineComparison comparison_of(const std::vector<LineExplanation>& all, const std::vector<LineTerm>& terms,
                             const std::vector<LineFamily>& families, const OwnScatter& scatter) {
  LineComparison lines;
  lines.intercept_sd_m_s2 = scatter.intercept_m_s2;
  lines.slope_sd = scatter.slope;
  lines.scatter_freedom = scatter.freedom;
  for (const LineExplanation& e : all) {
    lines.candidates.push_back(candidate_of(e, terms, families, all.front().solution, scatter));
  }
  return lines;
}

/// Single effects whose evidence is that of the best explanation with a name, which comes first; empty where it is a
/// pair.
std::vector<std::size_t> equals_of(const LineExplanation& best, const std::vector<LineExplanation>& all) {
  if (best.named.size() != 1) return {};
  std::vector<std::size_t> equals = best.named;
  for (const LineExplanation& e : all) {
    if (e.family || e.named.size() != 1 || e.named == best.named || e.solution.left_out) continue;
    if (e.log_evidence > best.log_evidence - kSameLineEvidence) equals.push_back(e.named.front());
  }
  return equals;
}

std::vector<DiagnosedEffect> effects_of(const LineExplanation& best, const std::vector<LineExplanation>& all,
                                        const std::vector<LineTerm>& terms, const std::vector<std::size_t>& equals,
                                        const std::vector<std::string>& without) {
  std::vector<DiagnosedEffect> effects;
  for (std::size_t k = 0; k < best.named.size(); ++k) {
    const LineTerm& term = terms[best.named[k]];
    const auto at = static_cast<Eigen::Index>(k);
    DiagnosedEffect effect{term.id, term.stage, term.words,
                           0.0,     {},         {{term.key, best.solution.size[at], best.solution.sd[at]}}};
    if (term.id == ids::smoothing_bias) {
      constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
      effect.parameters.push_back(
          {"bandwidth_s", kNan, kNan,
           "a table says neither how wide the kernel was nor which stretch each line was fitted to"});
    }
    for (const LineExplanation& e : all) {
      const bool holds = std::find(e.named.begin(), e.named.end(), best.named[k]) != e.named.end();
      if (holds && !e.family) effect.probability += e.probability;
    }
    bool force = term.id == ids::load_independent_friction;
    for (std::size_t t = 1; t < equals.size(); ++t) {
      effect.equivalent_to.push_back(terms[equals[t]].id);
      force = force || terms[equals[t]].id == ids::load_independent_friction;
    }
    if (force) {
      for (const std::string& id : alike_friction_force(without)) effect.equivalent_to.push_back(id);
    }
    effects.push_back(effect);
  }
  return effects;
}

void join_sets(const std::vector<LineTerm>& terms, const std::vector<LineExplanation>& all, Diagnosis& diagnosis) {
  std::vector<NamedExplanation> named;
  for (const LineExplanation& e : all) {
    if (e.family) continue;
    named.push_back({explanation_of(e, terms).effects, e.probability});
  }
  const auto words = [&](const std::string& id) {
    const auto term = std::find_if(terms.begin(), terms.end(), [&](const LineTerm& t) { return t.id == id; });
    return term != terms.end() ? term->words : std::string(effect_list()[effect_index(id)].words);
  };
  join_alike(named, words, diagnosis);
}

/// The term's size where nothing else is added, or its standard deviation where that is more: what may be there.
double size_by_itself(const LineData& data, const std::vector<LineTerm>& terms, const std::string& id) {
  for (const LineTerm& term : terms) {
    if (term.id != id) continue;
    const LineSolution alone = solve_lines(data, {term});
    return std::max(std::abs(alone.size[0]), alone.sd[0]);
  }
  return 0.0;
}

/// The likeliest explanation with a name and the likeliest without; nothing where there is none.
struct Leaders {
  const LineExplanation* named = nullptr;
  const LineExplanation* unnamed = nullptr;
};

Leaders leaders_of(const std::vector<LineExplanation>& all) {
  Leaders leaders;
  for (const LineExplanation& e : all) {
    if (!e.family && e.named.empty()) continue;
    const LineExplanation*& leader = e.family ? leaders.unnamed : leaders.named;
    if (leader == nullptr || e.probability > leader->probability) leader = &e;
  }
  return leaders;
}

constexpr double kHalf = 0.5;         // of the gap
constexpr double kLeastShare = 0.02;  // of it: less is no cause that a person would look for

/// The share of each cause that the likeliest name has; where the cause is unknown, of those that help, less than half
/// together.
std::vector<ExplainedCause> shares_of(const LineExplanation& named, const LineData& data,
                                      const std::vector<LineTerm>& terms, const LineSolution& nominal,
                                      const OwnScatter& scatter, const Diagnosis& diagnosis) {
  std::vector<LineTerm> causes;
  for (const std::size_t t : named.named) causes.push_back(terms[t]);
  std::vector<ExplainedCause> explained = explained_by(data, causes, nominal, scatter, diagnosis.gap->standard_error);
  if (diagnosis.verdict == Verdict::effect) return explained;
  double sum = 0.0;
  const auto no_help = std::find_if(explained.begin(), explained.end(), [&](const ExplainedCause& cause) {
    return !(cause.share > kLeastShare) || (sum += cause.share) >= kHalf;
  });
  explained.erase(no_help, explained.end());
  return explained;
}

/// The probabilities of nothing and of what has no name, the verdict that they give, and the ranking of the rest.
void weigh_up(const std::vector<LineExplanation>& all, LineComparison& table, Diagnosis& diagnosis) {
  for (std::size_t e = 0; e < all.size(); ++e) {
    if (all[e].family) {
      diagnosis.unknown += all[e].probability;
    } else if (all[e].named.empty()) {
      diagnosis.none += all[e].probability;
    } else {
      const LineCandidate& c = table.candidates[e];
      diagnosis.ranking.push_back(
          {c.explanation, c.probability, c.log_evidence_gain, c.log_likelihood_gain, c.terms, c.gap, c.left_out});
    }
  }
  const auto likelier = [](const auto& a, const auto& b) {
    return a.left_out.has_value() != b.left_out.has_value() ? !a.left_out : a.probability > b.probability;
  };
  std::stable_sort(diagnosis.ranking.begin(), diagnosis.ranking.end(), likelier);
  std::stable_sort(table.candidates.begin(), table.candidates.end(), likelier);
  diagnosis.verdict = verdict_by(diagnosis.none, diagnosis.unknown);
}

/// Which effects a table does not tell apart, and the probability that it is one or several of them.
void tell_either(const std::vector<LineExplanation>& all, const std::vector<LineTerm>& terms,
                 const std::vector<std::size_t>& equals, LineComparison& table) {
  if (equals.size() < 2) return;
  for (const std::size_t t : equals) table.either_of.push_back(terms[t].id);
  for (const LineExplanation& e : all) {
    const bool only = !e.named.empty() && std::all_of(e.named.begin(), e.named.end(), [&](std::size_t t) {
      return std::find(equals.begin(), equals.end(), t) != equals.end();
    });
    if (only && !e.family) table.either_probability += e.probability;
  }
}

std::vector<LineCurve> curves_of(const std::vector<TableLine>& lines, const LineData& data,
                                 const std::vector<LineTerm>& terms, const std::vector<LineExplanation>& all) {
  std::vector<LineCurve> curves;
  for (const LineExplanation& e : all) {
    if (e.named.size() != 1 || e.family || e.solution.left_out) continue;
    LineCurve curve = line_curve(lines, data, terms[e.named.front()], e.solution);
    if (!curve.mass_kg.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

/// What would decide between a friction force and a smoothing bias.
NextStep next_of(const std::vector<TableLine>& lines, const LineData& data) {
  const std::vector<double> masses = different(lines, &TableLine::mass_kg);
  if (masses.size() < 2) return Routine::second_mass;
  const std::vector<LineTerm> every = named_terms(lines, {});
  const double force_n = size_by_itself(data, every, ids::load_independent_friction);
  const double bias_s2_m_s2 = size_by_itself(data, every, ids::smoothing_bias);
  double drag = 0.0;
  for (const TableLine& line : lines) drag += line.k_over_m_1_s * line.mass_kg / static_cast<double>(lines.size());
  const double heavy = 3.0 * masses.back();
  return TellLinesApart{heavy, force_n, force_n / heavy, bias_s2_m_s2 * (drag / heavy) * (drag / heavy)};
}

}  // namespace

Diagnosis diagnose_lines(const std::vector<TableLine>& lines, double g, const std::vector<std::string>& without) {
  check_names(without);
  if (lines.size() < kFewestLines) throw base::InputError(too_few_lines("", lines.size()));
  const LineData data = line_data(lines, g);
  const std::vector<LineTerm> terms = named_terms(lines, without);
  const std::vector<LineFamily> families = unnamed_line_families(lines);
  const std::vector<LineExplanation> all = weigh_lines(data, terms, families);
  const LineSolution& nominal = all.front().solution;
  const OwnScatter scatter = own_scatter(lines);
  const Leaders leaders = leaders_of(all);

  Diagnosis diagnosis;
  LineComparison table = comparison_of(all, terms, families, scatter);
  table.lines = lines.size();
  table.chi2_before = table.candidates.front().chi2;
  weigh_up(all, table, diagnosis);
  const bool is_effect = diagnosis.verdict == Verdict::effect, is_unknown = diagnosis.verdict == Verdict::unknown;
  if (leaders.named != nullptr && leaders.named->probability > 0.0 && diagnosis.verdict != Verdict::none) {
    const std::vector<std::size_t> equals = equals_of(*leaders.named, all);
    tell_either(all, terms, equals, table);
    if (is_effect) diagnosis.effects = effects_of(*leaders.named, all, terms, equals, without);
  }
  join_sets(terms, all, diagnosis);
  if (is_effect) diagnosis.stage = diagnosis.effects.front().stage;
  if (is_unknown) diagnosis.stage = Stage::dynamics;
  if (is_effect || is_unknown) diagnosis.regions = line_regions(lines, data, nominal, scatter);
  if (scatter.known()) {
    const LineSolution& after = is_effect ? leaders.named->solution : is_unknown ? leaders.unnamed->solution : nominal;
    LineGap gap = line_gap(lines, g, nominal, after, scatter);
    diagnosis.gap = std::move(gap.sizes);
    diagnosis.notes = std::move(gap.notes);
    diagnosis.isolability = line_isolability(data, terms, scatter.slope, scatter.intercept_m_s2);
    if (leaders.named != nullptr && (is_effect || is_unknown)) {
      diagnosis.explained = shares_of(*leaders.named, data, terms, nominal, scatter, diagnosis);
    }
  }
  table.off = lines_off(lines, nominal);
  table.curves = curves_of(lines, data, terms, all);
  diagnosis.next = next_of(lines, data);
  diagnosis.notes.emplace_back(TableOfLines{lines.size()});
  diagnosis.lines = std::move(table);
  return diagnosis;
}

}  // namespace glidelab::diagnose
