// LANGUAGES: by its code, a language's texts by their keys; and `language`, the one that is chosen. Elements name their
// text in data-text (what it says of numbers and names is in data-values) and their label in data-label.
const decimals = text => text.replace('-', '\u2212').replace('.', LANGUAGES[language].decimal), show = (x, n) => decimals(x.toFixed(n));
const say = (key, values) => LANGUAGES[language][key].replace(/\{(\w+)\}/g, (_, name) => values[name]);
function speak() {
  const all = selector => document.querySelectorAll(selector), menu = document.getElementById('language');
  if (!menu.options.length) for (const code in LANGUAGES) menu.add(new Option(LANGUAGES[code].language_name, code));
  menu.value = language;
  document.documentElement.lang = language;
  for (const e of all('[data-text]')) {
    const values = JSON.parse(e.dataset.values || '{}');
    for (const name in values) if (/^[-\u2212]?\d+\.\d+$/.test(values[name])) values[name] = decimals(values[name]);
    e.textContent = e.dataset.values ? say(e.dataset.text, values).replace(/(\d) (?=(m|mm|s)\b)/g, '$1\u00a0') : say(e.dataset.text);
    e.innerHTML = e.innerHTML.replace(/\b([a-z])_([a-z]+)\b/g, '$1<sub>$2</sub>');
  }
  for (const e of all('[data-label]')) e.setAttribute('aria-label', say(e.dataset.label));
  document.title = document.querySelector('h1').textContent;
}
// A drawing's numbers with the language's decimal sign. Its texts are names and quantities, and stay.
function speakDrawings() {
  const start = 'data:image/svg+xml;base64,';
  for (const image of document.querySelectorAll('img[src^="data:image/svg+xml"]')) {
    image.drawn ??= new TextDecoder().decode(Uint8Array.from(atob(image.src.slice(start.length)), c => c.charCodeAt(0)));
    const svg = image.drawn.replace(/>(\s*[-\u2212]?\d+)\.(\d+\s*)</g, (_, whole, part) => `>${whole}${LANGUAGES[language].decimal}${part}<`);
    image.src = 'data:image/svg+xml,' + encodeURIComponent(svg);
  }
}
