/// The explorer's page: the track's slope, locked axes, kept curves and links, seen in a browser.
#include <cmath>
#include <string>

#include "base/files/file_io.h"
#include "teach/page/teaching_pages.h"
#include "tests/app/opened_page.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// Without motions to be checked against: these take the longest, and another test does it.
std::string quick_page() {
  static const std::string html = [] {
    teach::PhaseExplorer explorer = teach::explore_phases();
    explorer.references.clear();
    return teach::explorer_page(explorer).html;
  }();
  return html;
}

/// What stands on the page, as text.
constexpr const char* kState = R"js(
const seen = document.documentElement.dataset;
const put = values => { for (const [name, value] of Object.entries(values)) $(name).value = value; change(); };
const state = () => JSON.stringify([read(), kept.map(one => settings(one.p)), language, $('readout').textContent, $('kept').textContent]);
// How many pixels of a canvas have the colour of this name.
function pixels(id, name) {
  const probe = document.createElement('canvas').getContext('2d');
  probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim(); probe.fillRect(0, 0, 1, 1);
  const [r, g, b] = probe.getImageData(0, 0, 1, 1).data, canvas = $(id), found = [];
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] === r && data[i + 1] === g && data[i + 2] === b && data[i + 3] === 255) found.push([i / 4 % canvas.width, Math.floor(i / 4 / canvas.width)]);
  }
  return found;
}
)js";

}  // namespace

TEST_CASE("the explorer's track stands on the screen at the angle of its slider") {
  const tests::TempDir temp;
  // A straight line through the pixels of the track's colour; x to the right, y down, so that alpha turns it clockwise.
  const std::string script = std::string(kState) + R"js(
for (const alpha of [-4, 0, 1, 4, 8]) {
  put({ alpha });
  const points = pixels('track', 'track'), mean = i => points.reduce((sum, p) => sum + p[i], 0) / points.length, x = mean(0), y = mean(1);
  const slope = points.reduce((sum, p) => sum + (p[0] - x) * (p[1] - y), 0) / points.reduce((sum, p) => sum + (p[0] - x) ** 2, 0);
  const width = Math.max(...points.map(p => p[0])) - Math.min(...points.map(p => p[0]));
  seen['a' + (alpha + 4)] = Math.atan(slope) * 180 / Math.PI; seen['w' + (alpha + 4)] = width / Math.cos(alpha * Math.PI / 180);
}
)js";
  for (const int width : {1280, 500}) {
    const auto opened = tests::open_with(temp.path(), quick_page(), script, width, 800);
    if (!opened) {
      WARN("skipped: no chromium program");
      return;
    }
    for (const int alpha : {-4, 0, 1, 4, 8}) {
      INFO(width << " px, " << alpha << " degrees");
      const std::string of = std::to_string(alpha + 4);
      // Whole pixels of a track at least 200 px long err by half a pixel at their edges: 0.1 degrees at the very most.
      CHECK(std::abs(std::stod(opened->data.at("a" + of)) - alpha) < 0.1);
      CHECK(std::stod(opened->data.at("w" + of)) > 200.0);
      CHECK(std::abs(std::stod(opened->data.at("w" + of)) - std::stod(opened->data.at("w4"))) < 3.0);
    }
  }
}

TEST_CASE("while the explorer's axes are locked no slider rescales them") {
  const tests::TempDir temp;
  const auto opened = tests::open_with(temp.path(), quick_page(), std::string(kState) + R"js(
const axes = () => JSON.stringify(spans), first = axes();
$('lock').checked = true; put({ law: 3, alpha: 8, mu: 0, v0: 2 });
seen.locked = axes() === first;
seen.outside = current.points[POINTS].x > spans.xt[1][1];  // 5 s of g sin 8 degrees: the curve leaves the plot
$('lock').checked = false; change();
seen.free = axes() !== first && current.points[POINTS].x < spans.xt[1][1];
)js");
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened->data.at("locked") == "true");
  CHECK(opened->data.at("outside") == "true");
  CHECK(opened->data.at("free") == "true");
}

TEST_CASE("a kept curve stays in the explorer's three plots under its law and values until it is removed") {
  const tests::TempDir temp;
  const auto opened = tests::open_with(temp.path(), quick_page(), std::string(kState) + R"js(
const drawn = () => ['xt', 'vt', 'av'].map(id => Math.sign(pixels(id, 'kept0').length)).join('');
put({ law: 0, k: 2.5, mu: 0.01, alpha: 4, v0: -1 }); seen.before = drawn();
$('keep').click(); put({ law: 2, k: 1, mu: 0, alpha: 1, v0: 1 });
seen.during = drawn(); seen.legend = $('kept').textContent; seen.limit = kept[0].m.limit;
$('kept').querySelector('button').click(); seen.after = drawn(); seen.left = kept.length;
for (let i = 0; i < MOST_KEPT; i++) $('keep').click();
seen.full = $('keep').disabled; seen.colors = new Set(kept.map(one => one.color)).size;
)js");
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened->messages.find("Uncaught") == std::string::npos);
  CHECK(opened->data.at("before") == "000");
  CHECK(opened->data.at("during") == "111");
  CHECK(opened->data.at("legend") == "viscous, K/m = 2.50 1/s, μ = 0.0100, α = 4.0°, v₀ = −1.00 m/s×");
  const double alpha = 4.0 * std::acos(-1.0) / 180.0;
  CHECK(std::abs(std::stod(opened->data.at("limit")) - 9.80665 * (std::sin(alpha) - 0.01 * std::cos(alpha)) / 2.5) <
        1e-9);
  CHECK(opened->data.at("after") == "000");
  CHECK(opened->data.at("left") == "0");
  CHECK(opened->data.at("full") == "true");
  CHECK(opened->data.at("colors") == "4");
}

TEST_CASE("a link of the explorer restores the page that it was copied from") {
  const tests::TempDir temp;
  const std::string tell = std::string(kState) + "seen.state = state(); seen.link = fragment();\n";
  const auto made = tests::open_with(temp.path(), quick_page(), std::string(kState) + R"js(
put({ law: 1, k: 3.5, mu: 0.02, alpha: -2.5, v0: 1.7 }); $('keep').click();
put({ law: 2, k: 0.75, mu: 0.0123, alpha: 7.9, v0: -1.33, t: 2.5 });
$('copy').click();
seen.state = state(); seen.link = fragment(); seen.address = location.hash; seen.shown = $('link').value.endsWith(fragment());
)js");
  if (!made) {
    WARN("skipped: no chromium program");
    return;
  }
  std::string link = made->data.at("link");
  for (std::size_t at = link.find("&amp;"); at != std::string::npos; at = link.find("&amp;")) link.replace(at, 5, "&");
  CHECK(link ==
        "#law=quadratic&k=0.75&mu=0.0123&alpha=7.9&v0=-1.33&t=2.5&language=en&keep=power-3/2,3.5,0.02,-2.5,1.7");
  CHECK(made->data.at("address") == made->data.at("link"));
  CHECK(made->data.at("shown") == "true");
  base::write_file(temp / "again.html", quick_page() + "<script>" + tell + "</script>");
  const auto again = tests::open_page((temp / "again.html").string() + link);
  REQUIRE(again);
  CHECK(again->data.at("link") == made->data.at("link"));
  CHECK(again->data.at("state") == made->data.at("state"));
}

TEST_CASE("a link that does not fit the explorer changes nothing, and the page says what is wrong with it") {
  const tests::TempDir temp;
  base::write_file(temp / "asked.html", quick_page() + "<script>" + std::string(kState) +
                                            "seen.said = $('notice').textContent; seen.mu = $('mu').value;</script>");
  for (const auto& [link, said] : {std::pair{"#law=viscous&mu=0.5", "mu = 0.5; allowed: 0 … 0.03"},
                                   {"#mu=", "mu = ; allowed"},
                                   {"#mu=0.02&law=cubic", "law = cubic; allowed: viscous, power-3/2, quadratic, none"},
                                   {"#mu=0.02&mass=1", "it has mass = 1"},
                                   {"#mu=0.02&keep=viscous,1", "it has keep = viscous,1"},
                                   {"#mu=0.02&keep=viscous,1,0,9,0", "alpha = 9; allowed: -4 … 8"},
                                   {"#mu=0.02&language=tlh", "it has language = tlh"}}) {
    const auto opened = tests::open_page((temp / "asked.html").string() + link);
    if (!opened) {
      WARN("skipped: no chromium program");
      return;
    }
    INFO(link << ": " << opened->data.at("said"));
    CHECK(opened->data.at("said").find(said) != std::string::npos);
    CHECK(opened->data.at("mu") == "0.0071");
  }
}

TEST_CASE("the explorer speaks the language that is chosen, with its decimal sign, and the link keeps it") {
  const tests::TempDir temp;
  const auto opened = tests::open_with(temp.path(), quick_page(), std::string(kState) + R"js(
put({ law: 0, k: 2.5, mu: 0.01, alpha: 4, v0: -1 }); $('keep').click();
for (const code of Object.keys(LANGUAGES)) {
  $('language').value = code; $('language').onchange();
  const words = document.querySelector('main').innerText, english = LANGUAGES.en;
  // Sentences and labels that stand on the page as they do in English.
  seen[code + 'Left'] = [...document.querySelectorAll('[data-text]')].filter(e => e.textContent === english[e.dataset.text]).map(e => e.dataset.text).join(' ');
  seen[code + 'Empty'] = [...document.querySelectorAll('[data-text]')].filter(e => !e.textContent).length;
  seen[code + 'Numbers'] = $('o-mu').textContent + ' ' + $('readout').textContent.match(/v = (\S+)/)[1] + ' ' + $('kept').textContent.match(/μ = (\S+) ?/)[1];
  seen[code + 'Points'] = (words.match(/\d\.\d/g) || []).length;
  seen[code + 'Lang'] = document.documentElement.lang + ' ' + document.title;
  seen[code + 'Wide'] = document.documentElement.scrollWidth - innerWidth;
  seen[code + 'Link'] = new URLSearchParams(fragment().slice(1)).get('language');
}
)js");
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened->messages.find("Uncaught") == std::string::npos);
  for (const std::string code : {"de", "es", "fr", "pt"}) {
    INFO(code);
    CHECK(opened->data.at(code + "-left").empty());
    CHECK(opened->data.at(code + "-empty") == "0");
    CHECK(opened->data.at(code + "-numbers").starts_with("0,0100 0,154 0,0100"));
    CHECK(opened->data.at(code + "-points") == "0");
    CHECK(opened->data.at(code + "-lang").starts_with(code + " "));
    CHECK(opened->data.at(code + "-link") == code);
    CHECK(std::stod(opened->data.at(code + "-wide")) <= 0.0);
  }
  CHECK(opened->data.at("en-numbers").starts_with("0.0100 0.154 0.0100"));
  CHECK(opened->data.at("de-lang") == "de Reibung in der Phasenebene");
}
