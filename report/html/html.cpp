#include "report/html/html.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cstdint>

#include "base/files/file_io.h"
#include "base/text/number_text.h"
#include "base/text/pattern.h"
#include "report/html/gnuplot.h"

namespace glidelab::report {

namespace {

constexpr std::array<std::string_view, 3> kVerbatim = {"code", "script", "style"};
constexpr std::string_view kNoBreak = "\u00a0", kPlusMinus = " ± ";
constexpr std::array<std::string_view, 36> kUnits = {
    "%",     "°",     "m",   "mm",  "µm",   "nm",   "s",   "ms",    "µs",    "ns",  "kg",   "g",
    "N",     "mN",    "µN",  "Hz",  "px",   "px²",  "ppm", "EUR",   "DN",    "m/s", "mm/s", "m/s²",
    "mm/s²", "µm/s²", "1/s", "1/m", "1/m²", "kg/m", "N/m", "N s/m", "DN/e⁻", "e⁻",  "e⁻/s", "px/s"};

/// The character that ends before `at` (above 0) in UTF-8.
char32_t character_before(std::string_view text, std::size_t at) {
  char32_t value = 0;
  unsigned shift = 0;
  do {
    const auto byte = static_cast<unsigned char>(text[--at]);
    const bool continues = (byte & 0xC0u) == 0x80u;
    const unsigned bits = continues      ? 0x3Fu
                          : byte < 0x80u ? 0x7Fu
                          : byte < 0xE0u ? 0x1Fu
                          : byte < 0xF0u ? 0x0Fu
                                         : 0x07u;
    value |= static_cast<char32_t>(byte & bits) << shift;
    if (!continues) break;
    shift += 6;
  } while (at > 0 && shift < 24);
  return value;
}

/// Whether the character belongs to a word that a hyphen would join, including letters of other alphabets: those from
/// U+00C0 on except the signs × and ÷ and the block of punctuation and mathematical signs, U+2000 to U+2BFF.
bool joins(char32_t c) {
  if (c < 0x80) return std::isalnum(static_cast<int>(c)) != 0 || c == '-' || c == '_' || c == '.' || c == ']';
  return c == U'µ' || (c >= 0xC0 && c != U'×' && c != U'÷' && (c < 0x2000 || c >= 0x2C00));
}

bool opens(std::string_view tag, std::string_view name) {
  return tag.starts_with(name) &&
         (tag.size() == name.size() || !std::isalnum(static_cast<unsigned char>(tag[name.size()])));
}

/// The end of the markup that begins at the "<" at `at`: after the tag, or after a verbatim element.
std::size_t end_of_markup(std::string_view html, std::size_t at) {
  const std::size_t behind = std::min(html.find('>', at), html.size() - 1) + 1;
  const std::string_view tag = html.substr(at + 1, behind - at - 2);
  for (const std::string_view name : kVerbatim) {
    if (opens(tag, name)) return std::min(html.find("</" + std::string(name), behind), html.size());
  }
  return behind;
}

/// Whether this byte could continue a unit, making it part of a longer word.
bool goes_on(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || byte >= 0x80u || c == '/' || c == '_' || c == '-';
}

/// The unit after the space at `at`, without the space; "" if there is none.
std::string_view unit_behind(std::string_view html, std::size_t at) {
  const std::string_view rest = html.substr(at + 1);
  std::string_view longest;
  for (const std::string_view unit : kUnits) {
    const bool whole = rest.starts_with(unit) && (rest.size() == unit.size() || !goes_on(rest[unit.size()]));
    if (whole && unit.size() > longest.size()) longest = unit;
  }
  return longest;
}

/// How many bytes from the space at `at` on belong to the preceding number; 0 if a line may begin there.
std::size_t joined_behind(std::string_view html, std::size_t at) {
  if (html[at] != ' ' || at == 0) return 0;
  if (base::is_digit(html[at - 1]) && html.substr(at).starts_with(kPlusMinus)) return kPlusMinus.size();
  const std::string_view unit = base::is_digit(html[at - 1]) || html[at - 1] == ')' ? unit_behind(html, at) : "";
  return unit.empty() ? 0 : 1 + unit.size();
}

}  // namespace

std::string typeset_numbers(std::string_view html) {
  std::string text;
  text.reserve(html.size());
  for (std::size_t i = 0; i < html.size();) {
    if (html[i] == '<') {
      const std::size_t end = end_of_markup(html, i);
      text += html.substr(i, end - i);
      i = end;
      continue;
    }
    if (const std::size_t joined = joined_behind(html, i); joined > 0) {
      for (const char c : html.substr(i, joined)) text += c == ' ' ? kNoBreak : std::string_view(&c, 1);
      i += joined;
      continue;
    }
    const bool minus = html[i] == '-' && i + 1 < html.size() && base::is_digit(html[i + 1]) &&
                       (i == 0 || !joins(character_before(html, i)));
    text += minus ? std::string_view("\u2212") : html.substr(i, 1);
    ++i;
  }
  return text;
}

namespace {

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2126; --soft: #5a6570; --paper: #ffffff; --line: #d7dde3; --tint: #f3f6f8;
        --veil: rgba(90, 125, 150, 0.08); --edge: rgba(28, 33, 38, 0.3);
        --accent: #005a8f; --good: #1c6e3d; --bad: #a8321a; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ec; --soft: #a3adb7; --paper: #15191d; --line: #39424b; --tint: #1f252b; --accent: #79bdec;
          --veil: rgba(160, 190, 215, 0.08); --edge: rgba(200, 215, 230, 0.35); --good: #7fd29c; --bad: #ff9d85; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.5;
       font-family: system-ui, "Segoe UI", "DejaVu Sans", Helvetica, Arial, sans-serif; font-size: 16px; }
main { max-width: 1240px; margin: 0 auto; padding: 1.2rem 1rem 3rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0.4rem 0 0.2rem; overflow-wrap: anywhere; }
h1 small { display: block; font-size: 1rem; font-weight: 400; color: var(--soft); }
h1 + #meaning, h1 + p + #meaning, summary + #meaning { display: none; }
h2 { font-size: 1.3rem; margin: 2.2rem 0 0.5rem; padding-bottom: 0.2rem; border-bottom: 2px solid var(--line); }
h3 { font-size: 1.08rem; margin: 1.6rem 0 0.4rem; overflow-wrap: anywhere; }
p, li { max-width: 78ch; overflow-wrap: anywhere; }
.soft, figcaption { color: var(--soft); font-size: 0.92rem; }
a { color: var(--accent); }
code { overflow-wrap: anywhere; }
/* Where a table or a plot is cut there is a shadow: the paper that hides it scrolls along, the shadow does not. */
.scroll { overflow-x: auto; margin: 0.6rem 0; background:
  linear-gradient(to right, var(--paper) 40%, transparent) left / 2.5rem calc(100% + 2px) no-repeat local,
  linear-gradient(to left, var(--paper) 40%, transparent) right / 2.5rem calc(100% + 2px) no-repeat local,
  linear-gradient(to right, var(--edge), transparent) left / 0.9rem 100% no-repeat scroll,
  linear-gradient(to left, var(--edge), transparent) right / 0.9rem 100% no-repeat scroll; }
table { border-collapse: collapse; font-size: 0.94rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.3rem 0.75rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { background: var(--veil); font-weight: 600; vertical-align: bottom; }
table.name td:first-child { min-width: 13ch; }
table.names td:first-child { min-width: 24ch; }  /* long names: few lines, and the table scrolls */
td.n, th.n { text-align: right; }
td.n, td.s { white-space: nowrap; }
td.t { min-width: 22ch; }
tr.heading td { border-top: 2px solid var(--line); font-weight: 600; padding-top: 0.55rem; }
td.why { white-space: normal; color: var(--soft); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 0.6rem; margin: 1rem 0; padding: 0; }
.tile { background: var(--tint); border: 1px solid var(--line); border-radius: 8px; padding: 0.55rem 0.8rem; }
.tile b { display: block; font-size: 1.25rem; font-variant-numeric: tabular-nums; }
.tile span { color: var(--soft); font-size: 0.88rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(340px, 100%), 1fr)); gap: 0.8rem;
           align-items: start; margin: 0.8rem 0; }
.figures.large { grid-template-columns: repeat(auto-fit, minmax(min(480px, 100%), 1fr)); }
@media (min-width: 700px) {  /* four figures: no row with one of them */
  .figures:has(> :nth-child(4):last-child) { grid-template-columns: repeat(2, 1fr); }
}
@media (min-width: 1150px) { .figures:not(.large):has(> :nth-child(4):last-child) { grid-template-columns: repeat(4, 1fr); } }
figure { margin: 0; border: 1px solid var(--line); border-radius: 8px; overflow: hidden; background: var(--tint); max-width: 620px; }
figure img, figure video { display: block; width: 100%; height: auto; background: #ffffff; }
figure video { background: #22282e; }  /* until it is loaded */
figure .scroll { margin: 0; isolation: isolate; }
figcaption { padding: 0.4rem 0.7rem 0.5rem; }
nav ul { columns: 16rem; padding-left: 1.2rem; }
.note { border-left: 4px solid var(--accent); background: var(--tint); padding: 0.5rem 0.9rem; margin: 0.8rem 0;
        max-width: 78ch; }
.note ul { margin: 0; padding-left: 1.2rem; }
details.part { border-bottom: 1px solid var(--line); }
details.part > summary { cursor: pointer; padding: 0.5rem 0; font-weight: 600; }
details.part[open] { padding-bottom: 0.8rem; }
.good { color: var(--good); } .bad { color: var(--bad); }
/* Plots are drawn on white paper; their hues stay, photographs and videos are as they are. */
@media screen and (prefers-color-scheme: dark) {
  figure img[src^="data:image/svg"] { filter: invert(0.9) hue-rotate(180deg); } }
@media (max-width: 600px) {
  th, td { padding: 0.28rem 0.45rem; } h1 { font-size: 1.4rem; } .tile b { font-size: 1.05rem; } main { padding: 0.8rem 0.8rem 2rem; }
  th.w { min-width: 13ch; }  /* a long title: few lines, and the table scrolls */
  figure .scroll img { min-width: 460px; mix-blend-mode: darken; }  /* its shadow shows through the plot's paper */
}
@media (max-width: 600px) and (prefers-color-scheme: dark) { figure .scroll img { mix-blend-mode: lighten; } }
@media screen and (max-width: 600px) {  /* a row becomes a block: its name, and each number under the title of its column */
  table.stack, table.stack tbody { display: block; } table.stack thead { display: none; }
  table.stack tr { display: flex; flex-wrap: wrap; gap: 0.1rem 1.2rem; padding: 0.45rem 0; border-bottom: 1px solid var(--line); }
  table.stack td { border: 0; padding: 0; text-align: left; flex: 1 0 42%; max-width: 100%; }  /* two in a line where both fit */
  table.stack td:not([data-title]) { flex-basis: 100%; font-weight: 600; white-space: normal; }
  table.stack td.n, table.stack td.s { white-space: normal; } table.stack td.t { flex-basis: 100%; min-width: 0; }
  table.stack td[data-title]::before { content: attr(data-title); display: block; color: var(--soft); font-size: 0.82rem; white-space: normal; }
  table.numbered td:first-child { flex: 0 0 0.6rem; } table.numbered td:nth-child(2) { flex: 1 1 70%; } }
@media print {
  :root { color-scheme: light; --ink: #000000; --soft: #444444; --paper: #ffffff; --line: #bbbbbb; --tint: #f4f4f4;
          --veil: #f4f4f4; --accent: #000000; --good: #000000; --bad: #000000; }
  body { font-size: 10.5pt; }
  table { font-size: 8pt; }
  th, td { padding: 0.2rem 0.4rem; }
  figure, tr, .tile, .note { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  figure:has(video), nav { display: none; }
  .scroll { overflow: visible; background: none; }
  .figures, .figures.large { grid-template-columns: repeat(2, 1fr); }
  .figures:has(video):has(> :nth-child(4):last-child) { grid-template-columns: repeat(3, 1fr); }  /* the film is not printed */
}
)css";

constexpr std::size_t kShort = 13;  // characters that stay on one line
constexpr std::size_t kLong = 24;

/// HTML without its tags, for an attribute.
std::string seen_text(std::string_view html) {
  std::string text;
  for (std::size_t i = 0; i < html.size(); ++i) {
    if (html[i] == '<') {
      i = std::min(html.find('>', i), html.size() - 1);
    } else {
      text += html[i];
    }
  }
  return text;
}

/// The number of visible characters of HTML: tags do not count, an entity counts as one, and continuation bytes of
/// UTF-8 do not count.
std::size_t seen_length(std::string_view html) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < html.size(); ++i) {
    const char end = html[i] == '<' ? '>' : html[i] == '&' ? ';' : '\0';
    if (end != '>' && (static_cast<unsigned char>(html[i]) & 0xC0u) != 0x80u) ++length;
    if (end != '\0') i = std::min(html.find(end, i), html.size() - 1);
  }
  return length;
}

}  // namespace

std::string escape(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string escape_with_code(std::string_view text) {
  std::string html = escape(text);
  std::size_t from = 0;
  while ((from = html.find('`', from)) != std::string::npos) {
    const std::size_t to = html.find('`', from + 1);
    if (to == std::string::npos) break;
    html.replace(to, 1, "</code>");
    html.replace(from, 1, "<code>");
    from = to;
  }
  return html;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8 | (k < count ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[block >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string data_uri(std::string_view media_type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", media_type, base64(bytes));
}

HtmlTable::HtmlTable(std::vector<std::string> header, std::size_t first_number)
    : first_number_(first_number), header_(std::move(header)) {}

void HtmlTable::row(const std::vector<std::string>& cells) {
  assert(cells.size() == header_.size());
  longest_name_ = std::max(longest_name_, seen_length(cells.front()));
  rows_ += "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool kept = cells[i].find_first_of(" -") != std::string::npos && seen_length(cells[i]) <= kShort;
    const bool prose = i > 0 && seen_length(cells[i]) > kLong;
    const char* kind = i >= first_number_ ? " class=\"n\"" : kept ? " class=\"s\"" : prose ? " class=\"t\"" : "";
    const std::string title = names_ > 0 && i >= names_ ? fmt::format(" data-title=\"{}\"", seen_text(header_[i])) : "";
    rows_ += fmt::format("<td{}{}>{}</td>", kind, title, cells[i]);
  }
  rows_ += "</tr>\n";
}

void HtmlTable::heading(const std::string& cell) {
  rows_ += fmt::format("<tr class=\"heading\"><td colspan=\"{}\">{}</td></tr>\n", header_.size(), cell);
}

void HtmlTable::stack_when_narrow(std::size_t names) {
  names_ = names;
}

std::string HtmlTable::str() const {
  std::string kinds = longest_name_ > kLong ? "names" : longest_name_ > kShort ? "name" : "";
  if (names_ > 0) kinds += fmt::format("{}stack{}", kinds.empty() ? "" : " ", names_ > 1 ? " numbered" : "");
  std::string text = fmt::format("<div class=\"scroll\"><table{}><thead><tr>",
                                 kinds.empty() ? "" : fmt::format(" class=\"{}\"", kinds));
  for (std::size_t i = 0; i < header_.size(); ++i) {
    const char* number = i >= first_number_ ? "n" : "";
    const char* wide = i > 0 && seen_length(header_[i]) > kShort ? "w" : "";
    const std::string kind = fmt::format("{}{}{}", number, *number != 0 && *wide != 0 ? " " : "", wide);
    text += fmt::format("<th{}>{}</th>", kind.empty() ? "" : fmt::format(" class=\"{}\"", kind), header_[i]);
  }
  return text + "</tr></thead><tbody>\n" + rows_ + "</tbody></table></div>\n";
}

Html& Html::operator+=(const Html& next) {
  texts_.back() += next.texts_.front();
  texts_.insert(texts_.end(), next.texts_.begin() + 1, next.texts_.end());
  plots_.insert(plots_.end(), next.plots_.begin(), next.plots_.end());
  return *this;
}

void Html::plot(Plot plot) {
  plots_.push_back(std::move(plot));
  texts_.emplace_back();
}

Html figures(const std::vector<Plot>& plots) {
  if (plots.empty()) return {};
  Html html(plots.size() % 3 == 0 ? "<div class=\"figures\">\n" : "<div class=\"figures large\">\n");
  for (const Plot& plot : plots) {
    // As a separate image: gnuplot gives every plot the same ids, which would clash within one page.
    html += "<figure>";
    html.plot(plot);
    html += fmt::format("<figcaption>{}</figcaption></figure>\n", escape(plot.caption));
  }
  return html + "</div>\n";
}

std::string tile(const std::string& number, const std::string& words) {
  std::string text = escape(number);
  // A narrow tile breaks before the ±, and hides no digit.
  const std::size_t at = text.find(kPlusMinus);
  if (at != std::string::npos) text.insert(at, "<wbr>");
  return "<div class=\"tile\"><b>" + text + "</b><span>" + escape(words) + "</span></div>";
}

std::string question_heading(std::string_view about, std::string_view question) {
  return fmt::format("<h1><small>{}</small> {}</h1>\n", escape(about), escape(question));
}

std::string meaning_section(const std::string& html) {
  return "<h2 id=\"meaning\">What this means</h2>\n" + html;
}

std::string symbols_html(std::string_view text) {
  static const base::Pattern kSymbol("(^|[^A-Za-z0-9_/])([A-Za-z])_([A-Za-z0-9]+)(?![A-Za-z0-9_/])");
  return kSymbol.replaced(escape(text), [](const base::Captured& part) {
    return fmt::format("{}{}<sub>{}</sub>", part[1], part[2], part[3]);
  });
}

namespace {

/// A plot that is so wide that its text would be too small on a narrow screen scrolls there.
constexpr int kFitsAnywhere = 520;  // points

std::string image_of(const DrawnPlot& plot, const Plot& of) {
  if (plot.left_out.empty()) {
    const std::string image =
        fmt::format("<img alt=\"{}\" src=\"{}\">", escape(of.description), data_uri("image/svg+xml", plot.svg));
    return of.drawing.size.width > kFitsAnywhere ? "<div class=\"scroll\">" + image + "</div>" : image;
  }
  return fmt::format(
      "<p class=\"note\">This plot is left out because its numbers leave nothing to draw (gnuplot: {}). They are in "
      "<code>plots/{}.csv</code>.</p>\n",
      escape(plot.left_out), plot.name);
}

}  // namespace

Page page(std::string_view title, const Html& body) {
  Page made;
  std::string text;
  const std::vector<DrawnPlot> drawn = draw_plots(body.plots(), plot_file_names(body.plots()));
  for (std::size_t i = 0; i < body.texts().size(); ++i) {
    text += body.texts()[i];
    if (i == drawn.size()) break;
    const std::string stem = "plots/" + drawn[i].name;
    text += image_of(drawn[i], body.plots()[i]);
    made.files[stem + ".csv"] = drawn[i].csv;
    if (!drawn[i].left_out.empty()) continue;
    made.files[stem + ".svg"] = drawn[i].svg;
    made.files[stem + ".pdf"] = drawn[i].pdf;
    made.files[stem + ".gp"] = drawn[i].script;
  }
  if (!drawn.empty()) {
    text +=
        "<p class=\"soft\" data-plots>Each plot is also in the folder <code>plots</code> next to this page: SVG, PDF, "
        "its numbers (CSV), and the script that draws it (<code>gnuplot NAME.gp</code>).</p>\n";
  }
  made.html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      escape(title), kStyle, typeset_numbers(text));
  return made;
}

void write_page(const std::filesystem::path& folder, const std::string& name, const Page& page) {
  base::write_file(folder / name, page.html);
  for (const auto& [path, bytes] : page.files) {
    std::filesystem::create_directories((folder / path).parent_path());
    base::write_file(folder / path, bytes);
  }
}

Html folded(const std::string& heading, const Html& part) {
  if (part.plots().empty() && part.texts().front().empty()) return {};
  return Html("<details class=\"part\"><summary>" + heading + "</summary>\n") + part + "</details>\n";
}

}  // namespace glidelab::report
