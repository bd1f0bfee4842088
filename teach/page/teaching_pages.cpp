#include "teach/page/teaching_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/text/number_text.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"

namespace glidelab::teach {
namespace {

/// With the digits that a distance needs: up to 20, scaled by 2e4 m where k is small.
std::string array_of(const std::vector<double>& values) {
  return fmt::format("[{:.15g}]", fmt::join(values, ","));
}

std::string orbit_json(const Orbit& orbit) {
  std::vector<double> tau, u, way, slope, bend;
  for (const OrbitPoint& point : orbit) {
    tau.push_back(point.tau);
    u.push_back(point.u);
    way.push_back(point.way);
    slope.push_back(point.slope);
    bend.push_back(point.bend);
  }
  return fmt::format("[{},{},{},{},{}]", array_of(tau), array_of(u), array_of(way), array_of(slope), array_of(bend));
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

report::Page explorer_page(const PhaseExplorer& explorer) {
  std::string body = fmt::format("<style>\n{}</style>\n{}", kExplorerStyle, kExplorerBody);
  body += fmt::format("<script>\n'use strict';\nconst LANGUAGES={{en:{}}};\nlet language='en';\n", kEnglish);
  body += data_of(explorer);
  for (const std::string_view script :
       {kExplorerMotion, kPageLanguage, kExplorerWords, kExplorerTrack, kExplorerKept, kExplorerLink, kExplorerView})
    body.append("\n").append(script);
  return report::page("Friction in the phase plane", body + "</script>\n");
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

// Names are text of the page over the film: no text of a file is in the script.
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
      "width=\"{}\" height=\"{}\" aria-label=\"Film of {}\" src=\"{}\"></video><ul>{}</ul></div>"
      "<figcaption>The gliders on their tracks drawn by the renderer, each track with its true slope; {:.1f} s, in "
      "real time</figcaption></figure><figure><canvas role=\"img\" aria-label=\"Points of {} in a(v)\"></canvas>"
      "<figcaption>Their points in a(v) at the same time</figcaption></figure>"
      "<script type=\"application/json\">{}]}}</script></div>\n",
      film.width_px > 0 ? static_cast<double>(film.height_px) / film.width_px : 0.0, film.width_px, film.height_px,
      escape(study.name), data_uri("video/mp4", film.mp4), names,
      static_cast<double>(film.frames - 1) / film.frame_rate_hz, escape(study.name), data);
}

std::string film_script() {
  return fmt::format("<style>\n{}</style>\n<script>\n{}</script>\n", kFilmStyle, kFilmScript);
}

namespace {

using report::color;
using report::Drawing;
using report::escape;
using report::figures;
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
  return {Drawing{script, data}, "Position over time", "x(t) of " + study.name};
}

Plot phase_plot(const LawStudy& study) {
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) +
                       "set key top right font ',11' maxrows 4\nset xlabel 'v (m/s)'\nset ylabel 'a (m/s²)'\n"
                       "set xzeroaxis lt 1 lc rgb '#777777'\nset yzeroaxis lt 1 lc rgb '#777777'\nplot ";
  bool first = true, stable_named = false, unstable_named = false;
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
        // A jump at v = 0 is no line.
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
      bool& named = stable ? stable_named : unstable_named;
      const std::string title = named ? "notitle" : stable ? "title 'equilibrium'" : "title 'unstable equilibrium'";
      named = named || !points.rows.empty();
      add(std::move(points), fmt::format("with points pt {} ps 1.1 lw 1.6 lc rgb '#000000' {}", stable ? 7 : 6, title));
    }
  }
  return {Drawing{script, data},
          "Acceleration over velocity; dots: speeds that motions tend to, circles: speeds that they leave",
          "a(v) of " + study.name};
}

std::string equilibrium_text(const LawStudy& study) {
  std::string text;
  for (const LawCurve& curve : study.curves) {
    std::string ends;
    for (const Equilibrium& at : curve.equilibria) {
      const std::string v = base::number_text(at.v_m_s, 4) + " m/s";
      const std::string end = at.v_m_s != 0.0 ? (at.stable ? "tends to v<sub>lim</sub> = " : "unstable at ") + v
                              : !at.stable    ? "may stay at rest, but does not return to it"
                              : at.stops      ? "comes to rest"
                                              : "tends to rest";
      ends += (ends.empty() ? "" : ", ") + end;
    }
    text += fmt::format("{}{} ({:.3g}°): {}", text.empty() ? "" : "; ", escape(curve.configuration), curve.incline_deg,
                        ends.empty() ? "has no limit velocity" : ends);
  }
  return text;
}

}  // namespace

report::Page laws_report(const std::vector<LawStudy>& studies, const std::vector<LawFilm>& films,
                         const base::Progress& progress) {
  if (films.size() != studies.size()) throw std::logic_error("not a film for each law");
  Html body =
      "<h1>Laws of friction in a(v)</h1>\n<p>How a glider moves under each law: launched uphill or downhill, released "
      "from rest, or started above its limit velocity. Every point is the program's own solution of the equation of "
      "motion, and its renderer drew the films.</p>\n";
  std::string meaning =
      "<p>x(t) shows where a glider is, a(v) which law moves it: every motion of one glider on one slope runs along "
      "the "
      "same curve of a(v), wherever it starts. A straight line means linear viscous friction, a bent curve another "
      "drag, "
      "a jump at v = 0 Coulomb friction. Where the curve falls through a = 0 (dot), the glider tends to that speed "
      "from "
      "both sides; where it rises through a = 0 (circle), the glider leaves that speed. Viscous or quadratic drag "
      "alone "
      "never quite stops a glider; friction that does not vanish at v = 0 does.";
  if (std::ranges::any_of(studies, [](const LawStudy& study) { return study.x_apart_m.has_value(); })) {
    meaning += " The pair with almost the same x(t) shows why a(v) is worth plotting.";
  }
  body += meaning_section(meaning + "</p>\n") + "<nav><ul>";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    body += fmt::format("<li><a href=\"#law{}\">{}</a></li>", i, escape(studies[i].name));
  }
  body += "</ul></nav>\n";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    progress("drawing", static_cast<double>(i) / static_cast<double>(studies.size()));
    const LawStudy& study = studies[i];
    body += fmt::format("<h2 id=\"law{}\">{}</h2>\n<p>{}</p>\n", i, escape(study.name), symbols_html(study.text));
    body += fmt::format("<p class=\"soft\">{}</p>\n", equilibrium_text(study));
    if (study.x_apart_m && study.a_apart_m_s2) {
      body += fmt::format(
          "<p class=\"note\">The two x(t) are never more than {} mm apart; the two a(v) differ by up to {} "
          "m/s².</p>\n",
          base::number_text(*study.x_apart_m * 1e3, 2), base::number_text(*study.a_apart_m_s2, 2));
    }
    body += figures({position_plot(study), phase_plot(study)}) + film_figure(study, films[i]);
  }
  return report::page("Laws of friction", body + film_script());
}

}  // namespace glidelab::teach
