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
  std::string script = std::string(kFrame) +
                       "set key font ',11' maxrows 4 width -3\nset xlabel 't (s)'\nset ylabel 'x (m)'\n"
                       "set offsets 0, graph 0.02, graph 0.06, graph 0.06\nset xrange [0:*]\nplot ";
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
      add(std::move(path), fmt::format("with lines lw 2.4 dt {} lc rgb '{}' title {}", m % 2 == 0 ? 1 : 2, color(m),
                                       gnuplot_quoted(motion.clip)));
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

/// The motions as the page's script reads them. Their names stand beside it as text of the page, so that no text of a
/// file is in the script.
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
  std::string names;
  for (const LawMotion& motion : study.motions) names += fmt::format("<li>{}</li>", escape(motion.clip));
  return fmt::format(
      "<figure class=\"law\"><canvas role=\"img\" aria-label=\"Gliders of {} on "
      "their tracks\"></canvas><figcaption><button type=\"button\">Play</button> <span>the gliders on their "
      "tracks (downhill to the right), and their points in a(v)</span><ul hidden>{}</ul></figcaption>"
      "<script type=\"application/json\">{}]}}</script></figure>\n",
      escape(study.name), names, data);
}

constexpr std::string_view kScript =
    R"js(<style>figure.law{max-width:none} figure.law canvas{display:block;width:100%;background:#fff}
figure.law button{font:inherit;padding:.15rem .8rem;cursor:pointer}</style>
<script>
for (const figure of document.querySelectorAll('figure.law')) {
  const data = JSON.parse(figure.querySelector('script').textContent), motions = data.motions;
  const names = [...figure.querySelectorAll('li')].map(item => item.textContent);
  const canvas = figure.querySelector('canvas'), button = figure.querySelector('button'), c = canvas.getContext('2d');
  const all = key => motions.flatMap(m => m[key]);
  const span = (values, zero) => { let lo = Math.min(...values, ...zero), hi = Math.max(...values, ...zero), pad = (hi - lo || 1) * 0.08; return [lo - pad, hi + pad]; };
  const X = span(all('x'), []), V = span(all('v'), [0]), A = span(all('a'), [0]);
  const longest = Math.max(...motions.map(m => m.x.length)), row = 64, tracks = row * motions.length + 44, H = tracks + 270;
  let W = 0, now = Math.floor(longest / 3);
  const px = x => 24 + (W - 48) * (x - X[0]) / (X[1] - X[0]);
  const pv = v => 52 + (W - 76) * (v - V[0]) / (V[1] - V[0]);
  const pa = a => H - 34 - (H - tracks - 70) * (a - A[0]) / (A[1] - A[0]);
  // Round values between the ends, `most` or fewer.
  function ticks(range, most) {
    const least = (range[1] - range[0]) / most, power = 10 ** Math.floor(Math.log10(least));
    const step = power * [1, 2, 5, 10].find(d => d * power >= least), values = [];
    for (let i = Math.ceil(range[0] / step); i * step <= range[1]; i++) values.push(i * step);
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return values.map(value => [value, value.toFixed(digits).replace('-', '\u2212')]);
  }
  function text(words, x, y, align) { c.textAlign = align; c.fillText(words, x, y); }
  function line(x0, y0, x1, y1, ink) { c.strokeStyle = ink; c.lineWidth = 1; c.beginPath(); c.moveTo(x0, y0); c.lineTo(x1, y1); c.stroke(); }
  function draw(k) {
    now = k;
    c.clearRect(0, 0, W, H);
    c.font = '13px sans-serif';
    motions.forEach((m, i) => {
      const y = row * i + 46, tilt = Math.max(-0.03, Math.min(0.03, m.incline * Math.PI / 180)), j = Math.min(k, m.x.length - 1);
      c.fillStyle = '#333'; text(names[i], 24, row * i + 18, 'left');
      c.save(); c.translate(W / 2, y); c.rotate(tilt);
      c.fillStyle = '#c3cad1'; c.fillRect(16 - W / 2, 7, W - 32, 4);
      c.fillStyle = m.color; c.fillRect(px(m.x[j]) - W / 2 - 18, -8, 36, 15);
      c.fillStyle = '#fff'; c.strokeStyle = '#333'; c.beginPath(); c.arc(px(m.x[j]) - W / 2, -1, 4.5, 0, 7); c.fill(); c.stroke();
      c.restore();
    });
    const few = Math.max(3, Math.floor(W / 110));
    c.fillStyle = '#333';
    for (const [x, words] of ticks(X, few)) { line(px(x), tracks - 34, px(x), tracks - 28, '#777'); text(words, px(x), tracks - 14, 'center'); }
    text('x (m)', W - 8, tracks + 2, 'right'); text('t = ' + (Math.min(k, longest - 1) / data.rate).toFixed(2) + ' s', 24, tracks + 2, 'left');
    for (const [v, words] of ticks(V, few)) { line(pv(v), pa(A[0]), pv(v), pa(A[1]), '#ddd'); text(words, pv(v), H - 14, 'center'); }
    for (const [a, words] of ticks(A, 6)) { line(pv(V[0]), pa(a), pv(V[1]), pa(a), '#ddd'); text(words, pv(V[0]) - 6, pa(a) + 4, 'right'); }
    line(pv(V[0]), pa(0), pv(V[1]), pa(0), '#777'); line(pv(0), pa(A[0]), pv(0), pa(A[1]), '#777');
    text('v (m/s)', W - 8, H - 30, 'right'); text('a (m/s²)', pv(V[0]) + 6, pa(A[1]) - 6, 'left');
    motions.forEach(m => {
      const j = Math.min(k, m.x.length - 1);
      c.strokeStyle = m.color; c.lineWidth = 2.5; c.beginPath();
      for (let i = 0; i <= j; i++) {
        const jump = i == 0 || (m.v[i] * m.v[i - 1] <= 0 && m.v[i - 1] != 0);
        if (jump) c.moveTo(pv(m.v[i]), pa(m.a[i])); else c.lineTo(pv(m.v[i]), pa(m.a[i]));
      }
      c.stroke();
      c.fillStyle = m.color; c.beginPath(); c.arc(pv(m.v[j]), pa(m.a[j]), 5.5, 0, 7); c.fill();
    });
  }
  // As many pixels as the screen has, so that words keep their size on a telephone.
  function fit() {
    const ratio = window.devicePixelRatio || 1;
    W = canvas.clientWidth;
    canvas.style.height = H + 'px'; canvas.width = Math.round(W * ratio); canvas.height = Math.round(H * ratio);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw(now);
  }
  let start = 0;
  function step(time) {
    if (!start) return;
    const k = Math.floor((time - start) / 1000 * data.rate);
    draw(k);
    if (k < longest) requestAnimationFrame(step); else { start = 0; button.textContent = 'Play'; }
  }
  button.onclick = () => {
    if (start) { start = 0; button.textContent = 'Play'; return; }
    button.textContent = 'Stop'; start = performance.now(); requestAnimationFrame(step);
  };
  window.addEventListener('resize', fit);
  fit();
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
