#include "teach/page/laws_motion.h"

#include <fmt/format.h>

#include <vector>

#include "report/html/html.h"
#include "report/html/plot_style.h"

namespace glidelab::teach {
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
      "<figcaption>The gliders on their tracks as the renderer draws them, downhill as the tracks fall; {:.1f} s, in "
      "real time</figcaption></figure><figure><canvas role=\"img\" aria-label=\"Points of {} in a(v)\"></canvas>"
      "<figcaption>Their points in a(v) at the film's time</figcaption></figure>"
      "<script type=\"application/json\">{}]}}</script></div>\n",
      film.width_px > 0 ? static_cast<double>(film.height_px) / film.width_px : 0.0, film.width_px, film.height_px,
      escape(study.name), data_uri("video/mp4", film.mp4), names,
      static_cast<double>(film.frames - 1) / film.frame_rate_hz, escape(study.name), data);
}

const std::string_view kFilmScript = R"js(<style>
.law { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(480px, 100%), 1fr)); gap: .8rem; align-items: start; }
.law figure { max-width: none; }
.law canvas { display: block; width: 100%; height: 300px; background: #fff; }
.law .rows { position: relative; container-type: inline-size; }
.law .rows video { height: calc(100cqw * var(--tall) + 4.2rem); object-fit: contain; object-position: top; }
.law .rows ul { margin: 0; padding: 0; list-style: none; }
.law .rows li { position: absolute; right: .5rem; top: calc((100% - 4.2rem) * var(--row) + .2rem); padding: .1rem .4rem; font-size: .8rem; line-height: 1.2; color: #fff;
  background: #000a; border-radius: 4px; pointer-events: none; max-width: 90%; }
.law .rows i { display: inline-block; width: .7rem; height: .7rem; margin-right: .35rem; border-radius: 50%; border: 1px solid #fff; }
@media screen and (prefers-color-scheme: dark) { .law canvas, .law .rows i { filter: invert(0.9) hue-rotate(180deg); } }  /* as the plots */
@media print { .law canvas { height: auto; } }  /* as drawn for the screen */
</style>
<script>
for (const law of document.querySelectorAll('.law')) {
  const data = JSON.parse(law.querySelector('script').textContent), motions = data.motions;
  const video = law.querySelector('video'), canvas = law.querySelector('canvas'), c = canvas.getContext('2d');
  const span = key => { const all = motions.flatMap(m => m[key]), lo = Math.min(0, ...all), hi = Math.max(0, ...all), pad = (hi - lo || 1) * 0.08; return [lo - pad, hi + pad]; };
  const V = span('v'), A = span('a'), H = 300;
  let W = 0;
  const pv = v => 60 + (W - 80) * (v - V[0]) / (V[1] - V[0]), pa = a => H - 44 - (H - 74) * (a - A[0]) / (A[1] - A[0]);
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
  function path(m, end) {
    c.strokeStyle = m.color; c.beginPath();
    for (let i = 0; i <= end; i++) {
      const jump = i == 0 || (m.v[i] * m.v[i - 1] <= 0 && m.v[i - 1] != 0);
      if (jump) c.moveTo(pv(m.v[i]), pa(m.a[i])); else c.lineTo(pv(m.v[i]), pa(m.a[i]));
    }
    c.stroke();
  }
  function draw() {
    c.clearRect(0, 0, W, H);
    c.font = '14px system-ui, "DejaVu Sans", sans-serif'; c.fillStyle = '#333';
    for (const [v, words] of ticks(V, Math.max(3, Math.floor(W / 90)))) { line(pv(v), pa(A[0]), pv(v), pa(A[1]), '#ddd'); text(words, pv(v), H - 26, 'center'); }
    for (const [a, words] of ticks(A, 6)) { line(pv(V[0]), pa(a), pv(V[1]), pa(a), '#ddd'); text(words, pv(V[0]) - 6, pa(a) + 5, 'right'); }
    line(pv(V[0]), pa(0), pv(V[1]), pa(0), '#777'); line(pv(0), pa(A[0]), pv(0), pa(A[1]), '#777');
    text('v (m/s)', W - 20, H - 7, 'right'); text('a (m/s²)', 8, 18, 'left');
    text('t = ' + video.currentTime.toFixed(2) + ' s', W - 20, 18, 'right');
    for (const [v, stable] of data.equilibria) {
      c.fillStyle = stable ? '#000' : '#fff'; c.strokeStyle = '#000'; c.lineWidth = 1.5;
      c.beginPath(); c.arc(pv(v), pa(0), 5, 0, 7); c.fill(); c.stroke();
    }
    const now = m => Math.min(Math.round(video.currentTime * data.rate), m.v.length - 1);
    c.globalAlpha = 0.4; c.lineWidth = 1.2; for (const m of motions) path(m, m.v.length - 1);
    c.globalAlpha = 1; c.lineWidth = 3; for (const m of motions) path(m, now(m));
    for (const m of motions) {
      c.fillStyle = m.color; c.strokeStyle = '#fff'; c.lineWidth = 1.5;
      c.beginPath(); c.arc(pv(m.v[now(m)]), pa(m.a[now(m)]), 6.5, 0, 7); c.fill(); c.stroke();
    }
  }
  // As many pixels as the screen has, so that words keep their size on a telephone.
  function fit() {
    const ratio = window.devicePixelRatio || 1;
    W = canvas.clientWidth;
    canvas.width = Math.round(W * ratio); canvas.height = Math.round(H * ratio);
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw();
  }
  function step() { draw(); if (!video.paused) requestAnimationFrame(step); }
  video.onplay = step; video.onseeked = draw; video.ontimeupdate = draw;
  window.addEventListener('resize', fit);
  fit();
}
</script>
)js";

}  // namespace glidelab::teach
