// An orbit is [tau, u, distance, slope, bend], five arrays. Between two points u is the polynomial of fifth order in s (0 to 1)
// with the values, slopes and bends that are known at both; a distance is its integral.
function polynomial(orbit, i) {  // h, and u = c[0] + c[1] s + ... + c[5] s^5
  const [t, u, , slope, bend] = orbit, h = t[i + 1] - t[i];
  const d = u[i + 1] - u[i], p = h * slope[i], q = h * slope[i + 1], b = h * h * bend[i] / 2, e = h * h * bend[i + 1] / 2;
  return { h, c: [u[i], p, b, 10 * d - 6 * p - 4 * q - 3 * b + e, -15 * d + 8 * p + 7 * q + 3 * b - 2 * e,
                  6 * d - 3 * p - 3 * q - b + e] };
}
const valueOf = ({ c }, s) => c.reduceRight((sum, k) => k + s * sum, 0);
const slopeOf = ({ h, c }, s) => c.reduceRight((sum, k, i) => i ? i * k + s * sum : sum, 0) / h;
const integralOf = ({ h, c }, s) => h * s * c.reduceRight((sum, k, i) => k / (i + 1) + s * sum, 0);
function piece(column, value) {  // the last i with column[i] not beyond value, in the column's own direction
  const up = column[column.length - 1] >= column[0];
  let low = 0, high = column.length - 2;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (up ? column[middle] <= value : column[middle] >= value) low = middle; else high = middle - 1;
  }
  return low;
}
function at(orbit, tau) {  // {u, slope, and where in the orbit that is: the point before it, and the distance from there}
  const [t, u, , slope] = orbit, last = t.length - 1;
  if (tau >= t[last]) return { u: u[last], slope: slope[last], i: last, distance: u[last] * (tau - t[last]) };
  const i = piece(t, tau), p = polynomial(orbit, i), s = (tau - t[i]) / p.h;
  return { u: valueOf(p, s), slope: slopeOf(p, s), i, distance: integralOf(p, s) };
}
// The distance between two places. Within one piece it is not taken from the distance along the whole orbit, in which it would drown.
function distanceBetween(orbit, from, to) {
  return (from.i === to.i ? 0 : orbit[2][to.i] - orbit[2][from.i]) + (to.distance - from.distance);
}
function tauOf(orbit, value) {  // where u is this value
  const [t, u] = orbit, last = t.length - 1, up = u[last] >= u[0];
  if (up ? value <= u[0] : value >= u[0]) return t[0];
  if (up ? value >= u[last] : value <= u[last]) return t[last];
  const i = piece(u, value), p = polynomial(orbit, i);
  let low = 0, high = 1;
  for (let k = 0; k < 60; k++) {
    const s = (low + high) / 2;
    if ((valueOf(p, s) < value) === up) low = s; else high = s;
  }
  return t[i] + p.h * (low + high) / 2;
}

// One side of v = 0: the speed w from w0 on, with the drive B against the drag k w^n.
function side(law, k, B, w0) {
  const n = k > 0 ? law.n : 0, orbits = k > 0 ? law : DATA.laws[DATA.laws.length - 1];
  let W, T, orbit;
  if (B === 0) {
    W = w0 || 1; T = n > 0 ? Math.pow(W, 1 - n) / k : 1; orbit = orbits.free;
  } else {
    W = n > 0 ? Math.pow(Math.abs(B) / k, 1 / n) : 1; T = W / Math.abs(B);
    orbit = B < 0 ? orbits.braking : n > 0 && w0 > W ? orbits.falling : orbits.rising;
  }
  if (w0 / W > Math.max(1, orbit[1][0], orbit[1][orbit[1].length - 1])) throw new RangeError('faster than the orbits were solved for');
  const start = tauOf(orbit, w0 / W), from = at(orbit, start);
  const stop = orbit === orbits.braking ? (orbit[0][orbit[0].length - 1] - start) * T : Infinity;
  return { stop, limit: B > 0 && n > 0 ? W : null,
           at(t) {
             const p = at(orbit, start + t / T);
             return { w: W * p.u, distance: W * T * distanceBetween(orbit, from, p), a: W / T * p.slope };
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
    if (first.stop < Infinity) { t = first.stop; x += s * first.at(t).distance; v = 0; }
  }
  if (v === 0) parts.push(rests ? { t, x, s: 0 } : { t, x, s: Math.sign(A), side: side(law, p.k, Math.abs(A) - F, 0) });
  const stop = parts.length > 1 ? parts[1].t : p.v0 === 0 ? 0 : null;
  const limitSign = A < 0 ? -1 : 1;
  // Where a falls through 0: nowhere on the level without drag and friction, where every speed lasts.
  const balance = !rests ? side(law, p.k, Math.abs(A) - F, 0).limit : F > 0 || (p.k > 0 && law.n > 0) ? 0 : null;
  return { A, F, rests, stop, limit: balance === null ? null : limitSign * balance,
           at(time) {
             const part = parts.length > 1 && time >= parts[1].t ? parts[1] : parts[0];
             if (part.s === 0) return { x: part.x, v: 0, a: 0 };
             const p = part.side.at(time - part.t);
             return { x: part.x + part.s * p.distance, v: part.s * p.w, a: part.s * p.a };
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
