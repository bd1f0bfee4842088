#include "validate/blind/everyday_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "core/result/quantity.h"

namespace glidelab::validate {
namespace {

constexpr double kLeastClaimedShare = 0.5;  // of the excess: a claim concerns this share
constexpr double kClearErrors = 2.0;        // standard errors
constexpr std::size_t kCalibrationBins = 10;

bool holds(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

bool is_cause(const BlindOutcome& outcome, std::size_t cause, const std::string& id) {
  const std::string& truth = outcome.causes[cause].id;
  return blind_class(id, false) == blind_class(truth, false) || holds(outcome.everyday->equals[cause], id);
}

bool is_cause_or_alike(const BlindOutcome& outcome, std::size_t cause, const EverydayName& name) {
  return is_cause(outcome, cause, name.id) ||
         std::any_of(name.equivalent_to.begin(), name.equivalent_to.end(),
                     [&](const std::string& id) { return is_cause(outcome, cause, id); });
}

void add(BlindShare& share, bool yes) {
  ++share.of;
  if (yes) ++share.yes;
}

std::string strength_of(const BlindOutcome& outcome) {
  return outcome.everyday->strong ? "strong" : "moderate";
}

bool claims_half(const EverydaySaying& saying) {
  return saying.claims || std::any_of(saying.names.begin(), saying.names.end(), [](const EverydayName& name) {
           return name.share.value_or(0.0) >= kLeastClaimedShare;
         });
}

void add_shares(const BlindOutcome& outcome, const EverydaySaying& saying, EverydayMethod& method) {
  for (std::size_t c = 0; c < outcome.causes.size(); ++c) {
    const auto name = std::find_if(saying.names.begin(), saying.names.end(), [&](const EverydayName& one) {
      return one.share && is_cause_or_alike(outcome, c, one);
    });
    const double claimed = name == saying.names.end() ? 0.0 : *name->share;
    const double error = claimed - outcome.everyday->shares[c];
    method.any_share_error.add(error);
    if (name != saying.names.end()) method.share_error.add(error);
  }
}

void add_saying(const BlindOutcome& outcome, const EverydaySaying& saying, EverydayMethod& method) {
  const EverydayClass kind = outcome.everyday->kind;
  const std::string of(word(kind)), strength = strength_of(outcome);
  const auto& names = saying.names;
  if (kind == EverydayClass::imperfect) add(method.false_claim[of][strength], claims_half(saying));
  if (kind == EverydayClass::outside) {
    add(method.wrong_name[of][strength],
        saying.claims && std::any_of(names.begin(), names.end(),
                                     [](const EverydayName& name) { return name.probability > kSureName; }));
  }
  if (kind != EverydayClass::one && kind != EverydayClass::two) return;
  const bool named = saying.claims && !names.empty();
  add(method.main_first[of][strength], named && is_cause(outcome, 0, names.front().id));
  add(method.main_in_set[of][strength], named && is_cause_or_alike(outcome, 0, names.front()));
  if (kind == EverydayClass::two) {
    // Two names, one for each: a set that contains both counts as one name.
    bool both = false;
    for (std::size_t a = 0; saying.claims && a < names.size(); ++a) {
      for (std::size_t b = 0; b < names.size(); ++b) {
        both = both || (a != b && is_cause_or_alike(outcome, 0, names[a]) && is_cause_or_alike(outcome, 1, names[b]));
      }
    }
    add(method.both[of][strength], both);
  }
  add_shares(outcome, saying, method);
}

const BlindRanked* least_gap(const BlindVerdict& verdict, std::size_t size, const std::string& with) {
  const BlindRanked* best = nullptr;
  for (const BlindRanked& one : verdict.ranking) {
    if (one.ids.size() != size || !one.gap_after) continue;
    if (!with.empty() && !one.ids.contains(with)) continue;
    if (best == nullptr || *one.gap_after < *best->gap_after) best = &one;
  }
  return best;
}

bool is_fair(const BlindOutcome& outcome, const EverydaySaying& saying) {
  double all = 0.0, fair = 0.0;
  for (const ActingImperfection& imperfection : outcome.everyday->imperfections) {
    all += imperfection.excess;
    if (!saying.names.empty() && holds(imperfection.effects, saying.names.front().id)) fair += imperfection.excess;
  }
  return fair > 0.0 && fair >= kLeastClaimedShare * all;
}

/// The stated probability of a verdict, and whether the verdict is right.
std::pair<double, bool> stated_and_right(const BlindOutcome& outcome) {
  const BlindVerdict& verdict = outcome.verdict;
  const EverydayClass kind = outcome.everyday->kind;
  if (verdict.verdict == diagnose::Verdict::effect && !verdict.effects.empty()) {
    const BlindNamed& first = verdict.effects.front();
    bool right = false;
    for (std::size_t c = 0; kind != EverydayClass::outside && c < outcome.causes.size(); ++c) {
      right = right || is_cause_or_alike(outcome, c, {first.id, first.equivalent_to, 1.0, {}});
    }
    return {std::min(1.0, std::max(first.probability, first.joint)), right};
  }
  if (kind == EverydayClass::imperfect) return {std::min(1.0, verdict.none + verdict.unknown), true};
  const bool unknown = verdict.verdict == diagnose::Verdict::unknown;
  return {unknown ? verdict.unknown : verdict.none, unknown && kind == EverydayClass::outside};
}

/// The mean of |sum of p - number right| if each is right with its p, over the distribution of that number.
double error_by_chance(const std::vector<double>& stated) {
  std::vector<double> right{1.0};  // the probability of 0, 1, ... right ones
  double sum = 0.0;
  for (const double p : stated) {
    right.push_back(0.0);
    for (std::size_t k = right.size(); k-- > 0;) right[k] = right[k] * (1.0 - p) + (k > 0 ? right[k - 1] * p : 0.0);
    sum += p;
  }
  double error = 0.0;
  for (std::size_t k = 0; k < right.size(); ++k) error += right[k] * std::abs(sum - static_cast<double>(k));
  return error;
}

EverydayCalibration calibration_of(const std::vector<std::pair<double, bool>>& stated) {
  EverydayCalibration of;
  of.of = stated.size();
  std::array<double, kCalibrationBins> gap{};
  std::array<std::vector<double>, kCalibrationBins> of_bin;
  for (const auto& [p, right] : stated) {
    const auto bin = std::min(kCalibrationBins - 1, static_cast<std::size_t>(p * kCalibrationBins));
    gap[bin] += p - (right ? 1.0 : 0.0);
    of_bin[bin].push_back(p);
    of.stated += p;
    of.right += right ? 1.0 : 0.0;
  }
  if (stated.empty()) return of;
  const auto many = static_cast<double>(stated.size());
  for (const double one : gap) of.error += std::abs(one) / many;
  for (const std::vector<double>& one : of_bin) of.by_chance += error_by_chance(one) / many;
  of.stated /= many;
  of.right /= many;
  return of;
}

/// What is true of the configuration of this mass and inclination, as stated; `where` names them in a message.
const EverydayConfiguration& truth_of(const BlindOutcome& outcome, double mass_kg, double incline_deg,
                                      const char* where) {
  constexpr double kSameMass = 1e-6, kSameIncline = 1e-3;  // kg, degrees: precision of the values in a file
  const auto& all = outcome.everyday->configurations;
  const auto truth = std::find_if(all.begin(), all.end(), [&](const EverydayConfiguration& one) {
    return std::abs(one.mass_kg - mass_kg) < kSameMass && std::abs(one.incline_deg - incline_deg) < kSameIncline;
  });
  if (truth == all.end()) {
    throw base::InputError(base::Issue{fmt::format("case {}", outcome.index), 0, where,
                                       fmt::format("{} kg at {} degrees", mass_kg, incline_deg),
                                       "a configuration of the case's experiment.toml"});
  }
  return *truth;
}

void add_answers(const BlindOutcome& outcome, EverydayScore& score) {
  for (const core::ConfigurationResult& of : outcome.estimate->results.configurations) {
    const EverydayConfiguration& truth = truth_of(outcome, of.mass_kg, of.incline_deg, "configurations");
    for (const core::QuantityName& quantity : core::kQuantities) {
      const std::optional<double> value = true_value(truth, quantity.which);
      if (!value) continue;
      EverydayAnswers& answers = score.answers[std::string(word(outcome.everyday->kind))][std::string(quantity.key)];
      const std::optional<core::Estimate>& said = core::value_of(of, quantity.which).estimate;
      add(answers.answered, said.has_value());
      if (!said) continue;
      answers.error.add(said->value - *value);
      add(answers.covered, said->low95 <= *value && *value <= said->high95);
    }
  }
}

void add_coverage(const BlindOutcome& outcome, EverydayScore& score) {
  for (const BlindRecovered& told : outcome.verdict.sequence.recovered) {
    const EverydayConfiguration& truth = truth_of(outcome, told.mass_kg, told.incline_deg, "recovered");
    for (const auto& [key, interval] : told.interval95) {
      const auto value = true_value(truth, core::kQuantities.at(core::place_of(key)).which);
      add(score.covered[std::string(word(outcome.everyday->kind))][key],
          value && *value >= interval.low && *value <= interval.high);
    }
  }
}

}  // namespace

void ErrorSum::add(double error) {
  ++of;
  squares += error * error;
  sum += error;
}

double ErrorSum::rms() const {
  return of == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(of));
}

double ErrorSum::mean() const {
  return of == 0 ? 0.0 : sum / static_cast<double>(of);
}

BlindShare sum_of(const SharesByCase& shares, const std::vector<std::string>& classes) {
  BlindShare sum;
  for (const auto& [kind, by_strength] : shares) {
    if (!classes.empty() && !holds(classes, kind)) continue;
    for (const auto& [strength, share] : by_strength) {
      sum.of += share.of;
      sum.yes += share.yes;
    }
  }
  return sum;
}

EverydaySaying said_by_diagnosis(const BlindVerdict& verdict) {
  EverydaySaying saying{!verdict.verdict, verdict.verdict == diagnose::Verdict::effect, {}};
  const auto effect = [&](const std::string& id) {
    return std::find_if(verdict.effects.begin(), verdict.effects.end(),
                        [&](const BlindNamed& one) { return one.id == id; });
  };
  for (const BlindExplained& one : verdict.sequence.explained) {
    EverydayName name{one.id, {}, 0.0, one.share};
    if (const auto named = effect(one.id); named != verdict.effects.end()) {
      name.equivalent_to = named->equivalent_to;
      name.probability = std::max(named->probability, named->joint);
    }
    saying.names.push_back(std::move(name));
  }
  for (const BlindNamed& one : verdict.effects) {
    const bool listed = std::any_of(saying.names.begin(), saying.names.end(),
                                    [&](const EverydayName& name) { return name.id == one.id; });
    if (!listed) saying.names.push_back({one.id, one.equivalent_to, std::max(one.probability, one.joint), {}});
  }
  return saying;
}

EverydaySaying said_by_forward_selection(const BlindVerdict& verdict) {
  EverydaySaying saying{!verdict.verdict, false, {}};
  const BlindRanked* first = least_gap(verdict, 1, "");
  const double before = verdict.gap_before * verdict.gap_before - 1.0;
  if (saying.failed || first == nullptr || verdict.gap_before - 1.0 <= kClearErrors * verdict.gap_error) return saying;
  const auto share = [&](double from, double to) { return (from * from - to * to) / before; };
  double left = *first->gap_after;
  const std::string& id = *first->ids.begin();
  saying.names.push_back({id, {}, 1.0, share(verdict.gap_before, left)});
  const BlindRanked* second = least_gap(verdict, 2, id);
  if (second != nullptr && left - *second->gap_after > kClearErrors * verdict.gap_error) {
    const std::string& other = *second->ids.begin() == id ? *second->ids.rbegin() : *second->ids.begin();
    saying.names.push_back({other, {}, 1.0, share(left, *second->gap_after)});
    left = *second->gap_after;
  }
  saying.claims = share(verdict.gap_before, left) >= kLeastClaimedShare;
  return saying;
}

EverydayScore score_everyday(const std::vector<BlindOutcome>& outcomes) {
  EverydayScore score;
  score.methods.resize(2);
  score.methods[0].by = DecisionMethod::diagnosis;
  score.methods[1].by = DecisionMethod::forward_selection;
  std::map<std::string, std::vector<std::pair<double, bool>>> stated, by_verdict;
  double seconds = 0.0;
  for (const BlindOutcome& outcome : outcomes) {
    if (!outcome.everyday) throw std::logic_error("a case that is no everyday one");
    const std::string of(word(outcome.everyday->kind)), strength = strength_of(outcome);
    const EverydaySaying said = said_by_diagnosis(outcome.verdict);
    add_saying(outcome, said, score.methods[0]);
    add_saying(outcome, said_by_forward_selection(outcome.verdict), score.methods[1]);
    ++score.cases[of];
    const bool has_cause = of == "one" || of == "two";
    if (has_cause) {
      add(score.main_helps[of][strength], !said.names.empty() && is_cause_or_alike(outcome, 0, said.names.front()));
      if (outcome.verdict.sequence.remainder) {
        score.remainder_error.add(*outcome.verdict.sequence.remainder - outcome.everyday->remainder);
      }
    } else {
      add(score.unknown[of][strength], outcome.verdict.verdict == diagnose::Verdict::unknown);
    }
    if (of == "dirt" && claims_half(said)) add(score.fair_claim, is_fair(outcome, said));
    if (outcome.seconds) {
      ++score.timed;
      seconds += *outcome.seconds;
      score.most_s = std::max(score.most_s, *outcome.seconds);
    }
    if (outcome.estimate) add_answers(outcome, score);
    if (said.failed) {
      ++score.failed[of];
      continue;
    }
    stated[of].push_back(stated_and_right(outcome));
    stated["all"].push_back(stated[of].back());
    by_verdict[verdict_word(outcome.verdict)].push_back(stated[of].back());
    add_coverage(outcome, score);
  }
  for (const auto& [kind, list] : stated) score.calibration[kind] = calibration_of(list);
  for (const auto& [word, list] : by_verdict) score.by_verdict[word] = calibration_of(list);
  if (score.timed > 0) score.mean_s = seconds / static_cast<double>(score.timed);
  return score;
}

}  // namespace glidelab::validate
