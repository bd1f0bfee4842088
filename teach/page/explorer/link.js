// The settings as a link's fragment: #law=viscous&k=2.77&mu=0.0071&alpha=4.3&v0=-1.2&t=1&language=en, and one
// keep=viscous,2.77,0.0071,4.3,-1.2 a kept curve.
const LAW_NAMES = ['viscous', 'power-3/2', 'quadratic', 'none'];
const settings = p => [LAW_NAMES[p.law], p.k, p.mu, p.alpha, p.v0].join(',');
function fragment() {
  const p = read(), link = new URLSearchParams({ law: LAW_NAMES[p.law] });
  for (const name of names) link.set(name, p[name]);
  link.set('language', language);
  for (const one of kept) link.append('keep', settings(one.p));
  return '#' + link.toString().replace(/%2C/g, ',').replace(/%2F/g, '/');
}
// What a link asks for: { settings, kept, language }, or in `wrong` why it is not one of this page.
function settingsIn(hash) {
  const result = { settings: {}, kept: [], wrong: [] };
  const take = (name, text) => {
    const range = name === 'law' ? null : $(name), value = name === 'law' ? LAW_NAMES.indexOf(text) : Number(text);
    const fits = name === 'law' ? value >= 0 : text.trim() !== '' && value >= +range.min && value <= +range.max;
    if (!fits) result.wrong.push(say('wrong_value', { name, text, allowed: range ? `${range.min} … ${range.max}` : LAW_NAMES.join(', ') }));
    return value;
  };
  for (const [name, text] of new URLSearchParams(hash.slice(1))) {
    if (name === 'law' || names.includes(name)) {
      result.settings[name] = take(name, text);
    } else if (name === 'language' && Object.hasOwn(LANGUAGES, text)) {
      result.language = text;
    } else if (name === 'keep' && text.split(',').length === KEPT_NAMES.length && result.kept.length < MOST_KEPT) {
      const values = text.split(',');
      result.kept.push(Object.fromEntries(KEPT_NAMES.map((key, i) => [key, take(key, values[i])])));
    } else {
      result.wrong.push(say('wrong_key', { name, text }));
    }
  }
  return result;
}
// When the page is opened, and when the address changes: as the link says, or all as it was and what is wrong with it.
function opened() {
  const link = settingsIn(location.hash);
  $('notice').textContent = link.wrong.join(' ');
  if (!link.wrong.length) {
    language = link.language || language;
    for (const [name, value] of Object.entries(link.settings)) $(name).value = value;
    if (location.hash) kept.length = 0;
    for (const p of link.kept) keep(p);
  }
  pause(); prepare(); inWords();
}
// Into the address bar and the clipboard. A page may not be let at the clipboard: then the link is there to be copied by hand.
function copyLink() {
  const link = location.href.split('#')[0] + fragment(), field = $('link');
  history.replaceState(null, '', fragment());
  $('copied').textContent = '';
  field.value = link; field.hidden = false; field.select(); resized();
  if (navigator.clipboard) navigator.clipboard.writeText(link).then(() => { $('copied').textContent = say('copied'); resized(); }, () => {});
}
