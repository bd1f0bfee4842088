#include "diagnose/lines/line_diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

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

Explanation explanation_of(const LineExplanation& lines, const std::vector<LineCause>& causes) {
  Explanation explanation;
  for (const std::size_t c : lines.causes) explanation.effects.push_back(causes[c].id);
  return explanation;
}

/// The index of a cause's first term among all terms of an explanation.
std::size_t first_term(const LineExplanation& explanation, const std::vector<LineCause>& causes, std::size_t cause) {
  std::size_t first = 0;
  for (std::size_t k = 0; k < cause; ++k) first += causes[explanation.causes[k]].terms.size();
  return first;
}

/// For one size, or for the sizes of every cell and their spread.
std::vector<DiagnosedParameter> parameters_of(const LineExplanation& explanation, const LineData& data,
                                              const std::vector<LineCause>& causes, std::size_t k) {
  const LineCause& cause = causes[explanation.causes[k]];
  const std::size_t first = first_term(explanation, causes, k);
  if (cause.over) return own_of_cells(data, cause, explanation.solution, first);
  const auto at = static_cast<Eigen::Index>(first);
  std::vector<DiagnosedParameter> parameters = {
      {cause.terms.front().key, explanation.solution.size[at], explanation.solution.sd[at]}};
  if (const OnLines& lines = effect_of(cause.id).lines; !lines.unknown_key.empty()) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    parameters.push_back({.key = std::string(lines.unknown_key),
                          .value = kNan,
                          .sd = kNan,
                          .why = core::WhyUnknown{core::unknown::KernelNotStated{}}});
  }
  return parameters;
}

LineCandidate candidate_of(const LineExplanation& explanation, const LineData& data,
                           const std::vector<LineCause>& causes, const LineSolution& nominal,
                           const OwnScatter& scatter) {
  const LineSolution& solution = explanation.solution;
  LineCandidate candidate{explanation_of(explanation, causes),
                          {},
                          explanation.probability,
                          explanation.log_evidence,
                          log_likelihood_gain_of(solution, nominal),
                          static_cast<std::size_t>(solution.size.size()),
                          {},
                          {},
                          {},
                          solution.left_out};
  for (std::size_t k = 0; k < explanation.causes.size(); ++k) {
    const LineCause& cause = causes[explanation.causes[k]];
    const DiagnosedParameter size = parameters_of(explanation, data, causes, k).front();
    candidate.sizes.push_back({size.key, size.value, size.sd});
    if (cause.over) candidate.forms.push_back({cause.id, *cause.over});
  }
  if (scatter.known()) {
    candidate.chi2 = chi_square_of(solution, scatter);
    candidate.gap = gap_of_lines(solution, scatter);
  }
  return candidate;
}

/// All weighed explanations, in their order.
LineComparison comparison_of(const std::vector<LineExplanation>& all, const LineData& data,
                             const std::vector<LineCause>& causes, const OwnScatter& scatter) {
  LineComparison lines;
  lines.intercept_sd_m_s2 = scatter.intercept_m_s2;
  lines.slope_sd = scatter.slope;
  lines.scatter_freedom = scatter.freedom;
  for (const LineExplanation& e : all) {
    lines.candidates.push_back(candidate_of(e, data, causes, all.front().solution, scatter));
  }
  return lines;
}

/// The part of the gap's excess that an explanation leaves; empty if the lines' scatter is not known.
std::optional<double> left_by(const LineExplanation& e, const LineSolution& nominal, const OwnScatter& scatter) {
  if (!scatter.known()) return {};
  const double gap = gap_of_lines(e.solution, scatter), before = gap_of_lines(nominal, scatter);
  return (gap * gap - 1.0) / (before * before - 1.0);
}

/// Single causes whose evidence equals that of the best explanation and which leave as much, the best first; empty if
/// the best is a pair. If an effect has several forms, the likeliest counts.
std::vector<std::size_t> equals_of(const LineExplanation& best, const std::vector<LineExplanation>& all,
                                   const std::vector<LineCause>& causes, const OwnScatter& scatter) {
  if (best.causes.size() != 1) return {};
  const LineSolution& nominal = all.front().solution;
  std::map<std::string, const LineExplanation*> likeliest;
  for (const LineExplanation& e : all) {
    if (e.causes.size() != 1 || e.solution.left_out) continue;
    const LineExplanation*& of = likeliest[causes[e.causes.front()].id];
    if (of == nullptr || e.probability > of->probability) of = &e;
  }
  std::vector<std::size_t> equals = best.causes;
  for (const LineExplanation& e : all) {
    if (e.causes.size() != 1 || e.solution.left_out || likeliest.at(causes[e.causes.front()].id) != &e) continue;
    if (causes[e.causes.front()].id == causes[best.causes.front()].id) continue;
    const std::optional<double> left = left_by(e, nominal, scatter), least = left_by(best, nominal, scatter);
    const bool as_much = !left || std::abs(*left - *least) <= kSameLeft;
    if (as_much && e.log_evidence > best.log_evidence - kSameLineEvidence) equals.push_back(e.causes.front());
  }
  return equals;
}

std::vector<DiagnosedEffect> effects_of(const LineExplanation& best, const std::vector<LineExplanation>& all,
                                        const LineData& data, const std::vector<LineCause>& causes,
                                        const std::vector<std::size_t>& equals,
                                        const std::vector<std::string>& without) {
  std::vector<DiagnosedEffect> effects;
  for (std::size_t k = 0; k < best.causes.size(); ++k) {
    const LineCause& cause = causes[best.causes[k]];
    DiagnosedEffect effect{cause.id, cause.stage, cause.words, 0.0, {}, parameters_of(best, data, causes, k)};
    for (const LineExplanation& e : all) {
      if (explanation_of(e, causes).holds(cause.id)) effect.probability += e.probability;
    }
    std::vector<std::string> named = {cause.id};
    for (std::size_t t = 1; t < equals.size(); ++t) {
      effect.equivalent_to.push_back(causes[equals[t]].id);
      named.push_back(causes[equals[t]].id);
    }
    for (const std::string& id : same_on_lines_as(named, without)) effect.equivalent_to.push_back(id);
    effects.push_back(effect);
  }
  return effects;
}

/// Each set of effects once, with the probability of all its forms.
std::vector<NamedExplanation> sets_of(const std::vector<LineExplanation>& all, const std::vector<LineCause>& causes) {
  std::vector<NamedExplanation> sets;
  for (const LineExplanation& e : all) {
    const std::vector<std::string> effects = explanation_of(e, causes).effects;
    const auto found =
        std::find_if(sets.begin(), sets.end(), [&](const NamedExplanation& set) { return set.ids == effects; });
    if (found == sets.end()) {
      sets.push_back({effects, e.probability});
    } else {
      found->probability += e.probability;
    }
  }
  return sets;
}

void join_sets(const std::vector<LineCause>& causes, const std::vector<LineExplanation>& all, Diagnosis& diagnosis) {
  const auto words = [&](const std::string& id) {
    const auto cause = std::find_if(causes.begin(), causes.end(), [&](const LineCause& c) { return c.id == id; });
    return cause != causes.end() ? cause->words : std::string(effect_list()[effect_index(id)].words);
  };
  join_alike(sets_of(all, causes), words, diagnosis);
}

/// The term's size if nothing else is added, or its standard deviation if that is larger: the size that may be there.
double size_by_itself(const LineData& data, const std::vector<LineCause>& causes, const std::string& id) {
  for (const LineCause& cause : causes) {
    if (cause.id != id) continue;
    const LineSolution alone = solve_lines(data, cause.terms);
    return std::max(std::abs(alone.size[0]), alone.sd[0]);
  }
  return 0.0;
}

/// The likeliest set of effects, in its likeliest forms; empty if no effect was weighed.
const LineExplanation* leader_of(const std::vector<LineExplanation>& all, const std::vector<LineCause>& causes) {
  const std::vector<NamedExplanation> sets = sets_of(all, causes);
  const auto probability_of = [&](const LineExplanation& e) {
    const std::vector<std::string> effects = explanation_of(e, causes).effects;
    return std::find_if(sets.begin(), sets.end(), [&](const NamedExplanation& set) { return set.ids == effects; })
        ->probability;
  };
  const LineExplanation* leader = nullptr;
  for (const LineExplanation& e : all) {
    if (e.causes.empty() || !(e.probability > 0.0)) continue;
    const auto rank = [&](const LineExplanation& of) { return std::pair(probability_of(of), of.probability); };
    if (leader == nullptr || rank(e) > rank(*leader)) leader = &e;
  }
  return leader;
}

/// The probability of nothing, the resulting verdict, and the ranking of the rest, each set of effects once.
void weigh_up(const std::vector<LineExplanation>& all, LineComparison& table, Diagnosis& diagnosis) {
  const auto likelier = [](const auto& a, const auto& b) {
    return a.left_out.has_value() != b.left_out.has_value() ? !a.left_out : a.probability > b.probability;
  };
  diagnosis.none = all.front().probability;
  std::stable_sort(table.candidates.begin(), table.candidates.end(), likelier);
  for (const LineCandidate& c : table.candidates) {
    if (c.explanation.is_nothing()) continue;
    const auto same = std::find_if(diagnosis.ranking.begin(), diagnosis.ranking.end(),
                                   [&](const RankedExplanation& of) { return of.explanation == c.explanation; });
    if (same != diagnosis.ranking.end()) {
      same->probability += c.probability;
      continue;
    }
    diagnosis.ranking.push_back(
        {c.explanation, c.probability, c.log_evidence_gain, c.log_likelihood_gain, c.terms, c.gap, c.left_out});
  }
  std::stable_sort(diagnosis.ranking.begin(), diagnosis.ranking.end(), likelier);
  diagnosis.verdict = verdict_by(diagnosis.none, diagnosis.unknown);
}

/// The effects that a table cannot tell apart, and the probability that one or several of them act.
void tell_either(const std::vector<LineExplanation>& all, const std::vector<LineCause>& causes,
                 const std::vector<std::size_t>& equals, LineComparison& table) {
  if (equals.size() < 2) return;
  for (const std::size_t c : equals) table.either_of.push_back(causes[c].id);
  for (const LineExplanation& e : all) {
    const bool only = !e.causes.empty() && std::all_of(e.causes.begin(), e.causes.end(), [&](std::size_t c) {
      return std::find(table.either_of.begin(), table.either_of.end(), causes[c].id) != table.either_of.end();
    });
    if (only) table.either_probability += e.probability;
  }
}

std::vector<LineCurve> curves_of(const std::vector<TableLine>& lines, const LineData& data,
                                 const std::vector<LineCause>& causes, const std::vector<LineExplanation>& all) {
  std::vector<LineCurve> curves;
  for (const LineExplanation& e : all) {
    if (e.causes.size() != 1 || e.solution.left_out) continue;
    LineCurve curve = line_curve(lines, data, causes[e.causes.front()], e.solution);
    if (!curve.mass_kg.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

/// The data that would decide between a friction force and a smoothing bias.
NextStep next_of(const std::vector<TableLine>& lines, const LineData& data) {
  const std::vector<double> masses = different(lines, &TableLine::mass_kg);
  if (masses.size() < 2) return Routine::second_mass;
  const std::vector<LineCause> every = line_causes(lines, data, {});
  const double force_n = size_by_itself(data, every, ids::load_independent_friction);
  const double bias_s2_m_s2 = size_by_itself(data, every, ids::smoothing_bias);
  double drag = 0.0;
  for (const TableLine& line : lines) drag += line.k_over_m_1_s * line.mass_kg / static_cast<double>(lines.size());
  const double heavy = 3.0 * masses.back();
  return TellLinesApart{heavy, force_n, force_n / heavy, bias_s2_m_s2 * (drag / heavy) * (drag / heavy)};
}

std::vector<LineCause> causes_named(const LineExplanation& leader, const std::vector<LineCause>& causes) {
  std::vector<LineCause> named;
  for (const std::size_t c : leader.causes) named.push_back(causes[c]);
  return named;
}

/// The leader without those of its causes that take less than a hundredth of the gap beside one that takes half, if it
/// was weighed; their ids go to `traces`. However certain such a cause is, it is none of the gap.
const LineExplanation* without_traces(const LineExplanation* leader, const std::vector<LineExplanation>& all,
                                      const std::vector<LineCause>& causes,
                                      const std::vector<ExplainedCause>& explained, std::vector<std::string>& traces) {
  constexpr double kLeastShare = 0.01, kHalf = 0.5;
  std::vector<std::string> lesser;
  bool one_explains = false;
  for (const ExplainedCause& cause : explained) {
    one_explains = one_explains || cause.share > kHalf;
    if (cause.share < kLeastShare) lesser.push_back(cause.id);
  }
  if (lesser.empty() || !one_explains) return leader;
  std::vector<std::size_t> kept;
  for (const std::size_t c : leader->causes) {
    if (std::find(lesser.begin(), lesser.end(), causes[c].id) == lesser.end()) kept.push_back(c);
  }
  const std::set<std::size_t> wanted(kept.begin(), kept.end());
  const auto rest = std::find_if(all.begin(), all.end(), [&](const LineExplanation& e) {
    return std::set<std::size_t>(e.causes.begin(), e.causes.end()) == wanted;
  });
  if (rest == all.end() || rest->solution.left_out) return leader;
  traces = lesser;
  return &*rest;
}

}  // namespace

Diagnosis diagnose_lines(const std::vector<TableLine>& lines, double g, const std::vector<std::string>& without) {
  check_names(without);
  if (lines.size() < kFewestLines) throw base::InputError(too_few_lines("", lines.size()));
  const LineData data = line_data(lines, g);
  const std::vector<LineCause> causes = line_causes(lines, data, without);
  const std::vector<LineExplanation> all = weigh_lines(data, causes);
  const LineSolution& nominal = all.front().solution;
  const OwnScatter scatter = own_scatter(lines);
  const LineExplanation* leader = leader_of(all, causes);

  Diagnosis diagnosis;
  LineComparison table = comparison_of(all, data, causes, scatter);
  table.lines = lines.size();
  table.chi2_before = table.candidates.front().chi2;
  weigh_up(all, table, diagnosis);
  const bool is_effect = diagnosis.verdict == Verdict::effect;
  const auto explained = [&] {
    const double error = line_gap(lines, g, nominal, leader->solution, scatter).sizes.standard_error;
    return explained_by(data, causes_named(*leader, causes), nominal, scatter, error);
  };
  if (is_effect && scatter.known()) leader = without_traces(leader, all, causes, explained(), diagnosis.traces);
  if (is_effect) {
    const std::vector<std::size_t> equals = equals_of(*leader, all, causes, scatter);
    tell_either(all, causes, equals, table);
    diagnosis.effects = effects_of(*leader, all, data, causes, equals, without);
    diagnosis.stage = diagnosis.effects.front().stage;
    diagnosis.regions = line_regions(lines, data, nominal, scatter);
  }
  join_sets(causes, all, diagnosis);
  if (scatter.known()) {
    LineGap gap = line_gap(lines, g, nominal, is_effect ? leader->solution : nominal, scatter);
    diagnosis.gap = std::move(gap.sizes);
    diagnosis.notes = std::move(gap.notes);
    diagnosis.isolability = line_isolability(data, causes, scatter.slope, scatter.intercept_m_s2);
    diagnosis.levels = line_levels(lines, data, nominal, scatter, diagnosis.gap->standard_error);
    if (is_effect) diagnosis.explained = explained();
  }
  table.off = lines_off(lines, nominal);
  table.curves = curves_of(lines, data, causes, all);
  diagnosis.next = next_of(lines, data);
  diagnosis.notes.emplace_back(TableOfLines{lines.size()});
  diagnosis.lines = std::move(table);
  return diagnosis;
}

}  // namespace glidelab::diagnose
