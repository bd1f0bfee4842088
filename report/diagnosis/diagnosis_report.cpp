#include "report/diagnosis/diagnosis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "base/text/wrapped_text.h"
#include "diagnose/effects/effect_library.h"
#include "report/analysis/left_out_clips.h"
#include "report/diagnosis/diagnosis_answer.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/gap_plots.h"
#include "report/diagnosis/line_report.h"
#include "report/diagnosis/words/cause_words.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/diagnosis/words/image_words.h"
#include "report/diagnosis/words/next_step_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kRankedRows = 12;

/// The number on a tile covers all forms of the effect; the chart shows each explanation separately.
std::string beside_others(const diagnose::Diagnosis& diagnosis, const diagnose::DiagnosedEffect& effect) {
  const bool joined = std::any_of(diagnosis.ranking.begin(), diagnosis.ranking.end(), [&](const auto& ranked) {
    return ranked.explanation.effects.size() > 1 && ranked.explanation.holds(effect.id);
  });
  return joined ? ", alone or with another" : "";
}

std::string tiles(const diagnose::Diagnosis& diagnosis) {
  std::string text = "<div class=\"tiles\">";
  if (diagnosis.verdict == diagnose::Verdict::effect) {
    for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
      constexpr std::size_t kMostOnTile = 3;
      const std::size_t named = effect.alike.size() > kMostOnTile + 1 ? kMostOnTile : effect.alike.size();
      std::string names;
      for (const diagnose::AlikeEffect& one : std::span(effect.alike).first(named))
        names += (names.empty() ? "one of: " : ", ") + effect_name(one.id);
      if (named < effect.alike.size()) names += fmt::format(" and {} others", effect.alike.size() - named);
      text += tile(probability_text(effect.joint_probability),
                   (names.empty() ? effect_name(effect.id) : names) + beside_others(diagnosis, effect));
    }
  } else {
    text += tile(std::string(diagnose::verdict_id(diagnosis.verdict)), "verdict");
  }
  return text + common_tiles(diagnosis, "gap of held-out clips (1: noise)") + "</div>\n";
}

std::string effect_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"effect", "stage", "probability", "size", "indistinguishable from", "one of these, together"}, 2);
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    std::string size, same;
    for (const auto& p : effect.parameters) {
      size += size.empty() ? "" : "<br>";
      size += symbols_html(parameter_text(p));
    }
    if (!size.empty() && !effect_meaning(effect.id).empty()) {
      size += fmt::format("<br><small>{}</small>", symbols_html(effect_meaning(effect.id)));
    }
    for (const std::string& id : effect.equivalent_to) same += (same.empty() ? "" : ", ") + effect_html(id);
    table.row({effect_html(effect.id), escape(to_text(effect.stage)), probability_text(effect.probability),
               size.empty() ? "–" : size, same.empty() ? "–" : same,
               same.empty() ? "–" : probability_text(effect.joint_probability)});
  }
  return table.empty() ? "" : table.str();
}

std::string ranking_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"explanation", "probability", "log evidence over the nominal model", "over the likeliest here"});
  double likeliest = 0.0;  // huge gains that print alike are distinguished by their distance below the largest
  for (const auto& ranked : diagnosis.ranking) {
    if (!ranked.left_out) likeliest = std::max(likeliest, ranked.log_evidence_gain);
  }
  table.row({effect_html("none"), probability_text(diagnosis.none), "0", base::gain_text(0.0 - likeliest)});
  table.row({effect_html("unknown"), probability_text(diagnosis.unknown), "–", "–"});
  for (std::size_t i = 0; i < diagnosis.ranking.size() && i < kRankedRows; ++i) {
    const auto& ranked = diagnosis.ranking[i];
    const bool weighed = !ranked.left_out;
    table.row({explanation_html(ranked.explanation), probability_text(ranked.probability),
               weighed ? base::gain_text(ranked.log_evidence_gain) : "not weighed",
               weighed ? base::gain_text(ranked.log_evidence_gain - likeliest) : "–"});
  }
  return table.str();
}

std::string z_text(const std::optional<double>& z) {
  if (!z) return "–";
  constexpr double kTenths = 100.0;  // beyond this, a tenth of a standard deviation is meaningless
  if (std::abs(*z) >= kTenths) return fmt::format("{}{}", *z > 0.0 ? "+" : "", base::number_text(*z, 3));
  return base::error_text(*z, 1.0);
}

/// Parameters of the nominal model, by parts of the data. If something is missing, its fits are not a property of the
/// glider, however small their standard deviation: they are then shown without it, and not at all next to recovered
/// values.
std::string parameter_table(const diagnose::Diagnosis& diagnosis) {
  const std::vector<diagnose::GapOfParameter>& parameters = diagnosis.gap->parameters;
  if (parameters.empty()) return {};
  const bool missing = diagnosis.verdict != diagnose::Verdict::none;
  const bool fits = !missing || diagnosis.recovered.empty();
  std::vector<std::string> header = {"parameter", "of", "compared with"};
  if (fits) header.insert(header.end(), {"nominal model, alone", "together"});
  header.insert(header.end(), {"standard deviations apart, before", "after"});
  const auto fit = [&](const std::optional<diagnose::DiagnosedParameter>& of) {
    if (!of) return std::string("–");
    constexpr int kDigits = 3;
    const std::string unit = name_and_unit(of->key).unit;
    return missing ? size_text(of->value, kDigits, unit) : size_and_sd_text(of->value, of->sd, unit);
  };
  HtmlTable table(header, 3);
  for (const diagnose::GapOfParameter& p : parameters) {
    const std::string symbol = p.quantity == "k_n_s_m" ? "K" : symbol_of(p.quantity);
    std::vector<std::string> row = {escape(symbol), escape(p.group), escape(std::string(to_text(p.against)))};
    if (fits) row.insert(row.end(), {fit(p.alone), fit(p.together)});
    row.insert(row.end(), {z_text(p.z_before), z_text(p.z_after)});
    table.row(row);
  }
  std::string text = table.str();
  if (missing && fits) {
    text +=
        "<p class=\"soft\">Alone: fitted to that part of the data; together: to all. The nominal model leaves out what "
        "is missing, so these numbers are not those of the glider or the track, and have no standard deviation "
        "here.</p>\n";
  }
  return text;
}

std::string gap_tables(const diagnose::Diagnosis& diagnosis) {
  const diagnose::GapSizes& gap = *diagnosis.gap;
  const bool one = one_model(diagnosis);
  HtmlTable clips(one ? std::vector<std::string>{"held out", "gap"}
                      : std::vector<std::string>{"held out", "before", "after"});
  const auto row = [&](const std::string& name, const std::string& before, const std::string& after) {
    clips.row(one ? std::vector<std::string>{name, before} : std::vector<std::string>{name, before, after});
  };
  for (std::size_t c = 0; c < gap.held_out.size(); ++c) {
    row(escape(gap.held_out[c]), base::digits_text(gap.before_by_clip[c], 3),
        base::digits_text(gap.after_by_clip[c], 3));
  }
  const diagnose::GapIntervals& over_clips = gap.interval95;
  row("all", base::digits_text(gap.before, 3), base::digits_text(gap.after, 3));
  row("all: 95 % over clips", interval_text(over_clips.before), interval_text(over_clips.after));
  if (gap.acceleration_before && gap.acceleration_after) {
    row("acceleration, all (m/s²)", base::digits_text(*gap.acceleration_before, 3),
        base::digits_text(*gap.acceleration_after, 3));
    row("acceleration: 95 % over clips", interval_text(over_clips.acceleration_before),
        interval_text(over_clips.acceleration_after));
  }
  std::string text = clips.str();
  text += fmt::format(
      "<p class=\"soft\">Root mean square of residuals over their predicted scatter; at the noise floor it is {} ± "
      "{}{}. {} {}{}</p>\n",
      base::number_text(gap.floor, 3), base::number_text(gap.standard_error, 2),
      gap.floor < 1.0
          ? " (below 1, because what the causes remove had raised the noise estimated from neighbouring positions)"
          : "",
      gap.shrink
          ? "The gap " + shrink_text(gap) + " of its distance from the floor." +
                (diagnosis.explained.empty() ? ""
                                             : " Shares are of its square less that of the floor, since variances add.")
          : std::string("It is at the floor."),
      !over_clips.too_few
          ? "The intervals show how much these numbers would differ with other clips of the same kind (jackknife: each "
            "clip left out of the mean in turn)."
          : too_few_words(over_clips) + ".",
      gap.acceleration_before ? " Accelerations are measured minus modelled, both smoothed as in the analysis, noise "
                                "included."
                              : "");
  return text + parameter_table(diagnosis);
}

/// The effects searched for in the images, those present first.
std::string image_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"looked for", "seen", "what the images show"}, 3);
  for (const bool seen : {true, false}) {
    for (const diagnose::ImageFinding& finding : diagnosis.images) {
      if (finding.seen == seen)
        table.row({effect_html(finding.id), seen ? "yes" : "no", escape(image_words(finding.fact))});
    }
  }
  return table.str();
}

Html twin_section(const diagnose::Diagnosis& diagnosis, const std::vector<validate::TwinMotion>& twin) {
  Html text = std::string(
      "<p>The twin is a simulation of the fitted motions. Its positions are "
      "exact apart from noise like that of the data; of the effects of a camera, it includes only a wrong scale or "
      "perspective.</p>\n");
  for (const diagnose::TwinLack& lack : diagnosis.twin_lacks) {
    text += fmt::format("<p class=\"note\">Not in the twin: {} ({}).</p>\n", escape(lack.what), escape(lack.why));
  }
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    const diagnose::EffectInfo* const info = diagnose::find_effect(effect.id);
    if (info == nullptr || !info->in_images || !diagnose::takes_part_of_gap(info->search)) continue;
    text += fmt::format(
        "<p class=\"note\">{} acts only in the twin's images, so the comparison here differs by its effect.</p>\n",
        effect_html(effect.id));
  }
  return text + figures(twin_plots(twin));
}

constexpr const char* kMethod =
    "<p>The nominal model, m dv/dt = m g sin α − K v − sign(v) µ m g cos α, is fitted to all positions of all clips at "
    "once: one K and one µ, one inclination for each set-up, a start for each clip. The noise is estimated from "
    "neighbouring positions alone. Every effect on the list is added to the model, alone and in pairs. The evidence "
    "for each is its likelihood averaged over the sizes that it may have (equal odds for each factor of ten above "
    "what can be detected). Smooth forces and displacements without a name (over position, speed and time) and "
    "differences between clips, masses and set-ups compete with the effects, and act alongside them: where one of "
    "those explains more, the verdict is “unknown”. For the gap, each clip in turn is taken out of the fit to all "
    "clips, to first order: sizes are learnt from the other clips. What was found by searching (which of several "
    "waves or positions, which frames are lost, the shape of a curve without a name) comes from all clips.</p>\n";

Html gap_parts(const diagnose::Diagnosis& diagnosis) {
  const std::vector<Plot> domains = domain_plots(diagnosis);
  Html html;
  if (!domains.empty()) {
    html += folded("How large the gap is: positions, accelerations, parameters",
                   figures(domains) + figures(phase_gap_plots(diagnosis)));
  }
  html += folded("Where the gap of the nominal model lies: residuals against position, speed and time",
                 figures(where_plots(diagnosis)) + figures(residual_maps(diagnosis)) + region_table(diagnosis.regions));
  return html;
}

Html image_part(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.images.empty()) return {};
  return "<p>Some faults of a camera hardly shift the positions and show in the images themselves. Each is looked for, "
         "whether or not the positions call for it.</p>\n" +
         image_table(diagnosis) + figures(image_plots(diagnosis));
}

}  // namespace

Page diagnosis_report(const std::string& title, const diagnose::Diagnosis& diagnosis,
                      const std::vector<validate::TwinMotion>& twin) {
  if (diagnosis.lines) return line_report(title, diagnosis);
  Html body = question_heading(title, kDiagnosisQuestion);
  body += left_out_html(diagnosis.left_out);
  body += diagnosis_meaning(diagnosis);
  // The sentence about the causes contains what the tiles would say.
  const bool told = !sequence_words(diagnosis).empty();
  if (!told) body += tiles(diagnosis);
  body += answer_sections(diagnosis);
  body += "<h2>Details</h2>\n";
  body += folded(
      "Probability of each explanation, and the gap of each clip",
      Html(told ? tiles(diagnosis) : std::string()) + effect_table(diagnosis) + figures(verdict_plots(diagnosis)));
  body += gap_parts(diagnosis);
  if (!twin.empty()) body += folded("The twin compared with the data", twin_section(diagnosis, twin));
  body += folded("What the images show", image_part(diagnosis));
  body += folded("What these data can tell apart", figures(isolability_plots(diagnosis.isolability)));
  std::string numbers = ranking_table(diagnosis);
  if (diagnosis.gap) numbers += "<h3>The gap, clip by clip</h3>\n" + gap_tables(diagnosis);
  body += folded("Numbers: evidence, and the gap clip by clip", numbers);
  body += folded(fmt::format("Notes ({})", diagnosis.notes.size()), note_paragraphs(diagnosis));
  body += folded("Method", kMethod);
  return page(title, body);
}

namespace {

constexpr std::size_t kRanked = 6;

std::string wrapped(const std::string& text) {
  return base::wrapped(text, base::kTerminalWidth) + "\n";
}

/// The likeliest explanations in words; their log evidence is on the page.
std::string ranking_text(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::vector<std::string>> rows = {{"probability", "explanation"}};
  rows.push_back({fmt::format("{:.3f}", diagnosis.none), effect_name("none")});
  rows.push_back({fmt::format("{:.3f}", diagnosis.unknown), effect_name("unknown")});
  for (std::size_t i = 0; i < diagnosis.ranking.size() && i < kRanked; ++i) {
    const auto& ranked = diagnosis.ranking[i];
    rows.push_back({ranked.left_out ? "not weighed" : fmt::format("{:.3f}", ranked.probability),
                    explanation_name(ranked.explanation)});
  }
  return text_table(rows, 2);
}

/// The gap of held-out clips or lines, before and after what the verdict adds to the model; if it adds nothing, once.
std::string gap_lines(const diagnose::GapSizes& gap, const char* of, bool one, bool shares) {
  const diagnose::GapIntervals& over_clips = gap.interval95;
  std::string text = one ? fmt::format("gap of held-out {}: {:.3f} (floor {:.3g})\n", of, gap.before, gap.floor)
                         : fmt::format("gap of held-out {}: {:.3f} before, {:.3f} after (floor {:.3g})\n", of,
                                       gap.before, gap.after, gap.floor);
  if (gap.shrink && !one) {
    text += "  it " + shrink_text(gap) + " of its distance from the floor\n";
    if (shares) text += "  shares are of its square less that of the floor, since variances add\n";
  }
  const auto before_and_after = [&](const std::string& before, const std::string& after) {
    return one ? before : before + " before, " + after + " after";
  };
  if (!over_clips.too_few) {
    text += fmt::format("  95 % over {}: {}\n", of,
                        before_and_after(interval_text(over_clips.before), interval_text(over_clips.after)));
  } else if (!one) {
    text += "  " + too_few_words(over_clips) + "\n";
  }
  if (!gap.acceleration_before || !gap.acceleration_after) return text;
  const auto acceleration = [&](double size, const std::optional<diagnose::GapInterval>& interval) {
    return base::number_text(size, 3) + " m/s²" + (interval ? " (" + interval_text(interval) + ")" : "");
  };
  constexpr std::size_t kIndent = 4;
  const std::string line =
      fmt::format("  in acceleration {}, noise included",
                  before_and_after(acceleration(*gap.acceleration_before, over_clips.acceleration_before),
                                   acceleration(*gap.acceleration_after, over_clips.acceleration_after)));
  return text + base::wrapped(line, base::kTerminalWidth, kIndent) + "\n";
}

/// The individual values of each configuration, one table per effect.
std::vector<std::string> member_tables(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> tables;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (const auto rows = member_rows(effect); rows.size() > 2) {
      tables.push_back(effect_name(effect.id) + ":\n" + text_table(rows, 1));
    }
  }
  return tables;
}

/// Below the summary: each cause's share, the nature of the remainder, and the quantities with the causes in the model.
std::string sequence_lines(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  };
  if (const auto rows = explained_rows(diagnosis, true); !rows.empty()) add(text_table(rows, 1));
  if (diagnosis.remainder && !leaves_nothing(*diagnosis.remainder)) {
    std::string rest = remainder_words(*diagnosis.remainder);
    // For `unknown` the summary says where it lies.
    if (diagnosis.verdict == diagnose::Verdict::effect) {
      const std::string clearest = clearest_words(*diagnosis.remainder, rest.empty() ? "What is left" : "It");
      rest += (rest.empty() || clearest.empty() ? "" : " ") + clearest;
    }
    if (!rest.empty()) add(wrapped(rest));
  }
  for (const std::string& table : member_tables(diagnosis)) add(table);
  for (const RecoveredTable& table : recovered_tables(diagnosis)) {
    add(with_words(table.with) + ":\n" + text_table(table.rows, 1));
    for (const std::string& why : table.why) text += wrapped(base::printable_text(why));
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

std::string diagnosis_text(const diagnose::Diagnosis& diagnosis) {
  std::string text = left_out_text(diagnosis.left_out);
  text += fmt::format("{}verdict: {}\n\n", wrapped(verdict_words(diagnosis)), diagnose::verdict_id(diagnosis.verdict));
  const std::string sequence = diagnosis.lines ? std::string() : sequence_lines(diagnosis);
  if (!sequence.empty()) text += sequence + wrapped("next: " + next_step_words(diagnosis.next)) + "\n";
  if (diagnosis.lines) {
    if (!diagnosis.explained.empty()) text += text_table(explained_rows(diagnosis, true), 1) + "\n";
    for (const std::string& table : member_tables(diagnosis)) text += table + "\n";
  }
  text += (diagnosis.lines ? text_table(line_rows(*diagnosis.lines), 2) : ranking_text(diagnosis)) + "\n";
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      if ((!sequence.empty() || diagnosis.lines) && parameter.key.find('.') != std::string::npos)
        continue;  // in the table above
      text += fmt::format("{}: {}\n", effect_name(effect.id), parameter_text(parameter));
    }
  }
  for (const diagnose::ImageFinding& finding : diagnosis.images) {
    if (finding.seen) text += wrapped("images: " + image_words(finding.fact));
  }
  if (diagnosis.gap) {
    text += gap_lines(*diagnosis.gap, diagnosis.lines ? "lines" : "clips", one_model(diagnosis),
                      !diagnosis.explained.empty() && !diagnosis.lines);
  }
  if (sequence.empty()) text += "\n" + wrapped("next: " + next_step_words(diagnosis.next));
  for (const std::string& note : notes_words(diagnosis)) text += wrapped("note: " + note);
  return text;
}

}  // namespace glidelab::report
