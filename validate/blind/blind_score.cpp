#include "validate/blind/blind_score.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "diagnose/effects/effect_list.h"
#include "diagnose/result/explanation.h"
#include "diagnose/result/joined_ids.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_filmed_effects.h"

namespace glidelab::validate {

using Json = nlohmann::json;
using diagnose::Verdict;

namespace {

/// What the list calls a cause that is drawn as one outside it, since the list has become longer; empty: nothing.
std::string_view fair_name(const std::string& outside) {
  if (outside == "drag_of_each_run" || outside == "friction_of_each_run") return diagnose::ids::clip_scatter;
  if (outside == "drag_by_load") return diagnose::ids::configuration_drag;
  return {};
}

/// Whether a verdict, or its first name, is right about a cause outside the list.
bool recognises(const BlindOutcome& outcome, std::optional<Verdict> verdict, const std::string* name) {
  return name != nullptr ? *name == fair_name(outcome.causes.front().id) : verdict == Verdict::unknown;
}

/// Json::exception if something is missing or of the wrong type.
BlindVerdict verdict_of(const Json& document, const std::filesystem::path& file) {
  BlindVerdict verdict;
  const std::string id = document.at("verdict");
  verdict.verdict = diagnose::verdict_of_id(id);
  if (!verdict.verdict) throw base::InputError(base::Issue{file.string(), 0, "verdict", id, "none, effect or unknown"});
  verdict.points = document.at("points");
  verdict.none = document.at("probability").at("none");
  verdict.unknown = document.at("probability").at("unknown");
  for (const Json& effect : document.at("effects")) {
    const double alone = effect.at("probability");
    verdict.effects.push_back(
        {effect.at("id"), alone, effect.at("equivalent_to"), effect.value("joint_probability", alone)});
  }
  for (const Json& ranked : document.at("ranking")) {
    const std::vector<std::string> ids = diagnose::split_ids(ranked.at("id").get<std::string>());
    BlindRanked one{{ids.begin(), ids.end()},
                    ranked.at("probability"),
                    ranked.at("log_likelihood_gain"),
                    ranked.at("parameters"),
                    {}};
    if (ranked.contains("gap_after") && ranked.at("gap_after").is_number()) one.gap_after = ranked.at("gap_after");
    verdict.ranking.push_back(std::move(one));
  }
  for (const Json& region : document.at("where").at("regions")) {
    verdict.where.push_back(region.contains("clip") ? "clip" : std::string(region.at("variable")));
  }
  if (const Json& gap = document.at("gap"); gap.is_object()) {
    verdict.gap_before = gap.at("before");
    verdict.gap_after = gap.at("after");
    verdict.gap_error = gap.at("standard_error");
  }
  verdict.sequence = read_blind_sequence(document);
  return verdict;
}

}  // namespace

std::string verdict_word(const BlindVerdict& verdict) {
  return std::string(verdict.verdict ? diagnose::verdict_id(*verdict.verdict) : "failed");
}

BlindVerdict read_blind_verdict(const std::filesystem::path& file) {
  const Json document = Json::parse(base::read_file(file), nullptr, false);
  if (!document.is_object() || document.value("format", Json()) != 1 || !document.contains("verdict")) {
    throw base::InputError(base::Issue{file.string(), 0, "", "no diagnosis", "a diagnosis.json"});
  }
  try {
    return verdict_of(document, file);
  } catch (const Json::exception& error) {
    throw base::InputError(base::Issue{file.string(), 0, "", error.what(), "a diagnosis.json"});
  }
}

void set_aside(const std::vector<std::string>& told, BlindVerdict& verdict) {
  const auto is_told = [&](const std::string& id) { return std::find(told.begin(), told.end(), id) != told.end(); };
  if (told.empty() || !verdict.verdict) return;
  std::erase_if(verdict.effects, [&](const BlindNamed& effect) { return is_told(effect.id); });
  if (verdict.verdict == Verdict::effect && verdict.effects.empty()) verdict.verdict = Verdict::none;
  for (BlindRanked& ranked : verdict.ranking) {
    std::erase_if(ranked.ids, is_told);
    if (ranked.ids.empty()) verdict.none += ranked.probability;
  }
  std::erase_if(verdict.ranking, [](const BlindRanked& ranked) { return ranked.ids.empty(); });
}

namespace {

constexpr double kModerate = 15.0, kStrong = 50.0;  // log likelihood, as in the targets
constexpr double kSameShrink = 0.95;
constexpr double kClearGap = 3.0;  // standard errors: a smaller reduction is noise over noise
constexpr std::size_t kBins = 10;

/// Words that a verdict has in place of a name.
constexpr std::string_view kNone = diagnose::verdict_id(Verdict::none),
                           kUnknown = diagnose::verdict_id(Verdict::unknown);

std::set<std::string> classes_of(const BlindOutcome& outcome) {
  std::set<std::string> classes;
  for (const BlindCause& cause : outcome.causes) classes.insert(blind_class(cause.id, outcome.filmed));
  return classes;
}

const std::vector<std::string>& library_of(const BlindOutcome& outcome) {
  return outcome.filmed ? filmed_effects() : library_effects();
}

/// The answer of one decision method to one case: a verdict, none if it failed, and names (in order).
struct Saying {
  std::optional<Verdict> verdict;
  std::vector<std::string> names;
};

Saying of_diagnosis(const BlindVerdict& verdict) {
  Saying saying{verdict.verdict, {}};
  for (const BlindNamed& effect : verdict.effects) saying.names.push_back(effect.id);
  return saying;
}

const BlindRanked* most(const std::vector<BlindRanked>& ranking, std::size_t size, const std::string& with,
                        double by_parameter) {
  const BlindRanked* best = nullptr;
  double best_value = 0.0;
  for (const BlindRanked& one : ranking) {
    if (one.ids.size() != size) continue;
    if (!with.empty() && !one.ids.contains(with)) continue;
    const double value = one.log_likelihood_gain - by_parameter * one.parameters;
    if (best != nullptr && value <= best_value) continue;
    best = &one;
    best_value = value;
  }
  return best;
}

/// Names the effect whose refit lowers the residuals most; it always names one.
Saying of_best_residual(const BlindVerdict& verdict) {
  if (!verdict.verdict) return {};
  const BlindRanked* best = most(verdict.ranking, 1, "", 0.0);
  return best == nullptr ? Saying{Verdict::none, {}} : Saying{Verdict::effect, {*best->ids.begin()}};
}

/// Forward selection by Schwarz's criterion: one effect if it lowers the criterion, a second one if that lowers it
/// further.
Saying of_stepwise_bic(const BlindVerdict& verdict) {
  if (!verdict.verdict) return {};
  const double price = 0.5 * std::log(std::max(2.0, verdict.points));
  const auto value = [&](const BlindRanked& one) { return one.log_likelihood_gain - price * one.parameters; };
  const BlindRanked* first = most(verdict.ranking, 1, "", price);
  if (first == nullptr || value(*first) <= 0.0) return {Verdict::none, {}};
  Saying saying{Verdict::effect, {*first->ids.begin()}};
  const BlindRanked* second = most(verdict.ranking, 2, saying.names.front(), price);
  if (second == nullptr || value(*second) <= value(*first)) return saying;
  for (const std::string& id : second->ids) {
    if (id != *first->ids.begin()) saying.names.push_back(id);
  }
  return saying;
}

void count(BlindShare& share, bool yes) {
  ++share.of;
  if (yes) ++share.yes;
}

void count_saying(const BlindOutcome& outcome, const Saying& saying, BlindMethod& method) {
  const std::set<std::string> truth = classes_of(outcome);
  std::size_t found = 0;
  for (const std::string& cause : truth) {
    found += std::any_of(saying.names.begin(), saying.names.end(),
                         [&](const std::string& name) { return blind_class(name, outcome.filmed) == cause; });
  }
  switch (outcome.kind) {
    case BlindKind::none:
      return count(method.none, saying.verdict == Verdict::none);
    case BlindKind::single:
      return count(method.single[std::string(strength_word(outcome))],
                   !saying.names.empty() && truth.contains(blind_class(saying.names.front(), outcome.filmed)));
    case BlindKind::pair:
      return count(method.pair, found == truth.size());
    case BlindKind::outside:
      return count(method.outside,
                   recognises(outcome, saying.verdict, saying.names.empty() ? nullptr : &saying.names.front()));
  }
}

/// Random choice among all effects, none and unknown with equal odds: expected shares, written as if of 10,000 trials.
BlindMethod picking(const std::vector<BlindOutcome>& outcomes) {
  BlindMethod method{DecisionMethod::picking, {}, {}, {}, {}};
  constexpr std::size_t kTries = 10000;
  const double words =
      2.0 + static_cast<double>((outcomes.empty() ? library_effects() : library_of(outcomes.front())).size());
  const auto expected = [&](double share) { return static_cast<std::size_t>(std::lround(share * kTries)); };
  std::map<std::string, std::pair<double, double>> single;
  for (const BlindOutcome& outcome : outcomes) {
    if (outcome.kind != BlindKind::single) continue;
    double same = 0.0;
    for (const std::string& id : library_of(outcome)) {
      same += blind_class(id, outcome.filmed) == true_class(outcome) ? 1.0 : 0.0;
    }
    auto& [sum, of] = single[std::string(strength_word(outcome))];
    sum += same / words;
    of += 1.0;
  }
  method.none = method.outside = {kTries, expected(1.0 / words)};
  method.pair = {kTries, 0};
  for (const auto& [strength, sums] : single) method.single[strength] = {kTries, expected(sums.first / sums.second)};
  return method;
}

/// The most likely word of a verdict with its probability, summed over classes of effects.
std::pair<std::string, double> likeliest(const BlindVerdict& verdict, bool filmed) {
  std::map<std::string, double> sums = {{std::string(kNone), verdict.none}, {std::string(kUnknown), verdict.unknown}};
  for (const BlindRanked& ranked : verdict.ranking) {
    std::set<std::string> classes;
    for (const std::string& id : ranked.ids) classes.insert(blind_class(id, filmed));
    for (const std::string& id : classes) sums[id] += ranked.probability;
  }
  const auto best =
      std::max_element(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {best->first, std::min(1.0, best->second)};
}

bool is_right(const BlindOutcome& outcome, const std::string& said) {
  if (outcome.kind == BlindKind::none) return said == kNone;
  if (outcome.kind == BlindKind::outside) return said == kUnknown || said == fair_name(outcome.causes.front().id);
  return classes_of(outcome).contains(said);
}

void add_reliability(const std::vector<BlindOutcome>& outcomes, BlindScore& score) {
  score.reliability.resize(kBins);
  std::array<double, kBins> sums{};
  double of = 0.0, off = 0.0;
  for (std::size_t b = 0; b < kBins; ++b) {
    score.reliability[b].from = static_cast<double>(b) / kBins;
    score.reliability[b].to = static_cast<double>(b + 1) / kBins;
  }
  for (const BlindOutcome& outcome : outcomes) {
    if (!outcome.verdict.verdict) continue;
    const auto [said, p] = likeliest(outcome.verdict, outcome.filmed);
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(p * kBins));
    sums[bin] += p;
    count(score.reliability[bin].right, is_right(outcome, said));
    of += 1.0;
  }
  for (std::size_t b = 0; b < kBins; ++b) {
    const auto n = static_cast<double>(score.reliability[b].right.of);
    if (n == 0.0) continue;
    score.reliability[b].stated = sums[b] / n;
    off += n * std::abs(score.reliability[b].stated - score.reliability[b].right.share());
  }
  score.calibration_error = of > 0.0 ? off / of : 0.0;
}

void add_shrink(const BlindOutcome& outcome, BlindScore& score) {
  if (outcome.kind != BlindKind::single || strength_word(outcome) != "strong") return;
  const BlindVerdict& verdict = outcome.verdict;
  std::optional<double> oracle;
  for (const BlindRanked& ranked : verdict.ranking) {
    if (ranked.ids == std::set<std::string>{outcome.causes.front().id}) oracle = ranked.gap_after;
  }
  if (!oracle || verdict.gap_before - *oracle < kClearGap * verdict.gap_error) return;
  const double reached = (verdict.gap_before - verdict.gap_after) / (verdict.gap_before - *oracle);
  count(score.shrunk, reached >= kSameShrink);
}

void add_case(const BlindOutcome& outcome, BlindScore& score) {
  const BlindVerdict& verdict = outcome.verdict;
  const std::string strength(strength_word(outcome));
  if (outcome.kind == BlindKind::none) count(score.false_alarm, verdict.verdict != Verdict::none);
  if (outcome.kind == BlindKind::single) {
    count(score.in_set[strength], named_by(outcome).contains(true_class(outcome)));
    count(score.exact[strength], !verdict.effects.empty() && verdict.effects.front().id == outcome.causes.front().id);
    if (outcome.left_out) {
      const VerdictWithout said = verdict_without(outcome);
      for (const VerdictWithout one : kVerdictsWithout) count(score.left_out[one], said == one);
      const auto variables = variables_of(outcome.causes.front().id);
      if (said == VerdictWithout::unknown && !variables.empty()) {
        const auto& where = outcome.left_out->where;
        count(score.left_out_where,
              !where.empty() && std::find(variables.begin(), variables.end(), where.front()) != variables.end());
      }
    }
  }
  if (outcome.kind == BlindKind::outside) {
    const std::string_view fair = fair_name(outcome.causes.front().id);
    count(score.recognised[strength],
          recognises(outcome, verdict.verdict, verdict.effects.empty() ? nullptr : &verdict.effects.front().id));
    count(score.wrong_name, std::any_of(verdict.effects.begin(), verdict.effects.end(), [&](const BlindNamed& effect) {
            return effect.probability > kSureName && effect.id != fair;
          }));
    if (verdict.verdict == Verdict::unknown) {
      const auto& where = verdict.where;
      const std::string& variable = outcome.causes.front().variable;
      count(score.where, std::find(where.begin(), where.end(), variable) != where.end());
      count(score.where_first, !where.empty() && where.front() == variable);
    }
  }
  add_shrink(outcome, score);
  if (!verdict.verdict) ++score.failed;
}

void add_confusion(const BlindOutcome& outcome, BlindScore& score) {
  std::optional<std::string> truth = std::string(kNone);
  if (outcome.causes.size() == 1) truth = outcome.causes.front().id;
  if (outcome.causes.size() > 1) truth.reset();
  auto row =
      std::find_if(score.confusion.begin(), score.confusion.end(), [&](const auto& r) { return r.truth == truth; });
  if (row == score.confusion.end()) {
    score.confusion.push_back({truth});
    row = std::prev(score.confusion.end());
  }
  const BlindVerdict& verdict = outcome.verdict;
  if (outcome.kind == BlindKind::pair && !verdict.effects.empty()) {
    std::size_t found = 0;
    for (const std::string& cause : classes_of(outcome)) found += named_by(outcome).contains(cause);
    ++row->named[found];
    return;
  }
  ++row->said[verdict.effects.empty() ? verdict_word(verdict) : verdict.effects.front().id];
}

}  // namespace

std::string blind_class(const std::string& id, bool filmed) {
  if (id == diagnose::ids::frame_rate_error) return diagnose::ids::scale_error;
  if (id == diagnose::ids::base_vibration && !filmed) return diagnose::ids::camera_motion;
  return id;
}

std::string true_class(const BlindOutcome& outcome) {
  return blind_class(outcome.causes.front().id, outcome.filmed);
}

std::set<std::string> named_by(const BlindOutcome& outcome) {
  std::set<std::string> named;
  for (const BlindNamed& effect : outcome.verdict.effects) {
    named.insert(blind_class(effect.id, outcome.filmed));
    for (const std::string& id : effect.equivalent_to) named.insert(blind_class(id, outcome.filmed));
  }
  return named;
}

std::string_view strength_word(const BlindOutcome& outcome) {
  if (outcome.causes.empty()) return "";
  double gain = outcome.causes.front().gain;
  for (const BlindCause& cause : outcome.causes) gain = std::min(gain, cause.gain);
  return gain > kStrong ? "strong" : gain >= kModerate ? "moderate" : "weak";
}

BlindScore score_blind(const std::vector<BlindOutcome>& outcomes) {
  BlindScore score;
  score.methods = {{DecisionMethod::diagnosis, {}, {}, {}, {}},
                   {DecisionMethod::best_residual, {}, {}, {}, {}},
                   {DecisionMethod::stepwise_bic, {}, {}, {}, {}}};
  for (const BlindOutcome& outcome : outcomes) {
    Saying said = of_diagnosis(outcome.verdict);
    count_saying(outcome, said, score.methods[0]);
    count_saying(outcome, of_best_residual(outcome.verdict), score.methods[1]);
    count_saying(outcome, of_stepwise_bic(outcome.verdict), score.methods[2]);
    add_case(outcome, score);
    add_confusion(outcome, score);
  }
  // Whether both of two effects are named, also if one is named as an equivalent of another.
  BlindShare both;
  for (const BlindOutcome& outcome : outcomes) {
    if (outcome.kind != BlindKind::pair) continue;
    const std::set<std::string> truth = classes_of(outcome), named = named_by(outcome);
    count(both,
          outcome.verdict.effects.size() > 1 && std::includes(named.begin(), named.end(), truth.begin(), truth.end()));
  }
  score.methods[0].pair = both;
  score.methods.push_back(picking(outcomes));
  add_reliability(outcomes, score);
  std::sort(score.confusion.begin(), score.confusion.end(),
            [](const auto& a, const auto& b) { return a.truth < b.truth; });
  return score;
}

VerdictWithout verdict_without(const BlindOutcome& outcome) {
  if (!outcome.left_out) throw std::logic_error("a case that was not diagnosed without its effect");
  const BlindVerdict& without = *outcome.left_out;
  if (!without.verdict) return VerdictWithout::failed;
  if (without.verdict == Verdict::none) return VerdictWithout::none;
  if (without.verdict == Verdict::unknown) return VerdictWithout::unknown;
  // Effects that the full diagnosis calls equivalent to the truth on these data may replace it.
  const std::set<std::string> named = named_by(outcome);
  const bool truth_named = named.contains(true_class(outcome));
  if (truth_named && named.contains(blind_class(without.effects.front().id, outcome.filmed)))
    return VerdictWithout::equivalent;
  const bool sure = std::any_of(without.effects.begin(), without.effects.end(),
                                [](const BlindNamed& effect) { return effect.probability > kSureName; });
  return sure ? VerdictWithout::sure_other_name : VerdictWithout::other_name;
}

std::vector<std::string> variables_of(const std::string& effect) {
  const std::vector<std::string> speed = {"v_m_s"}, place = {"x_m"}, time = {"t_s", "clip"};
  static const std::map<std::string, std::vector<std::string>> seen = {
      {diagnose::ids::quadratic_drag, speed},
      {diagnose::ids::eddy_rolloff, speed},
      {diagnose::ids::power_law_drag, speed},
      {diagnose::ids::stribeck, speed},
      {diagnose::ids::load_independent_friction, {"mass_kg", "direction", "v_m_s"}},  // -sign(v) F0, by mass
      {diagnose::ids::direction_asymmetry, {"direction", "v_m_s"}},
      {diagnose::ids::track_bow, place},
      {diagnose::ids::damping_gradient, {"x_m", "v_m_s"}},  // a position-dependent drag
      {diagnose::ids::rotational_inertia, {"mass_kg", "a_m_s2"}},
      {diagnose::ids::tether, place},
      {diagnose::ids::base_vibration, time},
      {diagnose::ids::late_release, time},
      {diagnose::ids::camera_motion, time},
      {diagnose::ids::dropped_frames, time},
      {diagnose::ids::perspective_error, place},
      {diagnose::ids::lens_distortion, place},
      {diagnose::ids::rolling_shutter, {"v_m_s", "x_m"}}};
  const auto found = seen.find(effect);
  return found == seen.end() ? std::vector<std::string>{} : found->second;
}

}  // namespace glidelab::validate
