#include "teach/page/teaching_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/text/number_text.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "teach/page/page_texts.h"
#include "teach/page/page_words.h"

namespace glidelab::teach {
namespace {

/// Written with the digits that a distance needs: up to 20, scaled by 2e4 m if k is small.
std::string array_of(const std::vector<double>& values) {
  return fmt::format("[{:.15g}]", fmt::join(values, ","));
}

std::string orbit_json(const Orbit& orbit) {
  std::vector<double> tau, u, distance, slope, bend;
  for (const OrbitPoint& point : orbit) {
    tau.push_back(point.tau);
    u.push_back(point.u);
    distance.push_back(point.distance);
    slope.push_back(point.slope);
    bend.push_back(point.bend);
  }
  return fmt::format("[{},{},{},{},{}]", array_of(tau), array_of(u), array_of(distance), array_of(slope),
                     array_of(bend));
}

std::string data_of(const PhaseExplorer& explorer) {
  std::string laws, references;
  for (const LawOrbits& law : explorer.laws) {
    laws += fmt::format("{}{{n:{},rising:{},falling:{},braking:{},free:{}}}", laws.empty() ? "" : ",\n", law.exponent,
                        orbit_json(law.rising), orbit_json(law.falling), orbit_json(law.braking), orbit_json(law.free));
  }
  for (const ReferenceMotion& motion : explorer.references) {
    references += fmt::format("{}{{law:{},k:{:.17g},mu:{:.17g},alpha:{:.17g},v0:{:.17g},t:{},x:{},v:{},a:{}}}",
                              references.empty() ? "" : ",\n", motion.law, motion.drag, motion.mu, motion.alpha_deg,
                              motion.v0_m_s, array_of(motion.t_s), array_of(motion.x_m), array_of(motion.v_m_s),
                              array_of(motion.a_m_s2));
  }
  return fmt::format("const DATA={{g:{:.17g},laws:[{}],references:[{}]}};\n", explorer.gravity_m_s2, laws, references);
}

}  // namespace

report::Page explorer_page(const PhaseExplorer& explorer, const std::string& language) {
  std::string body = fmt::format("<style>\n{}</style>\n{}", kExplorerStyle, kExplorerBody);
  body += "<script>\n'use strict';\n" + language_script(language) + data_of(explorer);
  for (const std::string_view script :
       {kExplorerMotion, kExplorerWords, kExplorerTrack, kExplorerKept, kExplorerLink, kExplorerView})
    body.append("\n").append(script);
  return report::page(text_in("en", "title"), body + "</script>\n");
}

namespace {

using report::color;
using report::data_uri;
using report::escape;

std::string numbers(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += fmt::format("{}{:.5g}", i == 0 ? "" : ",", values[i]);
  return text + "]";
}

}  // namespace

// Names are page text over the film: no text from a file enters the script.
std::string film_figure(const LawStudy& study, const LawFilm& film) {
  std::string data = fmt::format("{{\"rate\":{},\"motions\":[", kFramesPerSecond), names;
  for (std::size_t i = 0; i < study.motions.size(); ++i) {
    const LawMotion& motion = study.motions[i];
    data += fmt::format("{}{{\"color\":\"{}\",\"v\":{},\"a\":{}}}", i == 0 ? "" : ",", color(i), numbers(motion.v_m_s),
                        numbers(motion.a_m_s2));
    names +=
        fmt::format("<li style=\"--row:{:.4f}\"><i style=\"background:{}\"></i>{}</li>",
                    static_cast<double>(i) / static_cast<double>(study.motions.size()), color(i), escape(motion.clip));
  }
  data += "],\"equilibria\":[";
  for (const LawCurve& curve : study.curves) {
    for (const Equilibrium& at : curve.equilibria) {
      data += fmt::format("{}[{:.5g},{}]", data.back() == '[' ? "" : ",", at.v_m_s, at.stable);
    }
  }
  return fmt::format(
      "<div class=\"law\"><figure><div class=\"rows\" style=\"--tall:{:.4f}\"><video controls loop muted playsinline "
      "preload=\"auto\" "
      "width=\"{}\" height=\"{}\" aria-label=\"{}\" src=\"{}\"></video><ul>{}</ul></div>"
      "<figcaption>{}</figcaption></figure><figure><canvas role=\"img\" aria-label=\"a(v): {}\"></canvas>"
      "<figcaption>{}</figcaption></figure>"
      "<script type=\"application/json\">{}]}}</script></div>\n",
      film.width_px > 0 ? static_cast<double>(film.height_px) / film.width_px : 0.0, film.width_px, film.height_px,
      escape(study.name), data_uri("video/mp4", film.mp4), names,
      words("film_caption",
            {{"seconds", fmt::format("{:.1f}", static_cast<double>(film.frames - 1) / film.frame_rate_hz)}}),
      escape(study.name), words("film_points"), data);
}

std::string film_script(const std::string& language) {
  return fmt::format("<style>\n{}</style>\n<script>\n{}{}{}</script>\n", kFilmStyle, language_script(language),
                     kFilmScript, kLawsWords);
}

namespace {

using report::color;
using report::Drawing;
using report::escape;
using report::gnuplot_quoted;
using report::Html;
using report::kFrame;
using report::kGrey;
using report::meaning_section;
using report::Plot;
using report::PlotData;
using report::shortened;
using report::symbols_html;

PlotData columns(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
  PlotData data{name, {}};
  for (std::size_t i = 0; i < x.size(); ++i) data.rows.push_back({x[i], y[i]});
  return data;
}

Plot position_plot(const LawStudy& study) {
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) +
                       "set key top right font ',11' maxrows 4\nset xlabel 't (s)'\nset ylabel 'x (m)'\n"
                       "set offsets 0, graph 0.02, graph 0.06, graph 0.06\nset xrange [0:*]\nplot ";
  for (std::size_t i = 0; i < study.motions.size(); ++i) {
    data.push_back(columns(fmt::format("motion{}", i), study.motions[i].t_s, study.motions[i].x_m));
    script +=
        fmt::format("{}${} using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}", i == 0 ? "" : ", ", data.back().name,
                    i % 2 == 0 ? 1 : 2, color(i), gnuplot_quoted(shortened(study.motions[i].clip)));
  }
  return {Drawing{script, data}, "position_caption", "x(t) of " + study.name};
}

/// gnuplot: which tracks an equilibrium belongs to, where not all of the study's have it; below the dot if the first
/// has it, otherwise above.
std::string equilibrium_labels(const LawStudy& study) {
  std::map<double, std::vector<std::size_t>> tracks;
  for (std::size_t c = 0; c < study.curves.size(); ++c) {
    for (const Equilibrium& at : study.curves[c].equilibria) tracks[at.v_m_s].push_back(c);
  }
  std::string script;
  for (const auto& [v, those] : tracks) {
    if (those.size() == study.curves.size()) continue;
    std::string names;
    for (const std::size_t c : those) names += (names.empty() ? "" : ", ") + study.curves[c].configuration;
    const bool under = those.front() == 0;
    script += fmt::format("set label {} at {:.6g}, 0 {} offset {} font ',11' front\n", gnuplot_quoted(shortened(names)),
                          v, under ? "right" : "left", under ? "-0.9,-0.9" : "0.5,0.9");
  }
  return script;
}

Plot phase_plot(const LawStudy& study) {
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) +
                       "set key top right font ',11' maxrows 4\nset xlabel 'v (m/s)'\nset ylabel 'a (m/s²)'\n"
                       "set xzeroaxis lt 1 lc rgb '#777777'\nset yzeroaxis lt 1 lc rgb '#777777'\n" +
                       equilibrium_labels(study) + "plot ";
  bool first = true;
  const auto add = [&](PlotData block, const std::string& how) {
    if (block.rows.empty()) return;
    script += fmt::format("{}${} using 1:2 {}", first ? "" : ", ", block.name, how);
    first = false;
    data.push_back(std::move(block));
  };
  for (std::size_t c = 0; c < study.curves.size(); ++c) {
    const LawCurve& curve = study.curves[c];
    add(columns(fmt::format("up{}", c), curve.up_v_m_s, curve.up_a_m_s2),
        fmt::format("with lines lw 1 lc rgb '{}' notitle", kGrey));
    add(columns(fmt::format("down{}", c), curve.down_v_m_s, curve.down_a_m_s2),
        fmt::format("with lines lw 1 lc rgb '{}' notitle", kGrey));
    for (const std::size_t m : curve.motions) {
      const LawMotion& motion = study.motions[m];
      PlotData path{fmt::format("path{}", m), {}};
      for (std::size_t i = 0; i < motion.v_m_s.size(); ++i) {
        // A jump at v = 0 is not drawn as a line.
        if (i > 0 && motion.v_m_s[i] * motion.v_m_s[i - 1] <= 0.0 && motion.v_m_s[i - 1] != 0.0)
          path.rows.push_back({});
        path.rows.push_back({motion.v_m_s[i], motion.a_m_s2[i]});
      }
      add(std::move(path), fmt::format("with lines lw 2.4 dt {} lc rgb '{}' title {}", m % 2 == 0 ? 1 : 2, color(m),
                                       gnuplot_quoted(shortened(motion.clip))));
    }
    for (const bool stable : {true, false}) {
      PlotData points{fmt::format("{}{}", stable ? "stable" : "unstable", c), {}};
      for (const Equilibrium& at : curve.equilibria) {
        if (at.stable == stable) points.rows.push_back({at.v_m_s, 0.0});
      }
      add(std::move(points), fmt::format("with points pt {} ps 1.1 lw 1.6 lc rgb '#000000' notitle", stable ? 7 : 6));
    }
  }
  return {Drawing{script, data}, "phase_caption", "a(v) of " + study.name};
}

/// As in report::figures(), with captions in all languages.
Html plots_of(const LawStudy& study) {
  Html html("<div class=\"figures large\">\n");
  for (const Plot& plot : {position_plot(study), phase_plot(study)}) {
    html += "<figure>";
    html.plot(plot);
    html += fmt::format("<figcaption>{}</figcaption></figure>\n", words(plot.caption));
  }
  return html + "</div>\n";
}

std::string equilibrium_text(const LawStudy& study) {
  std::string text;
  for (const LawCurve& curve : study.curves) {
    std::string ends;
    for (const Equilibrium& at : curve.equilibria) {
      const std::string v = base::number_text(at.v_m_s, 4);
      const std::string end = at.v_m_s != 0.0 ? words(at.stable ? "tends_to_limit" : "unstable_at", {{"v", v}})
                              : !at.stable    ? words("may_stay")
                              : at.stops      ? words("comes_to_rest")
                                              : words("tends_to_rest");
      ends += (ends.empty() ? "" : ", ") + end;
    }
    text += fmt::format("{}{} ({:.3g}°): {}", text.empty() ? "" : "; ", escape(curve.configuration), curve.incline_deg,
                        ends.empty() ? words("no_limit") : ends);
  }
  return text;
}

/// The text at the head of a scenario, in all languages if it is one of the program's own.
std::string scenario_words(const std::string& text) {
  const std::string key = key_of(text, "scenario");
  return key.empty() ? symbols_html(text) : words(key);
}

}  // namespace

report::Page laws_report(const std::vector<LawStudy>& studies, const std::vector<LawFilm>& films,
                         const base::Progress& progress, const std::string& language) {
  if (films.size() != studies.size()) throw std::logic_error("not a film for each law");
  Html body = fmt::format(
      "<p class=\"language\"><select id=\"language\" data-label=\"language\"></select></p>\n<h1 "
      "data-text=\"laws_title\">{}</h1>\n<p>{}</p>\n",
      text_in("en", "laws_title"), words("laws_about"));
  std::string meaning = "<p>" + words("laws_meaning");
  if (std::ranges::any_of(studies, [](const LawStudy& study) { return study.x_apart_m.has_value(); })) {
    meaning += " " + words("laws_pair");
  }
  body += meaning_section(meaning + "</p>\n") + "<nav><ul>";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    body += fmt::format("<li><a href=\"#law{}\">{}</a></li>", i, scenario_words(studies[i].name));
  }
  body += "</ul></nav>\n";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    progress("drawing", static_cast<double>(i) / static_cast<double>(studies.size()));
    const LawStudy& study = studies[i];
    body +=
        fmt::format("<h2 id=\"law{}\">{}</h2>\n<p>{}</p>\n", i, scenario_words(study.name), scenario_words(study.text));
    body += fmt::format("<p class=\"soft\">{}</p>\n", equilibrium_text(study));
    if (study.x_apart_m && study.a_apart_m_s2) {
      body += fmt::format("<p class=\"note\">{}</p>\n",
                          words("laws_apart", {{"x", base::number_text(*study.x_apart_m * 1e3, 2)},
                                               {"a", base::number_text(*study.a_apart_m_s2, 2)}}));
    }
    body += plots_of(study) + film_figure(study, films[i]);
  }
  return report::page(text_in("en", "laws_title"), body + film_script(language));
}

}  // namespace glidelab::teach
