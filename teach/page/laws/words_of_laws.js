// The page of laws in the language that is chosen: its texts, its plots' numbers, and the sheets beside the films.
function lawsInWords() {
  speak(); speakDrawings();
  document.getElementById('meaning').textContent = say('meaning');
  const plots = document.querySelector('[data-plots]');
  if (plots) plots.textContent = say('plots_beside');
  window.dispatchEvent(new Event('resize'));
}
document.getElementById('language').onchange = event => { language = event.target.value; lawsInWords(); };
lawsInWords();
