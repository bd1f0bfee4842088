#include "report/explorer_script.h"

namespace glidelab::report {

const std::string_view kExplorerMotion = R"js(
// An orbit is [tau, u, way, slope] four arrays. Between two points u and way are cubics with the slopes that are known.
function hermite(y0, y1, d0, d1, h, s) {
  const a = s * s * (3 - 2 * s), b = s * (1 - s) * (1 - s), c = s * s * (s - 1);
  return y0 * (1 - a) + y1 * a + h * (d0 * b + d1 * c);
}
function hermiteSlope(y0, y1, d0, d1, h, s) {
  return 6 * s * (1 - s) * (y1 - y0) / h + d0 * (1 - s) * (1 - 3 * s) + d1 * s * (3 * s - 2);
}
function piece(column, value) {  // the last i with column[i] not beyond value, in the column's own direction
  const up = column[column.length - 1] >= column[0];
  let low = 0, high = column.length - 2;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (up ? column[middle] <= value : column[middle] >= value) low = middle; else high = middle - 1;
  }
  return low;
}
function at(orbit, tau) {  // {u, way, slope}
  const [t, u, way, slope] = orbit, last = t.length - 1;
  if (tau >= t[last]) return { u: u[last], way: way[last] + u[last] * (tau - t[last]), slope: slope[last] };
  const i = piece(t, tau), h = t[i + 1] - t[i], s = (tau - t[i]) / h;
  return { u: hermite(u[i], u[i + 1], slope[i], slope[i + 1], h, s),
           way: hermite(way[i], way[i + 1], u[i], u[i + 1], h, s),
           slope: hermiteSlope(u[i], u[i + 1], slope[i], slope[i + 1], h, s) };
}
function tauOf(orbit, value) {  // where u is this value
  const [t, u, , slope] = orbit, last = t.length - 1, up = u[last] >= u[0];
  if (up ? value <= u[0] : value >= u[0]) return t[0];
  if (up ? value >= u[last] : value <= u[last]) return t[last];
  const i = piece(u, value), h = t[i + 1] - t[i];
  let low = 0, high = 1;
  for (let k = 0; k < 50; k++) {
    const s = (low + high) / 2, y = hermite(u[i], u[i + 1], slope[i], slope[i + 1], h, s);
    if ((y < value) === up) low = s; else high = s;
  }
  return t[i] + h * (low + high) / 2;
}

// One side of v = 0: the speed w from w0 on, with the drive B against the drag k w^n.
function side(law, k, B, w0) {
  const n = k > 0 ? law.n : 0, orbits = k > 0 ? law : DATA.laws[DATA.laws.length - 1];
  let W, T, orbit;
  if (B === 0 || (n > 0 && w0 > DATA.fastest * Math.pow(Math.abs(B) / k, 1 / n))) {
    W = w0 || 1; T = n > 0 ? Math.pow(W, 1 - n) / k : 1; orbit = orbits.free;
  } else {
    W = n > 0 ? Math.pow(Math.abs(B) / k, 1 / n) : 1; T = W / Math.abs(B);
    orbit = B < 0 ? orbits.braking : n > 0 && w0 > W ? orbits.falling : orbits.rising;
  }
  const start = tauOf(orbit, w0 / W), from = at(orbit, start);
  const stop = orbit === orbits.braking ? (orbit[0][orbit[0].length - 1] - start) * T : Infinity;
  return { stop, limit: B > 0 && n > 0 ? W : null,
           at(t) {
             const p = at(orbit, start + t / T);
             return { w: W * p.u, way: W * T * (p.way - from.way), a: W / T * p.slope };
           } };
}

// The whole motion: up to two sides, or a rest. p: {law, k, mu, alpha, v0}, alpha in degrees.
function motion(p) {
  const law = DATA.laws[p.law], alpha = p.alpha * Math.PI / 180;
  const A = DATA.g * Math.sin(alpha), F = p.mu * DATA.g * Math.cos(alpha);
  const rests = Math.abs(A) <= F * (1 + 1e-12);
  const parts = [];
  let t = 0, x = 0, v = p.v0;
  if (v !== 0) {
    const s = Math.sign(v), first = side(law, p.k, s * A - F, Math.abs(v));
    parts.push({ t, x, s, side: first });
    if (first.stop < Infinity) { t = first.stop; x += s * first.at(t).way; v = 0; }
  }
  if (v === 0) parts.push(rests ? { t, x, s: 0 } : { t, x, s: Math.sign(A), side: side(law, p.k, Math.abs(A) - F, 0) });
  const stop = parts.length > 1 ? parts[1].t : p.v0 === 0 ? 0 : null;
  const limitSign = A < 0 ? -1 : 1;
  const limit = Math.abs(A) > F ? side(law, p.k, Math.abs(A) - F, 0).limit : 0;
  return { A, F, rests, stop, limit: limit === null ? null : limitSign * limit,
           at(time) {
             const part = parts.length > 1 && time >= parts[1].t ? parts[1] : parts[0];
             if (part.s === 0) return { x: part.x, v: 0, a: 0 };
             const p = part.side.at(time - part.t);
             return { x: part.x + part.s * p.way, v: part.s * p.w, a: part.s * p.a };
           } };
}
// a on the side s of v = 0 at the speed w.
function acceleration(p, m, s, w) {
  return s * side(DATA.laws[p.law], p.k, s * m.A - m.F, w).at(0).a;
}
// How far this page is from the program's own solutions.
function measured() {
  const off = { x: 0, v: 0, a: 0, motions: DATA.references.length, points: 0 };
  for (const r of DATA.references) {
    const m = motion(r);
    r.t.forEach((t, i) => {
      const here = m.at(t);
      for (const q of ['x', 'v', 'a']) off[q] = Math.max(off[q], Math.abs(here[q] - r[q][i]));
      off.points++;
    });
  }
  return off;
}
)js";

}  // namespace glidelab::report
