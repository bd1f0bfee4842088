const $ = id => document.getElementById(id), names = ['k', 'mu', 'alpha', 'v0', 't'], END = 5, POINTS = 500;
const digits = { k: 2, mu: 4, alpha: 1, v0: 2, t: 2 };
const dragUnits = ['K/m (1/s)', 'C/m (1/√(m·s))', 'C/m (1/m)', ''];
const spans = {};  // of each plot's axes, as drawn last; they stay while the axes are locked
let current, playing = 0, reserved = 0;

function read() {
  const p = { law: +$('law').value };
  for (const name of names) p[name] = +$(name).value;
  return p;
}
function ticks(low, high, most) {
  const raw = (high - low) / Math.max(2, Math.min(8, most)), power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].find(m => m * power >= raw * 0.999) * power, list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) list.push(i * step);
  return { list, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
function sheet(id) {
  const canvas = $(id), ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio);
  const c = canvas.getContext('2d'); c.scale(ratio, ratio);
  const css = getComputedStyle(document.documentElement), color = name => css.getPropertyValue('--' + name).trim();
  const em = 0.85 * parseFloat(css.fontSize);
  c.font = em + 'px system-ui, "DejaVu Sans", sans-serif';
  return { c, width, height, color, em };
}
function frame(id, xs, ys, xname, yname) {
  const s = sheet(id), { c, em } = s, left = 4.1 * em, right = em, top = 1.9 * em, bottom = 2.9 * em;
  const span = list => { let a = Math.min(...list), b = Math.max(...list); if (b - a < 1e-6) { a -= 0.5; b += 0.5; } const pad = 0.06 * (b - a); return [a - pad, b + pad]; };
  if (!$('lock').checked || !spans[id]) spans[id] = [span(xs), span(ys)];
  const [X, Y] = spans[id];
  s.box = [left, top, s.width - left - right, s.height - top - bottom];
  s.px = x => left + (s.width - left - right) * (x - X[0]) / (X[1] - X[0]);
  s.py = y => s.height - bottom - (s.height - top - bottom) * (y - Y[0]) / (Y[1] - Y[0]);
  c.lineWidth = 1; c.fillStyle = s.color('soft');
  const tx = ticks(...X, (s.width - left - right) / (4 * em)), ty = ticks(...Y, (s.height - top - bottom) / (1.9 * em));
  c.textAlign = 'center'; c.textBaseline = 'top';
  for (const x of tx.list) { c.strokeStyle = s.color('line'); c.beginPath(); c.moveTo(s.px(x), top); c.lineTo(s.px(x), s.height - bottom); c.stroke(); c.fillText(show(x, tx.decimals), s.px(x), s.height - bottom + 0.3 * em); }
  c.textAlign = 'right'; c.textBaseline = 'middle';
  for (const y of ty.list) { c.strokeStyle = s.color('line'); c.beginPath(); c.moveTo(left, s.py(y)); c.lineTo(s.width - right, s.py(y)); c.stroke(); c.fillText(show(y, ty.decimals), left - 0.45 * em, s.py(y)); }
  c.strokeStyle = s.color('soft');
  if (X[0] < 0 && X[1] > 0) { c.beginPath(); c.moveTo(s.px(0), top); c.lineTo(s.px(0), s.height - bottom); c.stroke(); }
  if (Y[0] < 0 && Y[1] > 0) { c.beginPath(); c.moveTo(left, s.py(0)); c.lineTo(s.width - right, s.py(0)); c.stroke(); }
  c.fillStyle = s.color('ink'); c.textBaseline = 'alphabetic';
  c.textAlign = 'right'; c.fillText(xname, s.width - right, s.height - 0.4 * em);
  c.textAlign = 'left'; c.fillText(yname, 0.4 * em, 1.2 * em);
  return s;
}
function curve(s, points, color, width, dash) {
  s.c.save(); s.c.beginPath(); s.c.rect(...s.box); s.c.clip();
  s.c.strokeStyle = color; s.c.lineWidth = width; s.c.setLineDash(dash || []); s.c.beginPath();
  let pen = false;
  for (const p of points) { if (!p) { pen = false; continue; } if (pen) s.c.lineTo(s.px(p[0]), s.py(p[1])); else s.c.moveTo(s.px(p[0]), s.py(p[1])); pen = true; }
  s.c.stroke(); s.c.restore();
}
function dot(s, x, y, color, radius) {
  const [left, top, width, height] = s.box, px = s.px(x), py = s.py(y);
  if (px < left - 1 || px > left + width + 1 || py < top - 1 || py > top + height + 1) return;  // beyond locked axes
  s.c.fillStyle = color; s.c.strokeStyle = s.color('paper'); s.c.lineWidth = 1.5;
  s.c.beginPath(); s.c.arc(px, py, radius, 0, 7); s.c.fill(); s.c.stroke();
}
function solved(p) {  // a motion with all that the plots show of it
  const m = motion(p), path = [];
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
  return { p, m, path, points, law };
}
function prepare() {
  const p = read();
  current = solved(p);
  for (const name of names) $('o-' + name).textContent = show(p[name], digits[name]);
  $('dragname').textContent = dragUnits[p.law] || say('no_drag'); $('k').disabled = p.law === 3;
  if (p.law === 3) $('o-k').textContent = '';
}
const traced = (motion, x, y) => motion.path.map(q => q && [x(q), y(q)]);
function draw() {
  const { p, m, law } = current, here = m.at(p.t), all = [...kept, current];
  const points = all.flatMap(one => one.points), laws = all.flatMap(one => one.law.flat());
  const jumps = all.flatMap(one => [one.m.A + one.m.F, one.m.A - one.m.F]);
  const limits = all.map(one => one.m.limit).filter(limit => limit !== null);
  let s = frame('av', laws.map(q => q[0]), laws.map(q => q[1]).concat(0, jumps), 'v (m/s)', 'a (m/s²)');
  for (const one of kept) {
    for (const branch of one.law) curve(s, branch, s.color(one.color), 1);
    curve(s, traced(one, q => q.v, q => q.a), s.color(one.color), 2);
  }
  for (const branch of law) curve(s, branch, s.color('soft'), 1);
  if (m.F > 0) curve(s, [[0, m.A + m.F], [0, m.A - m.F]], s.color('soft'), 1, [3, 3]);
  curve(s, traced(current, q => q.v, q => q.a), s.color('first'), 3);
  if (m.limit !== null) dot(s, m.limit, 0, s.color('second'), 6);
  dot(s, here.v, here.a, s.color('third'), 7);
  s = frame('vt', [0, END], points.map(q => q.v).concat(0, limits), 't (s)', 'v (m/s)');
  for (const one of kept) curve(s, traced(one, q => q.t, q => q.v), s.color(one.color), 2);
  if (m.limit !== null) curve(s, [[0, m.limit], [END, m.limit]], s.color('second'), 1.5, [6, 4]);
  curve(s, traced(current, q => q.t, q => q.v), s.color('first'), 3); dot(s, p.t, here.v, s.color('third'), 7);
  s = frame('xt', [0, END], points.map(q => q.x), 't (s)', 'x (m)');
  for (const one of kept) curve(s, traced(one, q => q.t, q => q.x), s.color(one.color), 2);
  curve(s, traced(current, q => q.t, q => q.x), s.color('first'), 3); dot(s, p.t, here.x, s.color('third'), 7);
  drawTrack(here, current.points, p);
  $('readout').textContent = `t = ${show(p.t, 2)} s: x = ${show(here.x, 3)} m, v = ${show(here.v, 3)} m/s, a = ${show(here.a, 3)} m/s². ` + fateWords(p, m);
  reserve();
}
// What the words ever needed stays theirs, so that the plots do not jump, and the bar below covers none of them.
function reserve() {
  const words = $('readout');
  if (words.offsetHeight <= reserved) return;
  reserved = words.offsetHeight; words.style.minHeight = reserved + 'px';
  fit(); draw();
}
function fit() {  // plots are as high as the window leaves room for; of two rows of them the words may lie below the window
  const style = document.documentElement.style, em = parseFloat(getComputedStyle(document.documentElement).fontSize);
  style.removeProperty('--plot');
  const rows = getComputedStyle($('plots')).gridTemplateColumns.split(' ').length === 3 ? 1 : 2;
  const below = rows === 1 ? 0 : $('readout').getBoundingClientRect().height + $('tools').getBoundingClientRect().height;
  const others = $('explorer').getBoundingClientRect().bottom + scrollY - rows * $('xt').clientHeight - below;
  const room = Math.floor((document.documentElement.clientHeight - others) / rows);
  style.setProperty('--plot', Math.max((rows === 1 ? 11 : 8) * em, room) + 'px');
}
function resized() {
  reserved = 0; $('readout').style.minHeight = ''; draw();
}
function change() { prepare(); draw(); }
function pause() { playing = 0; $('play').textContent = say('play'); }
function step(now) {
  if (!playing) return;
  const t = (now - playing) / 1000;
  $('t').value = Math.min(t, END); current.p.t = +$('t').value; $('o-t').textContent = show(current.p.t, 2); draw();
  if (t < END) requestAnimationFrame(step); else pause();
}
$('play').onclick = () => {
  if (playing) return pause();
  const from = current.p.t >= END ? 0 : current.p.t;
  playing = performance.now() - 1000 * from; $('play').textContent = say('pause'); requestAnimationFrame(step);
};
for (const name of names) $(name).oninput = () => { if (name === 't') pause(); change(); };
$('law').onchange = change;
for (const button of document.querySelectorAll('[data-case]')) button.onclick = () => {
  const [law, k, mu, alpha, v0] = button.dataset.case.split(',');
  Object.assign($('law'), { value: law }); $('k').value = k; $('mu').value = mu; $('alpha').value = alpha; $('v0').value = v0; $('t').value = 0;
  pause(); change(); $('play').click();
};
window.addEventListener('resize', resized);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
const off = measured();
document.documentElement.dataset.offX = off.x; document.documentElement.dataset.offV = off.v; document.documentElement.dataset.offA = off.a;
// All words of the page anew, in the language that is chosen.
function inWords() {
  speak();
  const small = x => decimals((x * 1e3).toPrecision(2));
  $('measured').textContent = say('measured', { points: off.points, motions: off.motions, x: small(off.x), v: small(off.v), a: small(off.a) });
  $('play').textContent = say(playing ? 'pause' : 'play');
  legend(); resized();
}
$('language').onchange = () => { language = $('language').value; prepare(); inWords(); };
$('keep').onclick = () => { keep(current.p); resized(); };
$('copy').onclick = copyLink;
window.addEventListener('hashchange', opened);
opened();
