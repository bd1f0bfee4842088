const minus = text => text.replace('-', '\u2212'), show = (x, n) => minus(x.toFixed(n));
// What becomes of the motion p, m = motion(p).
function fate(p, m) {
  const drag = p.k > 0 && DATA.laws[p.law].n > 0;
  if (!m.rests) return { turns: m.stop > 0, ends: drag ? 'limit' : 'faster' };
  if (m.stop !== null) return { turns: false, ends: m.stop > 0 ? 'stops' : m.F > 0 ? 'held' : 'still' };
  return { turns: false, ends: drag ? 'slower' : 'coasts' };  // nothing drives it, and no dry friction stops it
}
function fateWords(p, m) {
  const { turns, ends } = fate(p, m), pull = `${show(Math.abs(m.A), 3)} m/s²`, hold = `${show(m.F, 3)} m/s²`;
  const why = m.A === 0 ? 'nothing pulls it, and friction holds up to ' + hold
                        : `the slope pulls with ${pull}, friction holds up to ${hold}`;
  const jump = m.F > 0 ? `, where a jumps by 2 μ g cos α = ${show(2 * m.F, 3)} m/s²` : '';
  return (turns ? `It turns at t = ${show(m.stop, 3)} s${jump}. ` : '') + {
    limit: () => `It tends to v = ${show(m.limit, 4)} m/s, where drag, friction and slope balance.`,
    faster: () => 'Without drag there is no limit velocity: a is constant.',
    stops: () => `It comes to rest at t = ${show(m.stop, 3)} s and stays: ${why}.`,
    held: () => `It is at rest and stays: ${why}.`,
    still: () => 'It is at rest, and nothing drives it.',
    slower: () => 'It tends to rest without ever reaching it: no dry friction stops it.',
    coasts: () => 'Nothing drives or brakes it: it keeps its speed for ever.',
  }[ends]();
}
