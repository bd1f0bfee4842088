/// A page, with more script at its end where that is wanted, opened in a browser without a window.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <string>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"

namespace glidelab::tests {

struct OpenedPage {
  std::map<std::string, std::string> data;  ///< what the script left in document.documentElement.dataset, by name
  std::string messages;                     ///< of the browser, with what the page wrote to its console
};

/// The data-* of the opened page. Nothing where there is no chromium program.
inline std::optional<OpenedPage> open_page(const std::filesystem::path& page, int width_px = 1280,
                                           int height_px = 720) {
  const ProcessResult opened =
      run({"chromium", "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr",
           "--virtual-time-budget=1000", fmt::format("--window-size={},{}", width_px, height_px), "--dump-dom",
           "file://" + page.string()});
  if (opened.status != 0) return std::nullopt;
  OpenedPage result{{}, opened.err};
  const std::string tag = opened.out.substr(0, opened.out.find("<head"));
  const std::regex attribute("data-([a-z0-9-]+)=\"([^\"]*)\"");
  for (std::sregex_iterator it(tag.begin(), tag.end(), attribute); it != std::sregex_iterator(); ++it) {
    result.data[(*it)[1]] = (*it)[2];
  }
  return result;
}

inline std::optional<OpenedPage> open_with(const std::filesystem::path& folder, const std::string& page,
                                           const std::string& script, int width_px = 1280, int height_px = 720) {
  base::write_file(folder / "asked.html", page + "<script>\n" + script + "\n</script>\n");
  return open_page(folder / "asked.html", width_px, height_px);
}

}  // namespace glidelab::tests
