/// What a browser makes of a page's style: dark, narrow, printed. Skipped where there is no chromium.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "base/errors.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "report/html/html.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// What chromium prints, or nothing where it is not there.
std::optional<std::string> browser(const std::filesystem::path& folder, std::vector<std::string> arguments) {
  std::vector<std::string> all = {"--headless", "--no-sandbox", "--disable-gpu"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const std::filesystem::path log = folder / "browser.txt";
  try {
    if (base::run_program("chromium", all, log) != 0) return std::nullopt;
  } catch (const base::EnvironmentError&) {
    return std::nullopt;
  }
  return base::read_file(log);
}

/// A plot, a photograph, a film, a table that is too wide, and one whose first column holds numbers.
std::string page_with(const std::string& script) {
  report::Html body("<h1>look</h1>");
  body += report::figures({{{"plot sin(x)", {}}, "a curve", "a curve"}});
  body +=
      "<figure><img id=\"photo\" alt=\"\" src=\"data:image/gif;base64,R0lGODlhAQABAAAAACw=\">"
      "<figcaption>photograph</figcaption></figure>\n<figure><video></video><figcaption>film</figcaption></figure>\n";
  report::HtmlTable wide({"direction", "what", "prose"}, 9), numbers({"n", "size"});
  const std::string words = "as many words as a line can hold and then some more of them";
  wide.row({"of a friction", "v &lt; 0", words + " " + words + " " + words + std::string(300, 'm')});
  numbers.row({"7", "1"});
  body += wide.str() + numbers.str();
  std::string html = report::page("look", body).html;
  const std::size_t end = html.find("</body>");
  return html.insert(end, "<script>const said = document.documentElement.dataset;\n" + script + "</script>");
}

bool says(const std::string& dom, const std::string& what) {
  return dom.find("data-" + what) != std::string::npos;
}

}  // namespace

TEST_CASE("on a dark page plots are dark and photographs as they are, and a light one changes nothing") {
  const tests::TempDir temp;
  base::write_file(temp / "page.html", page_with("const filter = (e) => getComputedStyle(e).filter;\n"
                                                 "said.photo = filter(document.getElementById('photo'));\n"
                                                 "said.plot = filter(document.querySelector('img'));\n"));
  const std::string at = "file://" + (temp / "page.html").string();
  for (const bool dark : {true, false}) {
    const auto dom = browser(
        temp.path(), {std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"), "--dump-dom", at});
    if (!dom) {
      WARN("skipped: no chromium program");
      return;
    }
    CHECK(says(*dom, "photo=\"none\""));
    CHECK(says(*dom, "plot=\"none\"") == !dark);
    CHECK(says(*dom, "plot=\"invert(") == dark);
  }
}

namespace {

/// WCAG 2.1: (L1 + 0.05) / (L2 + 0.05) of the relative luminances of two greys, 0 to 1 each.
double contrast(double one, double other) {
  const auto luminance = [](double grey) {
    return grey <= 0.03928 ? grey / 12.92 : std::pow((grey + 0.055) / 1.055, 2.4);
  };
  const auto [least, most] = std::minmax({luminance(one), luminance(other)});
  return (most + 0.05) / (least + 0.05);
}

}  // namespace

TEST_CASE("a thin grey line is as clear as small text has to be, on white paper and on a dark page") {
  const std::string two(report::kThinGrey.substr(1, 2));
  REQUIRE(report::kThinGrey == "#" + two + two + two);
  const double grey = std::stoi(two, nullptr, 16) / 255.0;
  const auto inverted = [](double value) { return value + 0.9 * (1.0 - 2.0 * value); };  // CSS: invert(0.9)
  constexpr double kOfSmallText = 4.5;                                                   // WCAG 2.1, 1.4.3
  CHECK(contrast(grey, 1.0) > kOfSmallText);
  CHECK(contrast(inverted(grey), inverted(1.0)) > kOfSmallText);
}

TEST_CASE("a page that begins with its answer has no heading above it") {
  const tests::TempDir temp;
  const std::string meaning = report::meaning_section("<p>Yes.</p>\n");
  std::string html = report::page("look", report::question_heading("mine", "Is it so?") + meaning).html;
  html.insert(html.find("</body>"),
              "<script>document.documentElement.dataset.shown = "
              "getComputedStyle(document.getElementById('meaning')).display;</script>");
  base::write_file(temp / "page.html", html);
  const auto dom = browser(temp.path(), {"--dump-dom", "file://" + (temp / "page.html").string()});
  if (!dom) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(says(*dom, "shown=\"none\""));
}

TEST_CASE("in a narrow block two long cells stand side by side without overlap, and prose has the whole width") {
  const tests::TempDir temp;
  report::HtmlTable table({"what", "found", "wanted", "in words"}, 1);
  table.stack_when_narrow(1);
  const std::string found = "50 % (2 of 4; 95 %: 7 to 93 %) of so many cases as these";
  table.row({"the main cause is named first", found, "at least 85 %: missed by a lot", "–"});
  report::HtmlTable prose({"effect", "what it is"}, 2);
  prose.stack_when_narrow(1);
  const std::string words = "a drag that grows with the square of the speed, such as that of air: a force −c v |v|";
  prose.row({"quadratic drag", words + "; " + words});
  std::string html = report::page("look", report::Html(table.str() + prose.str())).html;
  html.insert(html.find("</body>"),
              "<script>const said = document.documentElement.dataset;\n"
              "const inside = (cell) => { const range = document.createRange(); range.selectNodeContents(cell);\n"
              "  return range.getBoundingClientRect(); };\n"
              "const [tables, texts] = document.querySelectorAll('table');\n"
              "const cells = tables.querySelectorAll('td');\n"
              "said.apart = inside(cells[1]).right <= inside(cells[2]).left || "
              "inside(cells[1]).bottom <= inside(cells[2]).top;\n"
              "said.wide = texts.querySelectorAll('td')[1].clientWidth > 0.9 * texts.clientWidth;</script>");
  base::write_file(temp / "page.html", html);
  const auto dom =
      browser(temp.path(), {"--window-size=500,900", "--dump-dom", "file://" + (temp / "page.html").string()});
  if (!dom) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(says(*dom, "apart=\"true\""));
  CHECK(says(*dom, "wide=\"true\""));
}

TEST_CASE("a table that is cut shows a shadow that stays, short cells keep one line, and numbers no width for names") {
  const tests::TempDir temp;
  base::write_file(temp / "page.html",
                   page_with("const [wide, narrow] = document.querySelectorAll('.scroll');\n"
                             "said.cut = wide.scrollWidth > wide.clientWidth;\n"
                             "said.page = document.documentElement.scrollWidth <= innerWidth;\n"
                             "const attached = getComputedStyle(wide).backgroundAttachment.split(', ');\n"
                             "said.shadow = attached.includes('scroll') && attached.includes('local');\n"
                             "const range = document.createRange();\n"
                             "range.selectNodeContents(wide.querySelectorAll('td')[1]);\n"
                             "said.lines = range.getClientRects().length;\n"
                             "said.spare = narrow.querySelector('td').clientWidth < 60;\n"
                             "said.prose = wide.querySelectorAll('td')[2].clientWidth > 180;\n"));
  const auto dom =
      browser(temp.path(), {"--window-size=500,900", "--dump-dom", "file://" + (temp / "page.html").string()});
  if (!dom) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(says(*dom, "cut=\"true\""));
  CHECK(says(*dom, "page=\"true\""));
  CHECK(says(*dom, "shadow=\"true\""));
  CHECK(says(*dom, "lines=\"1\""));
  CHECK(says(*dom, "prose=\"true\""));  // 22ch
  CHECK(says(*dom, "spare=\"true\""));  // 13ch are some 125 pixels
}

namespace {

/// What its scripts say of the page 400 pixels wide, which a window of chromium is not: a frame within one.
std::optional<std::string> seen_on_a_phone(const std::filesystem::path& folder, const std::string& html) {
  base::write_file(folder / "page.html", html);
  base::write_file(
      folder / "phone.html",
      "<!doctype html><html><body><iframe src=\"page.html\" width=\"400\" height=\"900\"></iframe></body>");
  return browser(folder,
                 {"--allow-file-access-from-files", "--dump-dom", "file://" + (folder / "phone.html").string()});
}

}  // namespace

TEST_CASE("on a narrow screen a plot fits, and one too wide for that scrolls below a shadow") {
  const tests::TempDir temp;
  const report::Plot wide{{"plot sin(x)", {}, {620, 420}}, "wide", "wide"};
  const report::Plot plain{{"plot sin(x)", {}}, "plain", "plain"};
  std::string html = report::page("look", report::figures({plain, wide})).html;
  html.insert(html.find("</body>"),
              "<script>const said = parent.document.documentElement.dataset;\n"
              "const [plain, wide] = document.querySelectorAll('figure');\n"
              "const cut = (box) => box.scrollWidth > box.clientWidth;\n"
              "said.fits = !cut(plain) && plain.querySelector('.scroll') === null;\n"
              "said.scrolls = cut(wide.querySelector('.scroll'));\n"
              "said.seen = getComputedStyle(wide.querySelector('img')).mixBlendMode;</script>");
  const auto dom = seen_on_a_phone(temp.path(), html);
  if (!dom) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(says(*dom, "fits=\"true\""));
  CHECK(says(*dom, "scrolls=\"true\""));
  CHECK((says(*dom, "seen=\"darken\"") || says(*dom, "seen=\"lighten\"")));  // the shadow below shows through
}

TEST_CASE("in a narrow block long numbers stand below each other, not beside each other and cut") {
  const tests::TempDir temp;
  report::HtmlTable table({"masses", "K/m (1/s)", "µ", "α (°)"}, 1);
  table.stack_when_narrow(1);
  table.row({"m1", "2.76699 ± 0.00012", "0.0049995912345 ± 0.0000009912345", "4.31 ± 0.01"});
  std::string html = report::page("look", report::Html(table.str())).html;
  html.insert(html.find("</body>"),
              "<script>const said = parent.document.documentElement.dataset, box = document.querySelector('.scroll');\n"
              "const cells = document.querySelectorAll('td');\n"
              "said.whole = box.scrollWidth <= box.clientWidth;\n"
              "said.below = cells[2].offsetTop > cells[1].offsetTop;</script>");
  const auto dom = seen_on_a_phone(temp.path(), html);
  if (!dom) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(says(*dom, "whole=\"true\""));
  CHECK(says(*dom, "below=\"true\""));
}

TEST_CASE("four images stand in one row or two by two, a note with a list is as wide as one without") {
  const tests::TempDir temp;
  std::string images;
  for (int i = 0; i < 4; ++i) images += "<figure><figcaption>picture</figcaption></figure>";
  std::string html =
      report::page("look", "<div class=\"figures\">" + images +
                               "</div><p class=\"note\">text</p><div class=\"note\"><ul><li>text</li></ul>"
                               "</div>")
          .html;
  html.insert(html.find("</body>"),
              "<script>const rows = new Set([...document.querySelectorAll('.figures figure')].map(f => f.offsetTop));\n"
              "document.documentElement.dataset.rows = rows.size;\n"
              "const [one, other] = document.querySelectorAll('.note');\n"
              "document.documentElement.dataset.wide = one.clientWidth == other.clientWidth;</script>");
  base::write_file(temp / "page.html", html);
  for (const auto& [width, rows] : {std::pair(1280, 1), std::pair(900, 2)}) {
    const auto dom = browser(temp.path(), {"--window-size=" + std::to_string(width) + ",900", "--dump-dom",
                                           "file://" + (temp / "page.html").string()});
    if (!dom) {
      WARN("skipped: no chromium program");
      return;
    }
    CHECK(says(*dom, "rows=\"" + std::to_string(rows) + "\""));
    CHECK(says(*dom, "wide=\"true\""));
  }
}

TEST_CASE("a printed page has its photographs and no empty box where a film was") {
  const tests::TempDir temp;
  base::write_file(temp / "page.html", page_with(""));
  const std::string pdf = (temp / "page.pdf").string();
  if (!browser(temp.path(), {"--print-to-pdf=" + pdf, "file://" + (temp / "page.html").string()})) {
    WARN("skipped: no chromium program");
    return;
  }
  if (std::system(("pdftotext '" + pdf + "' '" + pdf + ".txt'").c_str()) != 0) {
    WARN("skipped: no pdftotext program");
    return;
  }
  const std::string text = base::read_file(pdf + ".txt");
  CHECK(text.find("photograph") != std::string::npos);
  CHECK(text.find("film") == std::string::npos);
}
