#include "report/diagnosis/words/cause_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "base/text/number_text.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

namespace {

/// The note on falls through air; null if there is none.
const diagnose::FallsThroughAir* falls_through_air(const diagnose::Diagnosis& diagnosis) {
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const falls = std::get_if<diagnose::FallsThroughAir>(&note)) return falls;
  }
  return nullptr;
}

constexpr double kPercent = 100.0;
constexpr double kNearEnd = 0.01;      // of a share: this close to 0 or 1, a tenth of a percent matters
constexpr double kNothing = 5e-4;      // a share that prints as 0.0 %
constexpr std::size_t kSizesTold = 2;  // parameters of a cause that its sentence states

/// "uneven frame times", "outliers": not "inertia of wheels", "smoothing bias".
bool is_plural(const std::string& name) {
  std::string head = name;
  for (const char* behind : {" of ", " that ", " from ", " at ", " off ", " longer "}) {
    head = head.substr(0, head.find(behind));
  }
  return head.ends_with('s') && !head.ends_with("ss") && !head.ends_with("bias");
}

const diagnose::DiagnosedEffect* effect_in(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  const auto found = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                  [&](const diagnose::DiagnosedEffect& effect) { return effect.id == id; });
  return found == diagnosis.effects.end() ? nullptr : &*found;
}

bool is_explained(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  return std::any_of(diagnosis.explained.begin(), diagnosis.explained.end(),
                     [&](const diagnose::ExplainedCause& cause) { return cause.id == id; });
}

/// ", c = 0.0031 ± 0.0002 kg/m,": the fitted parameters of the effect as a whole; empty if there are none.
std::string sizes_aside(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  const diagnose::DiagnosedEffect* const effect = effect_in(diagnosis, id);
  if (effect == nullptr) return {};
  std::vector<std::string> sizes;
  for (const diagnose::DiagnosedParameter& parameter : effect->parameters) {
    const bool told = !parameter.text.empty() || (!parameter.why && parameter.sd > 0.0);
    if (told && parameter.key.find('.') == std::string::npos && sizes.size() < kSizesTold) {
      sizes.push_back(parameter_text(parameter));
    }
  }
  return sizes.empty() ? std::string() : ", " + list_of(sizes) + ",";
}

std::string left_words(const diagnose::GapRemainder& remainder) {
  if (leaves_nothing(remainder)) return "nothing is left above the noise";
  if (remainder.share < kNothing) return fmt::format("less than 0.1 % remains, {}", over_noise_text(remainder.gap));
  return fmt::format("{} remains, {}", share_text(remainder.share), over_noise_text(remainder.gap));
}

/// "Quadratic drag, c = …, explains 91 % (…) of the gap on clips that were held out; …"; with `gap_named`, the gap has
/// already been mentioned.
std::string causes_words(const diagnose::Diagnosis& diagnosis, bool gap_named = false) {
  std::string text;
  double gap_before = 0.0;  // before this cause, for the second and later ones
  for (const diagnose::ExplainedCause& cause : diagnosis.explained) {
    const std::string name = effect_name(cause.id);
    const std::string share = share_text(cause.share, cause.share_interval95);
    const bool first = text.empty();
    const bool all = cause.share > 1.0;  // the remaining gap is below the noise by chance
    const double before = std::exchange(gap_before, cause.gap_after);
    // Beside a drag that takes all but a trifle, a share of the whole gap says nothing.
    if (!first && cause.share < kNothing && cause.gap_after < before) {
      text += fmt::format("; {}{} {} what is left from {} to {}", name, sizes_aside(diagnosis, cause.id),
                          is_plural(name) ? "reduce" : "reduces", base::number_text(before, 3),
                          over_noise_text(cause.gap_after));
      continue;
    }
    text +=
        fmt::format("{}{}{} {} {}{}{}", first ? "" : "; ", first && !gap_named ? capital(name) : name,
                    sizes_aside(diagnosis, cause.id), is_plural(name) ? "explain" : "explains", first ? "" : "another ",
                    all ? "all" : share, first && !gap_named ? " of the gap on clips that were held out" : "");
  }
  if (diagnosis.remainder) text += "; " + left_words(*diagnosis.remainder);
  return text + ".";
}

std::string traces_words(const diagnose::Diagnosis& diagnosis) {
  const std::vector<std::string> names = effect_names(diagnosis.traces);
  if (names.empty()) return {};
  return fmt::format("Also detected, with no effect on K/m, µ or α: {}.", list_of(names));
}

/// The likeliest explanations that would take half of the gap or more, though none is likely enough to be named; empty
/// if there are none.
std::string likeliest_words(const diagnose::Diagnosis& diagnosis) {
  constexpr double kWorthTelling = 0.05;  // probability
  constexpr double kHalf = 0.5;
  constexpr std::size_t kMostTold = 3;
  if (!diagnosis.remainder) return {};
  const double gap = diagnosis.remainder->gap, excess = gap * gap - 1.0;
  std::vector<std::string> told;
  for (const diagnose::RankedExplanation& one : diagnosis.ranking) {
    if (told.size() == kMostTold || one.probability < kWorthTelling) break;
    if (one.explanation.unnamed || one.explanation.effects.empty() || !one.gap_after) continue;
    const double left = *one.gap_after * *one.gap_after - 1.0;
    if (!(left <= kHalf * excess)) continue;
    told.push_back(
        fmt::format("{} ({}), with which the gap would be {}{}", list_of(effect_names(one.explanation.effects)),
                    percent(one.probability), base::number_text(*one.gap_after, 3),
                    told.empty() ? fmt::format(" in place of {} times the noise", base::number_text(gap, 3)) : ""));
  }
  return fmt::format("{}", fmt::join(told, "; "));
}

std::string unknown_sequence_words(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.explained.empty()) {
    if (const std::string likeliest = likeliest_words(diagnosis); !likeliest.empty()) {
      return "Something is missing, and no known effect is likely enough to be named. Likeliest: " + likeliest + ".";
    }
  }
  const std::string text = "Something is missing, and no known effect is likely to explain half of the held-out gap";
  if (!diagnosis.explained.empty()) return text + ": " + causes_words(diagnosis, true);
  return text + ". None reduces it by more than its uncertainty" +
         (diagnosis.remainder ? fmt::format(": it is {}.", over_noise_text(diagnosis.remainder->gap)) : ".");
}

/// What contradicts the named drag of air; empty if nothing does.
std::string contradicted_drag_words(const diagnose::Diagnosis& diagnosis) {
  const diagnose::FallsThroughAir* const falls = falls_through_air(diagnosis);
  if (falls == nullptr || !falls->viscous_leaves_less()) return {};
  return fmt::format(
      " A viscous drag alone would leave less, {} times the noise, though air does not brake like that: check the "
      "scale, the frame rate and the first positions.",
      base::number_text(falls->gaps->viscous, 3));
}

std::string configuration_label(const diagnose::RecoveredConfiguration& of,
                                const std::vector<diagnose::RecoveredConfiguration>& all) {
  const bool groups = std::any_of(all.begin(), all.end(), [&](const auto& other) { return other.group != of.group; });
  const bool is_named = !of.group.empty() && !of.is_named_by_incline;
  return fmt::format("{:.6g} kg, {:.4g}°", of.mass_kg, of.incline_deg) + (groups && is_named ? ", " + of.group : "");
}

}  // namespace

bool is_measured_without_drag(const diagnose::Diagnosis& diagnosis) {
  return falls_through_air(diagnosis) != nullptr;
}

bool leaves_noise_alone(const diagnose::Diagnosis& diagnosis) {
  constexpr double kByChance = 2.0;  // standard errors
  return !diagnosis.gap || diagnosis.gap->before < 1.0 + kByChance * diagnosis.gap->standard_error;
}

bool leaves_nothing(const diagnose::GapRemainder& remainder) {
  constexpr double kAboveNoise = 1.1;  // a gap; of a gap of hundreds a share of nothing may be as much as ten
  return remainder.share < kNothing && remainder.gap < kAboveNoise;
}

std::string share_text(double share, const std::optional<diagnose::GapInterval>& interval) {
  const bool is_trifle = interval && std::abs(share) < kNothing;
  if (is_trifle && std::max(std::abs(interval->low), std::abs(interval->high)) < kNearEnd) {
    return "less than 0.1 %";
  }
  constexpr double kTenth = 1e-3;  // a tenth of a percent
  if (interval && interval->low > 1.0 - kTenth && share < 1.0 && share > 1.0 - kTenth &&
      interval->high < 1.0 + kTenth) {
    return "over 99.9 %";
  }
  const bool near_end = share < kNearEnd || share > 1.0 - kNearEnd;
  const bool is_end = std::abs(share) < kNothing || std::abs(share - 1.0) < kNothing;
  const int decimals = near_end && (interval || !is_end) ? 1 : 0;
  const auto percent = [&](double of) {  // rounded, and 0 rather than -0
    const double steps = std::pow(10.0, decimals);
    return std::round(kPercent * of * steps) / steps + 0.0;
  };
  std::string text = fmt::format("{:.{}f} %", percent(share), decimals);
  if (interval) {
    // A cause that takes the gap below its floor does so by chance: no share is above 100 %.
    text += fmt::format(" ({:.{}f} to {:.{}f} %)", percent(std::min(1.0, interval->low)), decimals,
                        percent(std::min(1.0, interval->high)), decimals);
  }
  return text;
}

std::string over_noise_text(double gap) {
  return base::number_text(gap, 3) + " times the noise";
}

std::string largest_words(const diagnose::GapRegion& region) {
  if (!region.at || !region.size_sd) return base::size_text(region.size, 2, region.unit);
  const std::string unit = base::name_and_unit(to_text(region.variable)).unit;
  return fmt::format("{} {} {}", base::size_and_sd_text(region.size, *region.size_sd, region.unit),
                     region.variable == diagnose::GapVariable::time ? "after" : "at",
                     base::size_text(*region.at, 3, unit));
}

std::string region_words(const diagnose::GapRegion& region) {
  const std::string unit = base::name_and_unit(to_text(region.variable)).unit;
  const auto range = [&](const char* of) {
    const std::string from = base::number_text(region.from, 3), to = base::number_text(region.to, 3);
    if (from == to) return fmt::format("at {} of about {} {}", of, from, unit);
    return fmt::format("at {} from {} to {} {}", of, from, to, unit);
  };
  const auto told = [&]() -> std::string {
    switch (region.variable) {
      case diagnose::GapVariable::acceleration:
        return range("accelerations");
      case diagnose::GapVariable::clip:
        return "over the clips";
      case diagnose::GapVariable::direction:
        return region.from < 0.0 ? "in the motion with v < 0" : "in the motion with v > 0";
      case diagnose::GapVariable::set_up:
        return "in one of the set-ups";
      case diagnose::GapVariable::mass:
        return region.from == region.to ? fmt::format("with {:.6g} kg", region.from) : range("masses");
      case diagnose::GapVariable::time:
        return range("times") + (region.clip.empty() ? " after the start of the clip" : " after the start");
      case diagnose::GapVariable::column:
        return range("image columns");
      case diagnose::GapVariable::speed:
        return range("speeds");
      case diagnose::GapVariable::row:
        return range("image rows");
      case diagnose::GapVariable::position:
        return range("positions");
    }
    return {};
  };
  const std::string text = told();
  return region.clip.empty() ? text : text + " of clip " + region.clip;
}

std::string holds_within_words(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.levels || !diagnosis.levels->holds_within || !diagnosis.levels->configuration) return {};
  constexpr double kMostGapThatHolds = 1.5;  // times the noise: a law with a larger gap only fits better there
  const double within = *diagnosis.levels->configuration;
  const std::string here = base::number_text(within, 3), across = base::number_text(diagnosis.levels->all, 3);
  if (within < kMostGapThatHolds) {
    return fmt::format("The law holds within each configuration (gap {}); across them it does not ({}).", here, across);
  }
  return fmt::format("The law fits far better within each configuration (gap {}) than across them ({}).", here, across);
}

std::string sequence_words(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  switch (diagnosis.verdict) {
    case diagnose::Verdict::none:
      if (diagnosis.traces.empty()) return {};
      text = leaves_noise_alone(diagnosis)
                 ? "Nothing that matters is missing."
                 : "Nothing is clearly missing, though what the nominal model leaves is more than the noise.";
      break;
    case diagnose::Verdict::effect:
      if (diagnosis.explained.empty()) return {};
      text = causes_words(diagnosis) + contradicted_drag_words(diagnosis);
      break;
    case diagnose::Verdict::unknown:
      if (diagnosis.explained.empty() && !diagnosis.remainder) return {};
      text = unknown_sequence_words(diagnosis);
      break;
  }
  const std::string level = holds_within_words(diagnosis), traces = traces_words(diagnosis);
  return (level.empty() ? "" : level + " ") + text + (traces.empty() ? "" : " " + traces);
}

std::string sureness_words(const diagnose::Diagnosis& diagnosis) {
  // First the effects that explain the gap, then those that are only seen.
  std::vector<std::string> alone, alone_beside;
  std::string text;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    const std::vector<diagnose::AlikeEffect> alike = told_alike(effect);
    if (alike.empty()) {
      const bool explains = diagnosis.explained.empty() || is_explained(diagnosis, effect.id);
      (explains ? alone : alone_beside).push_back(effect_name(effect.id) + " " + percent(effect.probability));
      continue;
    }
    std::vector<std::string> members;
    for (const diagnose::AlikeEffect& one : alike) {
      members.push_back(effect_name(one.id) + (one.probability ? fmt::format(" ({})", percent(*one.probability)) : ""));
    }
    text += fmt::format(" These data cannot tell {} apart; one of them acts with a probability of {}.",
                        list_of(members), percent(effect.joint_probability));
  }
  if (text.empty()) {
    alone.insert(alone.end(), alone_beside.begin(), alone_beside.end());
    alone_beside.clear();
  }
  if (!alone.empty()) text = fmt::format(" Probability: {}.", list_of(alone, ", ")) + text;
  if (!alone_beside.empty()) text += fmt::format(" Also likely: {}.", list_of(alone_beside, ", "));
  std::vector<std::string> besides, by_stated;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (!is_explained(diagnosis, effect.id)) (effect.by_stated ? by_stated : besides).push_back(effect_name(effect.id));
  }
  const auto verb_of = [](const std::vector<std::string>& names, const char* verb) {
    return std::string(verb) + (names.size() > 1 || is_plural(names.front()) ? "" : "s");
  };
  if (!by_stated.empty()) {
    text += fmt::format(" {} {} only in the stated inclination, which the motion contradicts without it.",
                        capital(list_of(by_stated)), verb_of(by_stated, "show"));
  }
  if (!besides.empty() && besides.size() + by_stated.size() < diagnosis.effects.size()) {
    text += fmt::format(" {} {} nothing to this gap.", capital(list_of(besides)), verb_of(besides, "contribute"));
  }
  return text.empty() ? text : text.substr(1);
}

std::string levels_words(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.levels || (!diagnosis.levels->configuration && !diagnosis.levels->clip)) return {};
  const diagnose::GapLevels& levels = *diagnosis.levels;
  const char* const gap = is_measured_without_drag(diagnosis) ? " separately, a fall without drag has a gap of"
                                                              : " separately, the nominal model has a gap of";
  std::string text = "With no clip held out: fitted to ";
  if (levels.clip) text += fmt::format("each clip{} {}; to ", gap, base::number_text(*levels.clip, 3));
  if (levels.configuration) {
    text += fmt::format("each configuration{} {}; to ", levels.clip ? "," : gap,
                        base::number_text(*levels.configuration, 3));
  }
  return text + fmt::format("all clips, {} (1 is the noise).", base::number_text(levels.all, 3));
}

std::string remainder_words(const diagnose::GapRemainder& of) {
  // Smaller scatters are traces of the search: 0.1 mm/s² is that of a friction coefficient by 0.00001.
  constexpr double kLeastForce_m_s2 = 1e-4, kLeastDrag = 1e-3;
  std::vector<std::string> scatter;
  if (of.clip_scatter_m_s2 >= kLeastForce_m_s2) {
    scatter.push_back("friction and inclination scatter by " + base::size_text(of.clip_scatter_m_s2, 2, "m/s²"));
  }
  if (of.drag_scatter >= kLeastDrag) {
    scatter.push_back(fmt::format("the drag {}by {} %", scatter.empty() ? "scatters " : "",
                                  base::number_text(kPercent * of.drag_scatter, 2)));
  }
  std::string text;
  if (of.acceleration_m_s2 > 0.0) {
    text = fmt::format("The remainder corresponds to a random acceleration of {} (rms) along the track.",
                       base::size_text(of.acceleration_m_s2, 2, "m/s²"));
  }
  if (!scatter.empty()) text += fmt::format("{}From clip to clip, {}.", text.empty() ? "" : " ", list_of(scatter));
  return text;
}

std::string clearest_words(const diagnose::GapRemainder& of, const std::string& subject) {
  if (of.regions.empty()) return {};
  const diagnose::GapRegion& region = of.regions.front();
  const std::string where = fmt::format("{} is clearest {}: {}", subject, region_words(region), to_text(region.what));
  if (region.lacking) return where + ". Its size cannot be determined from these data.";
  return fmt::format("{} of up to {}.", where, largest_words(region));
}

std::string with_words(const std::vector<std::string>& ids) {
  return ids.empty() ? "by the nominal model" : fmt::format("with {} in the model", list_of(effect_names(ids)));
}

std::vector<std::vector<std::string>> explained_rows(const diagnose::Diagnosis& diagnosis, bool ids) {
  if (diagnosis.explained.empty()) return {};
  std::vector<std::vector<std::string>> rows = {{"cause", "share of the gap", "gap after"}};
  for (const diagnose::ExplainedCause& cause : diagnosis.explained) {
    const std::string name = effect_name(cause.id);
    rows.push_back({ids && name != cause.id ? fmt::format("{} ({})", name, cause.id) : name,
                    share_text(cause.share, cause.share_interval95), base::digits_text(cause.gap_after, 3)});
  }
  if (diagnosis.remainder) {
    rows.push_back(
        {"remainder", share_text(diagnosis.remainder->share), base::digits_text(diagnosis.remainder->gap, 3)});
  }
  return rows;
}

namespace {

/// Why a quantity has no value, and in which configurations.
struct Reason {
  std::string symbol, why;
  std::vector<std::string> labels;
};

/// "µ of 0.335 kg, 90°: a fall has …"; one sentence for all quantities with the same reason.
std::vector<std::string> reasons_text(const std::vector<Reason>& reasons, std::size_t configurations) {
  std::vector<Reason> joined;
  for (const Reason& one : reasons) {
    const auto same = std::find_if(joined.begin(), joined.end(), [&](const Reason& other) {
      return other.symbol == one.symbol && other.why == one.why;
    });
    if (same == joined.end()) {
      joined.push_back(one);
    } else {
      same->labels.insert(same->labels.end(), one.labels.begin(), one.labels.end());
    }
  }
  std::vector<std::string> texts;
  for (const Reason& one : joined) {
    const bool all = one.labels.size() > 1 && one.labels.size() == configurations;
    texts.push_back(
        fmt::format("{} of {}: {}", one.symbol, all ? "all" : fmt::format("{}", fmt::join(one.labels, "; ")), one.why));
  }
  return texts;
}

}  // namespace

std::vector<RecoveredTable> recovered_tables(const diagnose::Diagnosis& diagnosis) {
  std::vector<RecoveredTable> tables;
  std::map<std::size_t, std::vector<Reason>> reasons;  // by table
  for (const diagnose::RecoveredConfiguration& of : diagnosis.recovered) {
    auto table = std::find_if(tables.begin(), tables.end(), [&](const auto& other) { return other.with == of.with; });
    if (table == tables.end()) {
      RecoveredTable next{of.with, {{"configuration"}}, {}};
      for (const QuantityName& name : kQuantities) next.rows.front().push_back(heading_of(name.key));
      table = tables.insert(tables.end(), std::move(next));
    }
    const std::string label = configuration_label(of, diagnosis.recovered);
    std::vector<std::string> row = {label};
    for (const QuantityName& name : kQuantities) {
      const core::Quantity& quantity = core::value_of(of, name.which);
      row.push_back(quantity.estimate ? base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) : "–");
      if (quantity.why) {
        reasons[static_cast<std::size_t>(table - tables.begin())].push_back(
            {std::string(name.symbol), why_words(quantity.why), {label}});
      }
    }
    table->rows.push_back(std::move(row));
  }
  for (const auto& [table, of] : reasons) tables[table].why = reasons_text(of, tables[table].rows.size() - 1);
  return tables;
}

std::vector<std::vector<std::string>> member_rows(const diagnose::DiagnosedEffect& effect) {
  std::vector<std::string> names, keys;
  const auto note = [](std::vector<std::string>& list, const std::string& one) {
    if (std::find(list.begin(), list.end(), one) == list.end()) list.push_back(one);
  };
  const auto split = [](const std::string& key) {
    const std::size_t at = key.find('.');
    return std::pair(key.substr(0, at), at == std::string::npos ? std::string() : key.substr(at + 1));
  };
  for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
    const auto [key, name] = split(parameter.key);
    if (name.empty()) continue;
    note(keys, key);
    note(names, name);
  }
  if (names.empty()) return {};
  std::vector<std::vector<std::string>> rows = {{""}};
  for (const std::string& key : keys) {
    const NamedUnit of = name_and_unit(key);
    rows.front().push_back(with_unit(of.name == "mu" ? "µ" : of.name == "k" ? "K" : of.name, of.unit));
  }
  for (const std::string& name : names) {
    std::vector<std::string> row = {name};
    for (const std::string& key : keys) {
      const auto found =
          std::find_if(effect.parameters.begin(), effect.parameters.end(),
                       [&](const diagnose::DiagnosedParameter& one) { return one.key == key + "." + name; });
      const bool known = found != effect.parameters.end() && !found->why;
      row.push_back(known ? base::value_and_sd_text(found->value, found->sd) : "–");
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace glidelab::report
