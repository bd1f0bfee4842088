/// The pieces of a self-contained page: style, tables, images as data URIs, typeset numbers.
///
/// Plots are drawn when the page is made, all in one run of gnuplot; their files are put into a folder "plots" next to
/// the page. Every text that comes from a file goes through escape(): a clip named `<script>` is text.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>
#include "report/html/plot.h"

namespace glidelab::report {

/// HTML in which a hyphen before a number is a minus sign (U+2212), and a number keeps to its unit and to its ± by
/// no-break spaces (U+00A0), so that no line begins with a unit. Unchanged are tags, the content of code, script and
/// style elements, and a hyphen directly after a letter of any alphabet, a digit, another hyphen, "_", "." or "]"
/// ("m1-2", "maß-2", "1e-07", "2026-11-23"). Only units used on pages are recognised.
std::string typeset_numbers(std::string_view html);

/// The text with &, <, >, quotes and apostrophes as entities; fit for content and for attributes in quotes.
std::string escape(std::string_view text);

/// escape(), with what stands between two backticks as code: a command within a sentence.
std::string escape_with_code(std::string_view text);

/// escape(), with the names of quantities typeset: "v_lim" becomes v with the subscript lim, and likewise for all
/// single letters; names of several letters, and those joined to more text, stay.
std::string symbols_html(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "data:image/svg+xml;base64,…"
std::string data_uri(std::string_view media_type, std::string_view bytes);

/// A table whose cells are HTML (escape texts first). Columns from `first_number` on are aligned as numbers. Cells of
/// up to 13 characters stay on one line; if the first column has longer names, it is wide enough for them.
class HtmlTable {
 public:
  explicit HtmlTable(std::vector<std::string> header, std::size_t first_number = 1);
  /// Needs as many cells as the header.
  void row(const std::vector<std::string>& cells);
  /// One cell over all columns, which names the rows that follow.
  void heading(const std::string& cell);
  /// On a narrow screen each row becomes a block: its first `names` cells as a heading, below it every other cell under
  /// the title of its column. Call it before the first row. For wide tables of few rows.
  void stack_when_narrow(std::size_t names);
  bool empty() const { return rows_.empty(); }
  /// The HTML, in a box that scrolls if the table is wider than the page.
  std::string str() const;

 private:
  std::size_t first_number_;
  std::size_t longest_name_ = 0;  ///< of the first column, in visible characters
  std::size_t names_ = 0;         ///< cells that head a block on a narrow screen; 0: rows stay rows
  std::vector<std::string> header_;
  std::string rows_;
};

/// A part of a page: HTML texts, interleaved with plots yet to be drawn.
class Html {
 public:
  Html() : texts_(1) {}
  Html(std::string text) : texts_{std::move(text)} {}  // NOLINT(google-explicit-constructor): most parts are text
  Html(const char* text) : texts_{text} {}             // NOLINT(google-explicit-constructor)
  Html& operator+=(const Html& next);
  friend Html operator+(Html first, const Html& next) { return first += next; }
  /// Inserts the plot here: an image, or words if it has nothing to show.
  void plot(Plot plot);

  /// One more than there are plots: texts()[i] precedes plots()[i].
  const std::vector<std::string>& texts() const { return texts_; }
  const std::vector<Plot>& plots() const { return plots_; }

 private:
  std::vector<std::string> texts_;
  std::vector<Plot> plots_;
};

/// A number (or a word) in large type with its meaning below it; both are text.
std::string tile(const std::string& number, const std::string& words);

/// The top of a page: the question that it answers, and its subject above it in small type; both are text. HTML.
std::string question_heading(std::string_view about, std::string_view question);

/// The part at the top of a page that gives the meaning of its numbers in plain words; HTML below a heading, which is
/// omitted if it would come directly below the page's question.
std::string meaning_section(const std::string& html);

/// Plots side by side if there is room, each on white with its caption, or the reason why it has nothing to show.
Html figures(const std::vector<Plot>& plots);

/// A whole HTML document and the files of its plots, by their relative path ("plots/NAME.svg", .pdf, .gp, .csv).
struct Page {
  std::string html;
  std::map<std::string, std::string> files;
};

/// The title is text. EnvironmentError if gnuplot fails.
Page page(std::string_view title, const Html& body);

/// Writes the document under the given name, and the files of its plots, into the folder.
void write_page(const std::filesystem::path& folder, const std::string& name, const Page& page);

/// Parts of a page that open when their heading is clicked.
///
/// The heading is HTML; an empty part gives nothing.
Html folded(const std::string& heading, const Html& part);

}  // namespace glidelab::report
