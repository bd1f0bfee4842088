/// The pieces of a page that needs nothing but itself: style, tables, pictures as data URIs.
///
/// Every text that comes from a file goes through escape(): a clip that is named `<script>` is text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/plot_style.h"

namespace glidelab::report {

/// The text with &, <, >, quotes and apostrophes as entities; fit for content and for attributes in quotes.
std::string escape(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "data:image/svg+xml;base64,…"
std::string data_uri(std::string_view media_type, std::string_view bytes);

/// A table whose cells are HTML (escape texts first). Columns from `first_number` on are aligned as numbers.
class HtmlTable {
 public:
  explicit HtmlTable(std::vector<std::string> header, std::size_t first_number = 1);
  /// As many cells as the header has.
  void row(const std::vector<std::string>& cells);
  /// One cell over all columns, which names the rows that follow.
  void heading(const std::string& cell);
  bool empty() const { return rows_.empty(); }
  std::string str() const;

 private:
  std::size_t first_number_;
  std::vector<std::string> header_;
  std::string rows_;
};

/// Plots side by side where there is room, each on white paper with its caption.
std::string figures(const std::vector<Plot>& plots);

/// A whole HTML document. The title is text, the body HTML.
std::string page(std::string_view title, std::string_view body);

}  // namespace glidelab::report
