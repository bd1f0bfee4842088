// LANGUAGES: by its code, a language's texts by their keys, and `language`, the one that is chosen. Elements name their
// text in data-text (what a text says of numbers or names is in data-values) and their label in data-label.
const decimals = text => text.replace('-', '\u2212').replace('.', LANGUAGES[language].decimal), show = (x, n) => decimals(x.toFixed(n));
const say = (key, values) => LANGUAGES[language][key].replace(/\{(\w+)\}/g, (_, name) => values[name]);
function speak() {
  if (!$('language').options.length) for (const code in LANGUAGES) $('language').add(new Option(LANGUAGES[code].language_name, code));
  document.documentElement.lang = language; document.title = say('title'); $('language').value = language;
  for (const e of document.querySelectorAll('[data-text]')) e.textContent = say(e.dataset.text);
  for (const e of document.querySelectorAll('[data-label]')) e.setAttribute('aria-label', say(e.dataset.label));
}
