#include "report/explorer_script.h"

namespace glidelab::report {

const std::string_view kExplorerBody = R"html(<style>
:root { --first: #0072b2; --second: #d55e00; --third: #00795b; }
@media (prefers-color-scheme: dark) { :root { --first: #6cb8ea; --second: #ff9a57; --third: #4fd0a8; } }
#explorer { display: grid; grid-template-columns: minmax(260px, 320px) minmax(0, 1fr); gap: 1rem; align-items: start; }
#controls label { display: block; margin: .55rem 0 0; }
#controls .line { display: flex; justify-content: space-between; gap: .5rem; }
#controls output { font-variant-numeric: tabular-nums; font-weight: 600; }
#controls input[type=range] { width: 100%; margin: .1rem 0 0; accent-color: var(--accent); }
#controls select, #controls button { font: inherit; padding: .2rem .6rem; color: inherit; background: var(--tint);
  border: 1px solid var(--line); border-radius: 6px; }
#controls select { width: 100%; }
#controls button { cursor: pointer; margin: .25rem .25rem 0 0; }
#controls :focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
#plots { display: grid; grid-template-columns: 1fr 1fr; gap: .8rem; }
#plots figure { max-width: none; background: var(--paper); }
#plots .wide { grid-column: 1 / -1; }
#plots canvas { display: block; width: 100%; }
#readout { font-variant-numeric: tabular-nums; min-height: 3em; }
@media (max-width: 860px) { #explorer { grid-template-columns: minmax(0, 1fr); } }
@media (max-width: 620px) { #plots { grid-template-columns: minmax(0, 1fr); } }
@media print { #controls button, #controls input { display: none; } }
</style>
<h1>Friction in the phase plane</h1>
<p>A glider on a track, x positive downhill: m dv/dt = m g sin α − drag(v) − sign(v) μ m g cos α. Choose the law, its strength, the
slope and the push; the point runs along x(t), v(t) and a(v) together. On the keyboard: Tab to a slider, then the arrow keys.</p>
<div id="explorer">
<form id="controls" onsubmit="return false">
<label>Drag<select id="law"><option value="0">viscous: K v</option><option value="1">C v |v|^½ (power 3/2)</option>
<option value="2">quadratic: C v |v|</option><option value="3">none</option></select></label>
<label><span class="line"><span id="dragname">K/m (1/s)</span><output id="o-k"></output></span>
<input type="range" id="k" min="0" max="5" step="0.01" value="2.77"></label>
<label><span class="line"><span>friction μ</span><output id="o-mu"></output></span>
<input type="range" id="mu" min="0" max="0.03" step="0.0001" value="0.0071"></label>
<label><span class="line"><span>inclination α (°)</span><output id="o-alpha"></output></span>
<input type="range" id="alpha" min="-4" max="8" step="0.1" value="4.3"></label>
<label><span class="line"><span>start v₀ (m/s)</span><output id="o-v0"></output></span>
<input type="range" id="v0" min="-2" max="2" step="0.01" value="-1.2"></label>
<label><span class="line"><span>time t (s)</span><output id="o-t"></output></span>
<input type="range" id="t" min="0" max="5" step="0.01" value="1"></label>
<p><button type="button" id="play">Play</button></p>
<p class="soft">Cases of the paper:<br>
<button type="button" data-case="0,2.88,0,0,1.2">level, viscous</button>
<button type="button" data-case="0,2.77,0,4.3,0">slope, viscous</button>
<button type="button" data-case="3,0,0.03,0,0.8">level, Coulomb</button>
<button type="button" data-case="3,0,0.03,4,-1.4">slope, Coulomb</button>
<button type="button" data-case="0,2.88,0.0075,0,-1.2">level, both</button>
<button type="button" data-case="0,2.77,0.0071,4.3,-1.2">slope, both</button>
<button type="button" data-case="0,1,0.03,1.5,-1.2">up, and it stays</button></p>
</form>
<div id="plots">
<figure class="wide"><canvas id="track" data-height="110" role="img" aria-label="the glider on its track"></canvas></figure>
<figure><canvas id="av" data-height="300" role="img" aria-label="acceleration over velocity"></canvas><figcaption>a(v): thin, all
that the law allows; thick, this motion. Dot on the axis: equilibrium.</figcaption></figure>
<figure><canvas id="vt" data-height="300" role="img" aria-label="velocity over time"></canvas><figcaption>v(t), dashed: the
limit</figcaption></figure>
<figure class="wide"><canvas id="xt" data-height="220" role="img" aria-label="position over time"></canvas><figcaption>x(t),
downhill upwards</figcaption></figure>
<p id="readout" class="note wide" aria-live="polite"></p>
</div>
</div>
<p class="soft" id="measured"></p>
)html";

const std::string_view kExplorerView = R"js(
const $ = id => document.getElementById(id), names = ['k', 'mu', 'alpha', 'v0', 't'], END = 5, POINTS = 500;
const digits = { k: 2, mu: 4, alpha: 1, v0: 2, t: 2 };
const units = ['K/m (1/s)', 'C/m (1/√(m·s))', 'C/m (1/m)', 'no drag'];
const minus = text => text.replace('-', '\u2212'), show = (x, n) => minus(x.toFixed(n));
let current, playing = 0;

function read() {
  const p = { law: +$('law').value };
  for (const name of names) p[name] = +$(name).value;
  return p;
}
function ticks(low, high) {
  const raw = (high - low) / 7, power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].find(m => m * power >= raw * 0.999) * power, list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) list.push(i * step);
  return { list, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
function sheet(id) {
  const canvas = $(id), ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = +canvas.dataset.height;
  canvas.style.height = height + 'px'; canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  const c = canvas.getContext('2d'); c.scale(ratio, ratio);
  const css = getComputedStyle(document.documentElement), color = name => css.getPropertyValue('--' + name).trim();
  c.font = '13px system-ui, "DejaVu Sans", sans-serif';
  return { c, width, height, color };
}
function frame(id, xs, ys, xname, yname) {
  const s = sheet(id), { c } = s, left = 58, right = 14, top = 24, bottom = 40;
  const span = list => { let a = Math.min(...list), b = Math.max(...list); if (b - a < 1e-6) { a -= 0.5; b += 0.5; } const pad = 0.06 * (b - a); return [a - pad, b + pad]; };
  const X = span(xs), Y = span(ys);
  s.px = x => left + (s.width - left - right) * (x - X[0]) / (X[1] - X[0]);
  s.py = y => s.height - bottom - (s.height - top - bottom) * (y - Y[0]) / (Y[1] - Y[0]);
  c.lineWidth = 1; c.fillStyle = s.color('soft');
  const tx = ticks(...X), ty = ticks(...Y);
  c.textAlign = 'center'; c.textBaseline = 'top';
  for (const x of tx.list) { c.strokeStyle = s.color('line'); c.beginPath(); c.moveTo(s.px(x), top); c.lineTo(s.px(x), s.height - bottom); c.stroke(); c.fillText(show(x, tx.decimals), s.px(x), s.height - bottom + 5); }
  c.textAlign = 'right'; c.textBaseline = 'middle';
  for (const y of ty.list) { c.strokeStyle = s.color('line'); c.beginPath(); c.moveTo(left, s.py(y)); c.lineTo(s.width - right, s.py(y)); c.stroke(); c.fillText(show(y, ty.decimals), left - 6, s.py(y)); }
  c.strokeStyle = s.color('soft');
  if (X[0] < 0 && X[1] > 0) { c.beginPath(); c.moveTo(s.px(0), top); c.lineTo(s.px(0), s.height - bottom); c.stroke(); }
  if (Y[0] < 0 && Y[1] > 0) { c.beginPath(); c.moveTo(left, s.py(0)); c.lineTo(s.width - right, s.py(0)); c.stroke(); }
  c.fillStyle = s.color('ink'); c.textBaseline = 'alphabetic';
  c.textAlign = 'right'; c.fillText(xname, s.width - right, s.height - 6);
  c.textAlign = 'left'; c.fillText(yname, 6, 15);
  return s;
}
function curve(s, points, color, width, dash) {
  s.c.strokeStyle = color; s.c.lineWidth = width; s.c.setLineDash(dash || []); s.c.beginPath();
  let pen = false;
  for (const p of points) { if (!p) { pen = false; continue; } if (pen) s.c.lineTo(s.px(p[0]), s.py(p[1])); else s.c.moveTo(s.px(p[0]), s.py(p[1])); pen = true; }
  s.c.stroke(); s.c.setLineDash([]);
}
function dot(s, x, y, color, radius) {
  s.c.fillStyle = color; s.c.strokeStyle = s.color('paper'); s.c.lineWidth = 1.5;
  s.c.beginPath(); s.c.arc(s.px(x), s.py(y), radius, 0, 7); s.c.fill(); s.c.stroke();
}
function prepare() {
  const p = read(), m = motion(p), path = [];
  const instants = Array.from({ length: POINTS + 1 }, (_, i) => END * i / POINTS);
  for (const t of instants) {
    if (m.stop && path.length && path[path.length - 1].t < m.stop && t > m.stop) {  // the very instant, from both sides
      path.push({ t: m.stop, ...m.at(m.stop * (1 - 1e-12)), v: 0 }); path.push(null); path.push({ t: m.stop, ...m.at(m.stop) });
    }
    path.push({ t, ...m.at(t) });
  }
  const points = path.filter(q => q), vs = points.map(q => q.v).concat(0, m.limit === null ? [] : m.limit);
  let low = Math.min(...vs), high = Math.max(...vs); const pad = 0.08 * (high - low || 1); low -= pad; high += pad;
  const law = [];
  for (const [s, end] of [[-1, low], [1, high]]) {
    const branch = [];
    for (let i = 0; i <= 60; i++) { const w = Math.abs(end) * i / 60; if (end * s > 0) branch.push([s * w, acceleration(p, m, s, w)]); }
    law.push(branch);
  }
  current = { p, m, path, points, law };
  for (const name of names) $('o-' + name).textContent = show(p[name], digits[name]);
  $('dragname').textContent = units[p.law]; $('k').disabled = p.law === 3;
}
function draw() {
  const { p, m, path, points, law } = current, here = m.at(p.t);
  const at = (x, y) => path.map(q => q && [x(q), y(q)]);
  const all = law.flat(), jump = [m.A + m.F, m.A - m.F];
  let s = frame('av', all.map(q => q[0]), all.map(q => q[1]).concat(0, jump), 'v (m/s)', 'a (m/s²)');
  for (const branch of law) curve(s, branch, s.color('soft'), 1);
  if (m.F > 0) curve(s, [[0, jump[0]], [0, jump[1]]], s.color('soft'), 1, [3, 3]);
  curve(s, at(q => q.v, q => q.a), s.color('first'), 3);
  if (m.limit !== null) dot(s, m.limit, 0, s.color('second'), 6);
  dot(s, here.v, here.a, s.color('third'), 7);
  s = frame('vt', [0, END], points.map(q => q.v).concat(0, m.limit === null ? [] : m.limit), 't (s)', 'v (m/s)');
  if (m.limit !== null) curve(s, [[0, m.limit], [END, m.limit]], s.color('second'), 1.5, [6, 4]);
  curve(s, at(q => q.t, q => q.v), s.color('first'), 3); dot(s, p.t, here.v, s.color('third'), 7);
  s = frame('xt', [0, END], points.map(q => q.x), 't (s)', 'x (m)');
  curve(s, at(q => q.t, q => q.x), s.color('first'), 3); dot(s, p.t, here.x, s.color('third'), 7);
  track(here, points, p);
  const rest = m.stop === null ? '' : m.rests ? `It comes to rest at t = ${show(m.stop, 3)} s and stays: the slope pulls with ${show(Math.abs(m.A), 3)} m/s², friction holds up to ${show(m.F, 3)} m/s². ` : m.stop > 0 ? `It turns at t = ${show(m.stop, 3)} s, where a jumps by 2 μ g cos α = ${show(2 * m.F, 3)} m/s². ` : '';
  const tends = m.limit === null ? 'Without a drag there is no limit: a is constant. ' : m.limit === 0 ? 'The equilibrium is rest. ' : `It tends to v = ${show(m.limit, 4)} m/s, where drag, friction and slope balance. `;
  $('readout').textContent = `t = ${show(p.t, 2)} s: x = ${show(here.x, 3)} m, v = ${show(here.v, 3)} m/s, a = ${show(here.a, 3)} m/s². ` + rest + tends;
}
function track(here, points, p) {
  const s = sheet('track'), { c, width, height } = s, xs = points.map(q => q.x), low = Math.min(...xs, 0), high = Math.max(...xs, 0.01);
  const px = x => 50 + (width - 100) * (x - low) / (high - low);
  c.save(); c.translate(width / 2, height / 2 + 8); c.rotate(p.alpha * Math.PI / 180 * Math.min(1, 360 / width)); c.translate(-width / 2, 0);
  c.fillStyle = s.color('line'); c.fillRect(14, 10, width - 28, 6);
  c.fillStyle = s.color('soft'); c.textAlign = 'center'; c.fillText('0', px(0), 32);
  c.fillStyle = s.color('first'); c.fillRect(px(here.x) - 26, -12, 52, 20);
  c.fillStyle = s.color('paper'); c.beginPath(); c.arc(px(here.x), -2, 6, 0, 7); c.fill();
  if (Math.abs(here.v) > 1e-4) { const d = Math.sign(here.v), l = 12 + 30 * Math.min(1, Math.abs(here.v)); c.strokeStyle = s.color('third'); c.fillStyle = s.color('third'); c.lineWidth = 3; c.beginPath(); c.moveTo(px(here.x), -24); c.lineTo(px(here.x) + d * l, -24); c.stroke(); c.beginPath(); c.moveTo(px(here.x) + d * (l + 8), -24); c.lineTo(px(here.x) + d * l, -29); c.lineTo(px(here.x) + d * l, -19); c.fill(); }
  c.restore();
}
function change() { prepare(); draw(); }
function pause() { playing = 0; $('play').textContent = 'Play'; }
function step(now) {
  if (!playing) return;
  const t = (now - playing) / 1000;
  $('t').value = Math.min(t, END); current.p.t = +$('t').value; $('o-t').textContent = show(current.p.t, 2); draw();
  if (t < END) requestAnimationFrame(step); else pause();
}
$('play').onclick = () => {
  if (playing) return pause();
  const from = current.p.t >= END ? 0 : current.p.t;
  playing = performance.now() - 1000 * from; $('play').textContent = 'Pause'; requestAnimationFrame(step);
};
for (const name of names) $(name).oninput = () => { if (name === 't') pause(); change(); };
$('law').onchange = change;
for (const button of document.querySelectorAll('[data-case]')) button.onclick = () => {
  const [law, k, mu, alpha, v0] = button.dataset.case.split(',');
  Object.assign($('law'), { value: law }); $('k').value = k; $('mu').value = mu; $('alpha').value = alpha; $('v0').value = v0; $('t').value = 0;
  pause(); change(); $('play').click();
};
window.addEventListener('resize', draw);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
const off = measured();
$('measured').textContent = `Every curve comes from the program's own solver: four orbits a law, scaled, and interpolated by polynomials of fifth order between kept points. At ${off.points} instants of ${off.motions} motions that the solver made as they are, every corner of the sliders among them, the largest found that this page is off is ${(off.x * 1e3).toPrecision(2)} mm, ${(off.v * 1e3).toPrecision(2)} mm/s and ${(off.a * 1e3).toPrecision(2)} mm/s².`;
document.documentElement.dataset.offX = off.x; document.documentElement.dataset.offV = off.v; document.documentElement.dataset.offA = off.a;
change();
)js";

}  // namespace glidelab::report
