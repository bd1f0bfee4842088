/// What every page is held to: a name, title, note or reason that comes from a file is text on it, whatever is written
/// there.
#pragma once

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "report/html/html.h"
#include "tests/catch.h"

namespace glidelab::tests {

inline const std::string kEvil = R"(<script>alert(1)</script>&"x')";

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// It is there to be read, and nowhere markup: not in the page, and not in the plots beside it, which a browser opens
/// as well.
inline void check_is_text(const report::Page& page) {
  const std::size_t raw = std::min(page.html.find("<script>alert"), page.html.find("&\"x'"));
  INFO("near: " << (raw == std::string::npos ? "" : page.html.substr(raw - std::min<std::size_t>(raw, 120), 180)));
  CHECK(has(page.html, "&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;x&#39;"));
  CHECK_FALSE(has(page.html, "<script>alert"));
  CHECK_FALSE(has(page.html, "alert(1)</script>"));
  CHECK_FALSE(has(page.html, "&\"x'"));
  for (const auto& [name, bytes] : page.files) {
    if (!name.ends_with(".svg")) continue;
    INFO(name);
    CHECK_FALSE(has(bytes, "<script>alert"));
  }
}

/// The functions that make a page, of all headers in the folder and below; without the frame of all pages.
inline std::vector<std::string> pages_of(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  const std::regex makes("\n(?:report::)?Page ([a-z_]+)\\(");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".h") continue;
    const std::string header = base::read_file(entry.path());
    for (std::sregex_iterator it(header.begin(), header.end(), makes); it != std::sregex_iterator(); ++it) {
      if ((*it)[1] != "page") names.push_back((*it)[1]);
    }
  }
  return names;
}

}  // namespace glidelab::tests
