#include "report/gnuplot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "base/child_process.h"
#include "base/errors.h"
#include "base/staged_output.h"
#include "base/temporary_folder.h"

namespace glidelab::report {
namespace {

namespace fs = std::filesystem;

/// The process environment with another locale, so that numbers have a decimal point and texts are UTF-8.
std::vector<std::string> plot_environment() {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    if (text.starts_with("LC_") || text.starts_with("LANG=") || text.starts_with("LANGUAGE=")) continue;
    variables.emplace_back(text);
  }
  variables.emplace_back("LC_ALL=C.UTF-8");
  return variables;
}

int run(std::vector<std::string> arguments, const fs::path& log) {
  return base::run_program("gnuplot", std::move(arguments), log, plot_environment(),
                           " (it draws the plots; Debian's package is gnuplot-nox)");
}

void check_status(int status, const fs::path& log) {
  const std::string how = base::how_it_failed(status);
  if (!how.empty()) throw base::EnvironmentError(fmt::format("gnuplot {}: {}", how, base::read_file(log)));
}

std::string data_block(const PlotData& data) {
  std::string text = fmt::format("${} << END_OF_DATA\n", data.name);
  for (const std::vector<double>& row : data.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ' ';
      text += std::isfinite(row[i]) ? fmt::format("{:.7g}", row[i]) : "NaN";  // 7 digits: far below a pixel
    }
    text += '\n';
  }
  return text + "END_OF_DATA\n";
}

}  // namespace

std::string gnuplot_quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "’";  // gnuplot 5.4 reads a doubled quote at the start of a text as its end
    } else {
      quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return quoted + "'";
}

std::string gnuplot_svg(std::string_view script, std::span<const PlotData> data, PlotSize size) {
  const base::TemporaryFolder folder("plot");
  const fs::path svg = folder / "plot.svg";
  const fs::path log = folder / "log.txt";
  // At the font size 15 text is still 11 pixels high where the page shows the plot 350 pixels wide.
  std::string text = fmt::format(
      "set terminal svg noenhanced size {},{} dynamic font 'sans-serif,15' background '#ffffff'\n"
      "set output {}\nset encoding utf8\n",
      size.width, size.height, gnuplot_quoted(svg.string()));
  for (const PlotData& block : data) text += data_block(block);
  text += script;
  text += "\nunset output\n";
  base::write_file(folder / "plot.gp", text);
  check_status(run({"-d", (folder / "plot.gp").string()}, log), log);
  std::error_code missing;
  if (!fs::exists(svg, missing)) throw base::EnvironmentError("gnuplot: no plot written: " + base::read_file(log));
  return base::read_file(svg);
}

void check_gnuplot() {
  const base::TemporaryFolder folder("plot");
  const fs::path log = folder / "log.txt";
  check_status(run({"--version"}, log), log);
}

}  // namespace glidelab::report
