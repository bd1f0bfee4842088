#include "report/laws_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/gnuplot.h"
#include "report/html.h"
#include "report/number_text.h"
#include "report/plot_style.h"

namespace glidelab::report {
namespace {

using validate::LawCurve;
using validate::LawMotion;
using validate::LawStudy;

PlotData columns(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
  PlotData data{name, {}};
  for (std::size_t i = 0; i < x.size(); ++i) data.rows.push_back({x[i], y[i]});
  return data;
}

Plot position_plot(const LawStudy& study) {
  std::vector<PlotData> data;
  std::string script =
      std::string(kFrame) + "set key font ',11' maxrows 4 width -3\nset xlabel 't (s)'\nset ylabel 'x (m)'\nplot ";
  for (std::size_t i = 0; i < study.motions.size(); ++i) {
    data.push_back(columns(fmt::format("motion{}", i), study.motions[i].t_s, study.motions[i].x_m));
    script += fmt::format("{}${} using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}", i == 0 ? "" : ", ",
                          data.back().name, i % 2 == 0 ? 1 : 2, color(i), gnuplot_quoted(study.motions[i].clip));
  }
  return {Drawing{script, data}, "Position over time", "x(t) of " + study.name};
}

Plot phase_plot(const LawStudy& study) {
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) +
                       "set key font ',11' maxrows 4 width -3\nset xlabel 'v (m/s)'\nset ylabel 'a (m/s²)'\n"
                       "set xzeroaxis lt 1 lc rgb '#777777'\nset yzeroaxis lt 1 lc rgb '#777777'\nplot ";
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
        // A jump at v = 0 is no line.
        if (i > 0 && motion.v_m_s[i] * motion.v_m_s[i - 1] <= 0.0 && motion.v_m_s[i - 1] != 0.0)
          path.rows.push_back({});
        path.rows.push_back({motion.v_m_s[i], motion.a_m_s2[i]});
      }
      add(std::move(path),
          fmt::format("with lines lw 2.4 lc rgb '{}' title {}", color(m), gnuplot_quoted(motion.clip)));
    }
    if (curve.equilibrium_m_s) {
      add({fmt::format("rest{}", c), {{*curve.equilibrium_m_s, 0.0}}},
          fmt::format("with points pt 7 ps 1 lc rgb '#000000' {}", c == 0 ? "title 'equilibrium'" : "notitle"));
    }
  }
  return {Drawing{script, data}, "Acceleration over velocity; the dot is where the motion tends to",
          "a(v) of " + study.name};
}

std::string numbers(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += fmt::format("{}{:.5g}", i == 0 ? "" : ",", values[i]);
  return text + "]";
}

/// The motions as the page's script reads them; names are indices, so that no text of a file is in it.
std::string animation(const LawStudy& study) {
  std::string data = fmt::format("{{\"rate\":{},\"motions\":[", validate::kFramesPerSecond);
  for (std::size_t i = 0; i < study.motions.size(); ++i) {
    const LawMotion& motion = study.motions[i];
    double incline_deg = 0.0;
    for (const LawCurve& curve : study.curves) {
      if (std::find(curve.motions.begin(), curve.motions.end(), i) != curve.motions.end())
        incline_deg = curve.incline_deg;
    }
    data += fmt::format("{}{{\"color\":\"{}\",\"incline\":{:.5g},\"x\":{},\"v\":{},\"a\":{}}}", i == 0 ? "" : ",",
                        color(i), incline_deg, numbers(motion.x_m), numbers(motion.v_m_s), numbers(motion.a_m_s2));
  }
  return fmt::format(
      "<figure class=\"law\"><canvas width=\"960\" height=\"{}\" role=\"img\" aria-label=\"Gliders of {} on "
      "their tracks\"></canvas><figcaption><button type=\"button\">Play</button> <span>the gliders on their "
      "tracks (downhill to the right), and their points in a(v)</span></figcaption>"
      "<script type=\"application/json\">{}]}}</script></figure>\n",
      80 * study.motions.size() + 260, escape(study.name), data);
}

constexpr std::string_view kScript =
    R"js(<style>figure.law{max-width:none} figure.law canvas{display:block;width:100%;height:auto;background:#fff}
figure.law button{font:inherit;padding:.15rem .8rem;cursor:pointer}</style>
<script>
for (const figure of document.querySelectorAll('figure.law')) {
  const data = JSON.parse(figure.querySelector('script').textContent), motions = data.motions;
  const canvas = figure.querySelector('canvas'), button = figure.querySelector('button'), c = canvas.getContext('2d');
  const all = key => motions.flatMap(m => m[key]);
  const span = (values, zero) => { let lo = Math.min(...values, ...zero), hi = Math.max(...values, ...zero), pad = (hi - lo || 1) * 0.08; return [lo - pad, hi + pad]; };
  const X = span(all('x'), []), V = span(all('v'), [0]), A = span(all('a'), [0]);
  const longest = Math.max(...motions.map(m => m.x.length)), tracks = 80 * motions.length, W = canvas.width, H = canvas.height;
  const px = x => 40 + (W - 80) * (x - X[0]) / (X[1] - X[0]);
  const pv = v => 70 + (W - 110) * (v - V[0]) / (V[1] - V[0]);
  const pa = a => H - 34 - (H - tracks - 60) * (a - A[0]) / (A[1] - A[0]);
  function draw(k) {
    c.clearRect(0, 0, W, H);
    motions.forEach((m, i) => {
      const y = 80 * i + 52, tilt = Math.max(-0.05, Math.min(0.05, m.incline * Math.PI / 180)), j = Math.min(k, m.x.length - 1);
      c.save(); c.translate(W / 2, y); c.rotate(tilt);
      c.fillStyle = '#c3cad1'; c.fillRect(30 - W / 2, 8, W - 60, 5);
      c.fillStyle = m.color; c.fillRect(px(m.x[j]) - W / 2 - 24, -10, 48, 18);
      c.fillStyle = '#fff'; c.strokeStyle = '#333'; c.beginPath(); c.arc(px(m.x[j]) - W / 2, -1, 6, 0, 7); c.fill(); c.stroke();
      c.restore();
    });
    c.strokeStyle = '#777'; c.lineWidth = 1; c.beginPath();
    c.moveTo(pv(V[0]), pa(0)); c.lineTo(pv(V[1]), pa(0)); c.moveTo(pv(0), pa(A[0])); c.lineTo(pv(0), pa(A[1])); c.stroke();
    c.fillStyle = '#333'; c.font = '17px sans-serif'; c.fillText('v (m/s)', W - 90, pa(0) - 8); c.fillText('a (m/s²)', pv(0) + 8, pa(A[1]) + 12);
    c.font = '14px sans-serif';
    for (const v of [V[0] * 0.9 + V[1] * 0.1, V[0] * 0.1 + V[1] * 0.9]) c.fillText(v.toFixed(2), pv(v) - 14, H - 12);
    for (const a of [A[0] * 0.9 + A[1] * 0.1, A[0] * 0.1 + A[1] * 0.9]) c.fillText(a.toFixed(2), 8, pa(a) + 5);
    motions.forEach(m => {
      const j = Math.min(k, m.x.length - 1);
      c.strokeStyle = m.color; c.lineWidth = 3; c.beginPath();
      for (let i = 0; i <= j; i++) {
        const jump = i == 0 || (m.v[i] * m.v[i - 1] <= 0 && m.v[i - 1] != 0);
        if (jump) c.moveTo(pv(m.v[i]), pa(m.a[i])); else c.lineTo(pv(m.v[i]), pa(m.a[i]));
      }
      c.stroke();
      c.fillStyle = m.color; c.beginPath(); c.arc(pv(m.v[j]), pa(m.a[j]), 7, 0, 7); c.fill();
    });
  }
  let start = 0;
  function step(now) {
    if (!start) return;
    const k = Math.floor((now - start) / 1000 * data.rate);
    draw(k);
    if (k < longest) requestAnimationFrame(step); else { start = 0; button.textContent = 'Play'; }
  }
  button.onclick = () => {
    if (start) { start = 0; button.textContent = 'Play'; return; }
    button.textContent = 'Stop'; start = performance.now(); requestAnimationFrame(step);
  };
  draw(Math.floor(longest / 3));
}
</script>
)js";

std::string equilibrium_text(const LawStudy& study) {
  std::string text;
  for (const LawCurve& curve : study.curves) {
    text += fmt::format("{}{} ({:.3g}°): {}", text.empty() ? "" : "; ", escape(curve.configuration), curve.incline_deg,
                        !curve.equilibrium_m_s ? "tends to no speed"
                        : *curve.equilibrium_m_s == 0.0
                            ? "comes to rest"
                            : fmt::format("v_lim = {} m/s", number_text(*curve.equilibrium_m_s, 4)));
  }
  return text;
}

}  // namespace

Page laws_report(const std::vector<LawStudy>& studies, const base::Progress& progress) {
  Html body =
      "<h1>Laws of friction in a(v)</h1>\n<p>How a glider moves under each law: launched up or down, let go from rest, "
      "or "
      "started above its limit. Every point is the program's own solution of the equation of motion.</p>\n<nav><ul>";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    body += fmt::format("<li><a href=\"#law{}\">{}</a></li>", i, escape(studies[i].name));
  }
  body += "</ul></nav>\n";
  for (std::size_t i = 0; i < studies.size(); ++i) {
    progress("drawing", static_cast<double>(i) / static_cast<double>(studies.size()));
    const LawStudy& study = studies[i];
    body += fmt::format("<h2 id=\"law{}\">{}</h2>\n<p>{}</p>\n", i, escape(study.name), escape(study.text));
    body += fmt::format("<p class=\"soft\">{}</p>\n", equilibrium_text(study));
    if (study.x_apart_m && study.a_apart_m_s2) {
      body += fmt::format(
          "<p class=\"note\">The two x(t) are never more than {} mm apart; the two a(v) differ by up to {} "
          "m/s².</p>\n",
          number_text(*study.x_apart_m * 1e3, 2), number_text(*study.a_apart_m_s2, 2));
    }
    body += figures({position_plot(study), phase_plot(study)}) + animation(study);
  }
  return page("Laws of friction", body + std::string(kScript));
}

}  // namespace glidelab::report
