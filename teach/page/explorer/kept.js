// Curves that stay in the plots for comparison: settings with their motion and the colour that the plots and the legend give them.
const MOST_KEPT = 4, kept = [];
const KEPT_NAMES = ['law', 'k', 'mu', 'alpha', 'v0'];
function keep(p) {
  const color = Array.from({ length: MOST_KEPT }, (_, i) => 'kept' + i).find(c => !kept.some(one => one.color === c));
  kept.push({ ...solved(p), color });
  legend();
}
function settingWords(p) {
  const drag = p.law === 3 ? '' : ', ' + dragUnits[p.law].replace(/ \((.*)\)/, (_, unit) => ` = ${show(p.k, 2)} ${unit}`);
  return `${say('law' + p.law)}${drag}, μ = ${show(p.mu, 4)}, α = ${show(p.alpha, 1)}°, v₀ = ${show(p.v0, 2)} m/s`;
}
function legend() {
  const list = $('kept');
  list.replaceChildren(...kept.map(one => {
    const row = document.createElement('li'), mark = document.createElement('i'), off = document.createElement('button');
    mark.style.background = `var(--${one.color})`;
    off.type = 'button'; off.textContent = '×'; off.setAttribute('aria-label', say('remove') + ': ' + settingWords(one.p));
    off.onclick = () => { kept.splice(kept.indexOf(one), 1); legend(); resized(); };
    row.append(mark, settingWords(one.p), off);
    return row;
  }));
  $('keep').disabled = kept.length === MOST_KEPT;
}
