#include "report/diagnosis/diagnosis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/number_text.h"
#include "diagnose/effects/effect_list.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/diagnosis_words.h"
#include "report/diagnosis/gap_plots.h"
#include "report/diagnosis/line_report.h"
#include "report/diagnosis/verdict_words.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kRankedRows = 12;

/// The number on a tile is of the effect however it acts; the chart has each explanation by itself.
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
      std::string names;
      for (const diagnose::AlikeEffect& one : effect.alike)
        names += (names.empty() ? "one of: " : ", ") + effect_name(one.id);
      text += tile(probability_text(effect.joint_probability),
                   (names.empty() ? effect_name(effect.id) : names) + beside_others(diagnosis, effect));
    }
  } else {
    text += tile(verdict_id(diagnosis.verdict), "verdict");
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
    table.row({effect_html(effect.id), escape(effect.stage), probability_text(effect.probability),
               size.empty() ? "–" : size, same.empty() ? "–" : same,
               same.empty() ? "–" : probability_text(effect.joint_probability)});
  }
  return table.empty() ? "" : table.str();
}

std::string ranking_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"explanation", "probability", "ln evidence over the nominal model", "over the likeliest here"});
  double likeliest = 0.0;  // huge gains that print alike are told apart by how far they are below the largest
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
  constexpr double kTenths = 100.0;  // beyond, a tenth of a standard deviation tells nothing
  if (std::abs(*z) >= kTenths) return fmt::format("{}{}", *z > 0.0 ? "+" : "", base::number_text(*z, 3));
  return base::error_text(*z, 1.0);
}

std::string quantity_text(const std::optional<diagnose::DiagnosedParameter>& of) {
  return of ? size_and_sd_text(of->value, of->sd, name_and_unit(of->key).unit) : std::string("–");
}

std::string parameter_table(const diagnose::GapSizes& gap) {
  HtmlTable table({"parameter", "of", "compared with", "alone", "together", "standard deviations off, before", "after"},
                  3);
  for (const auto& p : gap.parameters) {
    const std::string symbol = p.quantity == "k_n_s_m" ? "K" : symbol_of(p.quantity);
    table.row({escape(symbol), escape(p.group), escape(p.against), quantity_text(p.alone), quantity_text(p.together),
               z_text(p.z_before), z_text(p.z_after)});
  }
  return table.empty() ? "" : table.str();
}

std::string gap_tables(const diagnose::GapSizes& gap, bool one) {
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
      "<p class=\"soft\">Root mean square of residuals over their predicted scatter; at the noise floor it is 1 ± "
      "{}. {} {}{}</p>\n",
      base::number_text(gap.standard_error, 2),
      gap.shrink ? "The gap shrinks by " + shrink_text(gap) + " of what is above the floor."
                 : std::string("It is at the floor."),
      !over_clips.too_few
          ? "The intervals tell how much these numbers would differ with other clips of the same kind (jackknife: each "
            "clip left out of the mean in turn)."
          : too_few_words(over_clips) + ".",
      gap.acceleration_before ? " Accelerations are measured minus modelled, both smoothed as in the analysis, noise "
                                "included."
                              : "");
  return text + parameter_table(gap);
}

/// What was looked for in the images, what is there first.
std::string picture_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"looked for", "seen", "what the images show"}, 3);
  for (const bool seen : {true, false}) {
    for (const diagnose::PictureFinding& finding : diagnosis.pictures) {
      if (finding.seen == seen) table.row({effect_html(finding.id), seen ? "yes" : "no", escape(finding.words)});
    }
  }
  return table.str();
}

/// Of what images show, the unit is a parameter's key.
std::string region_size(const diagnose::GapRegion& region) {
  const NamedUnit of = name_and_unit(region.unit);
  const std::string& unit = of.unit.empty() ? region.unit : of.unit;
  return region.size_sd ? size_and_sd_text(region.size, *region.size_sd, unit) : size_text(region.size, 2, unit);
}

std::string region_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"over", "what", "from", "to", "largest", "at", "size / sd, where surest"}, 2);
  for (const diagnose::GapRegion& region : diagnosis.regions) {
    table.row({escape(axis_of(region.variable) + (region.clip.empty() ? "" : " of " + region.clip)),
               escape(region.what), base::number_text(region.from, 3), base::number_text(region.to, 3),
               region.lacking ? "not known" : escape(region_size(region)),
               region.at && !region.lacking ? base::number_text(*region.at, 3) : "–",
               base::number_text(region.excess, 2)});
  }
  return table.empty() ? "" : table.str();
}

Html twin_section(const diagnose::Diagnosis& diagnosis, const std::vector<validate::TwinMotion>& twin) {
  Html text = std::string(
      "<h2>The twin compared with the data</h2>\n<p>The twin is a simulation of the fitted motions. Its positions are "
      "exact apart from noise like that of the data; of the effects of a camera, it includes only a wrong scale or "
      "perspective.</p>\n");
  for (const diagnose::TwinLack& lack : diagnosis.twin_lacks) {
    text += fmt::format("<p class=\"note\">Not in the twin: {} ({}).</p>\n", escape(lack.what), escape(lack.why));
  }
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id != diagnose::ids::rolling_shutter && effect.id != diagnose::ids::camera_motion) continue;
    text +=
        fmt::format("<p class=\"note\">{} acts only in the twin's images: here the data are off by what it does.</p>\n",
                    effect_html(effect.id));
  }
  return text + figures(twin_plots(twin));
}

}  // namespace

Page diagnosis_report(const std::string& title, const diagnose::Diagnosis& diagnosis,
                      const std::vector<validate::TwinMotion>& twin) {
  if (diagnosis.lines) return line_report(title, diagnosis);
  Html body = fmt::format("<h1>{}</h1>\n<p class=\"soft\">Diagnosis by Glidelab.</p>\n", escape(title));
  body += tiles(diagnosis);
  body += diagnosis_meaning(diagnosis);
  body += "<h2>The verdict</h2>\n" + effect_table(diagnosis) + figures(verdict_plots(diagnosis));
  const std::vector<Plot> domains = domain_plots(diagnosis);
  if (!domains.empty()) {
    body += "<h2>How large the gap is</h2>\n" + figures(domains) + figures(phase_gap_plots(diagnosis));
  }
  body += "<h2>Where the gap lies</h2>\n" + figures(where_plots(diagnosis)) + figures(residual_maps(diagnosis)) +
          region_table(diagnosis);
  if (!twin.empty()) body += twin_section(diagnosis, twin);
  if (!diagnosis.pictures.empty()) {
    body +=
        "<h2>What the images show</h2>\n<p>Some faults of a camera hardly shift the positions and show in the images "
        "themselves. Each is looked for, whether or not the positions call for it.</p>\n" +
        picture_table(diagnosis) + figures(picture_plots(diagnosis));
  }
  const std::vector<Plot> alike = isolability_plots(diagnosis.isolability);
  if (!alike.empty()) body += "<h2>What these data can tell apart</h2>\n" + figures(alike);
  body += "<h2>Numbers</h2>\n" + ranking_table(diagnosis);
  if (diagnosis.gap) body += "<h3>The gap, clip by clip</h3>\n" + gap_tables(*diagnosis.gap, one_model(diagnosis));
  body +=
      "<h2>Method</h2>\n<p>The nominal model, m dv/dt = m g sin α − K v − sign(v) µ m g cos α, is fitted to all "
      "positions of all clips at once: one K and one µ, one inclination for each set-up, a start for each clip. The "
      "noise is estimated from neighbouring positions alone. Every effect of the list is added to the model, alone and "
      "in pairs. The evidence for each is its likelihood averaged over the sizes that it may have (equal odds for each "
      "factor of ten above what can be seen). Smooth forces and displacements without a name (over position, speed and "
      "time) and differences between clips, masses and set-ups compete with the effects, and act alongside them: where "
      "one of those explains more, the verdict is “unknown”. For the gap, each clip in turn is taken out of the fit to "
      "all clips, to first order: sizes are learnt from the other clips. What was found by searching (which of several "
      "waves or positions, which frames are lost, the shape of a curve without a name) comes from all clips.</p>\n";
  return page(title, body);
}

namespace {

constexpr std::size_t kRanked = 6;
constexpr std::size_t kLineWidth = 110;

std::string wrapped(const std::string& text) {
  std::string lines, line;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    if (!line.empty() && line.size() + 1 + word.size() > kLineWidth) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = space + 1;
  }
  return lines + line + "\n";
}

std::string gap_lines(const diagnose::GapSizes& gap, const char* of) {
  const diagnose::GapIntervals& over_clips = gap.interval95;
  std::string text;
  if (gap.shrink) text += "  it shrinks by " + shrink_text(gap) + " of what is above the floor\n";
  if (!over_clips.too_few) {
    text += fmt::format("  95 % over {}: {} before, {} after\n", of, interval_text(over_clips.before),
                        interval_text(over_clips.after));
  } else {
    text += "  " + too_few_words(over_clips) + "\n";
  }
  if (!gap.acceleration_before || !gap.acceleration_after) return text;
  const auto acceleration = [&](double size, const std::optional<diagnose::GapInterval>& interval) {
    return base::number_text(size, 3) + " m/s²" + (interval ? " (" + interval_text(interval) + ")" : "");
  };
  return text + fmt::format("  in acceleration {} before, {} after, noise included\n",
                            acceleration(*gap.acceleration_before, over_clips.acceleration_before),
                            acceleration(*gap.acceleration_after, over_clips.acceleration_after));
}

}  // namespace

std::string diagnosis_text(const diagnose::Diagnosis& diagnosis) {
  std::string text =
      fmt::format("verdict: {}\n\n{}\n", verdict_id(diagnosis.verdict), wrapped(verdict_words(diagnosis)));
  std::vector<std::vector<std::string>> rows = {{"explanation", "probability", "ln evidence"}};
  rows.push_back({"none", fmt::format("{:.3f}", diagnosis.none), "0"});
  rows.push_back({"unknown", fmt::format("{:.3f}", diagnosis.unknown), ""});
  for (std::size_t i = 0; i < diagnosis.ranking.size() && i < kRanked; ++i) {
    const auto& ranked = diagnosis.ranking[i];
    rows.push_back({explanation_id(ranked.explanation), fmt::format("{:.3f}", ranked.probability),
                    ranked.left_out ? "not weighed" : base::gain_text(ranked.log_evidence_gain)});
  }
  text += text_table(diagnosis.lines ? line_rows(*diagnosis.lines) : rows, diagnosis.lines ? 2 : 1) + "\n";
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      text += fmt::format("{}: {}\n", effect.id, parameter_text(parameter));
    }
  }
  for (const diagnose::PictureFinding& finding : diagnosis.pictures) {
    if (finding.seen) text += "pictures: " + wrapped(finding.words);
  }
  if (diagnosis.gap) {
    text += fmt::format("gap of held-out {}: {:.3f} before, {:.3f} after (floor 1)\n",
                        diagnosis.lines ? "lines" : "clips", diagnosis.gap->before, diagnosis.gap->after);
    text += gap_lines(*diagnosis.gap, diagnosis.lines ? "lines" : "clips");
  }
  text += "\nnext: " + wrapped(next_step_words(diagnosis.next));
  for (const std::string& note : notes_words(diagnosis.notes)) text += "note: " + wrapped(note);
  return text;
}

}  // namespace glidelab::report
