// What becomes of the motion p, m = motion(p).
function fate(p, m) {
  const drag = p.k > 0 && DATA.laws[p.law].n > 0;
  if (!m.rests) return { turns: m.stop > 0, ends: drag ? 'limit' : 'faster' };
  if (m.stop !== null) return { turns: false, ends: m.stop > 0 ? 'stops' : m.F > 0 ? 'held' : 'still' };
  return { turns: false, ends: drag ? 'slower' : 'coasts' };  // nothing drives it, and no dry friction stops it
}
function fateWords(p, m) {
  const { turns, ends } = fate(p, m), t = m.stop === null ? '' : show(m.stop, 3), v = m.limit === null ? '' : show(m.limit, 4);
  const why = say(m.A === 0 ? 'nothing_pulls' : 'slope_pulls', { pull: show(Math.abs(m.A), 3), hold: show(m.F, 3) });
  const turn = !turns ? '' : say(m.F > 0 ? 'turns_with_jump' : 'turns', { t, jump: show(2 * m.F, 3) }) + ' ';
  return turn + say(ends, { t, v, why });
}
