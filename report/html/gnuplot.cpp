#include "report/html/gnuplot.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "base/errors.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "base/text/pattern.h"

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

/// "v  (m/s)" of `set xlabel 'v  (m/s)'`; "" if the script names no such axis.
std::string axis_label(const std::string& script, const char* axis) {
  const std::string command = fmt::format("set {}label '", axis);
  const std::size_t found = script.find(command);
  if (found == std::string::npos) return {};
  const std::size_t from = found + command.size();
  return script.substr(from, script.find('\'', from) - from);
}

/// The axis labels, then blocks of rows separated by two blank lines, as gnuplot expects; similar gaps within a block
/// are closed.
std::string csv_of(const Drawing& drawing) {
  std::string text;
  for (const char* axis : {"x", "y"}) {
    const std::string label = axis_label(drawing.script, axis);
    if (!label.empty()) text += fmt::format("# {} axis: {}\n", axis, label);
  }
  bool first = true;
  for (const PlotData& data : drawing.data) {
    text += fmt::format("{}# {}\n", first ? "" : "\n\n", data.name);
    std::string columns = fmt::format("{}", fmt::join(data.columns, ","));
    std::replace_if(
        columns.begin(), columns.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    if (!columns.empty()) text += fmt::format("# {}\n", columns);
    first = false;
    bool gap = false, any = false;
    for (const std::vector<double>& row : data.rows) {
      if (row.empty()) {
        gap = any;
        continue;
      }
      if (gap) text += '\n';
      gap = false;
      any = true;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i > 0) text += ',';
        text += std::isfinite(row[i]) ? fmt::format("{:.7g}", row[i]) : "NaN";  // 7 digits: far below a pixel
      }
      text += '\n';
    }
  }
  return text;
}

bool of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The script with every `$block` outside its texts replaced by the block's location in the data file.
std::string with_files(const Drawing& drawing) {
  const std::string& script = drawing.script;
  std::string text;
  bool quoted = false;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (script[i] == '\'') quoted = !quoted;
    const bool block =
        !quoted && script[i] == '$' && i + 1 < script.size() && std::isalpha(static_cast<unsigned char>(script[i + 1]));
    if (!block) {
      text += script[i];
      continue;
    }
    std::size_t end = i + 1;
    while (end < script.size() && of_a_name(script[end])) ++end;
    const std::string name = script.substr(i + 1, end - i - 1);
    const auto found =
        std::find_if(drawing.data.begin(), drawing.data.end(), [&](const PlotData& data) { return data.name == name; });
    text += found == drawing.data.end() ? "$" + name  // gnuplot reports that there is none
                                        : fmt::format("name.'.csv' index {}", found - drawing.data.begin());
    i = end - 1;
  }
  return text;
}

/// The messages of gnuplot 5.4 and 6.0 for numbers that leave nothing to draw. All other messages concern the script.
constexpr std::array<std::string_view, 12> kNothingToShow = {"value undefined",
                                                             "points undefined",
                                                             "range is invalid",
                                                             "with an empty",
                                                             "range undefined or overflow",
                                                             "empty or undefined",
                                                             "for log scale",
                                                             "must have positive range",
                                                             "increment must be positive",
                                                             "undefined variable: inf",
                                                             "undefined variable: nan",
                                                             "Undefined value"};

/// "all points y value undefined!" for a log that ends with `"01-x.gp" line 12: all points y value undefined!`, if the
/// message is about numbers; otherwise "".
std::string why_nothing(const std::string& log) {
  static const base::Pattern kMessage("\",? line [0-9]+: ([^\n]*)");
  const std::vector<base::Captured> found = kMessage.matches(log);
  const std::string message = found.empty() ? std::string() : found.back()[1];
  const bool of_numbers = std::any_of(kNothingToShow.begin(), kNothingToShow.end(),
                                      [&](std::string_view words) { return message.find(words) != std::string::npos; });
  return of_numbers ? message : std::string();
}

/// Both files come from one script, run twice. At font size 15, text is still 11 pixels high if the page shows the plot
/// 350 pixels wide; a point of the PDF is a pixel of the SVG.
std::string script_of(const Drawing& drawing, const std::string& name) {
  constexpr double kPointsPerInch = 72.0;
  return fmt::format(
      "# gnuplot {0}.gp  draws {0}.svg and {0}.pdf from {0}.csv\n"
      "name = '{0}'\n"
      "set encoding utf8\n"
      "do for [kind in 'svg pdf'] {{\n"
      "reset\n"
      "set minussign\n"
      "set datafile separator comma\n"
      "if (kind eq 'svg') {{ set terminal svg noenhanced size {1},{2} dynamic font 'sans-serif,15' background "
      "'#ffffff' }}\n"
      "if (kind eq 'pdf') {{ set terminal pdfcairo noenhanced size {3:.4f}in,{4:.4f}in font 'sans-serif,15' }}\n"
      "set output name.'.'.kind\n"
      "{5}\n"
      "unset output\n"
      "}}\n",
      name, drawing.size.width, drawing.size.height, drawing.size.width / kPointsPerInch,
      drawing.size.height / kPointsPerInch, with_files(drawing));
}

/// Cairo writes the time of day into a PDF; the same numbers must give the same file.
std::string without_date(std::string pdf) {
  constexpr std::string_view kKey = "/CreationDate (D:", kEpoch = "19700101000000";
  const std::size_t found = pdf.find(kKey);
  if (found != std::string::npos) pdf.replace(found + kKey.size(), kEpoch.size(), kEpoch);
  return pdf;
}

/// Replaces the Greek letters of quantities by their names, which are allowed in file names.
std::string spelt_out(std::string text) {
  for (const auto& [letter, name] : {std::pair("µ", "mu"), std::pair("α", "alpha")}) {
    for (std::size_t at = text.find(letter); at != std::string::npos; at = text.find(letter)) {
      text.replace(at, std::string_view(letter).size(), name);
    }
  }
  return text;
}

}  // namespace

std::string shortened(std::string_view text, std::size_t most) {
  std::vector<std::size_t> starts;  // of characters: continuation bytes of UTF-8 do not count
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u) starts.push_back(i);
  }
  if (starts.size() <= most) return std::string(text);
  const std::size_t head = most / 2, tail = most - 1 - head;
  return fmt::format("{}…{}", text.substr(0, starts[head]), text.substr(starts[starts.size() - tail]));
}

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

std::vector<std::string> plot_file_names(std::span<const Plot> plots) {
  constexpr std::size_t kLongest = 60;  // characters; longer names are cut by some archives
  std::vector<std::string> names;
  for (const Plot& plot : plots) {
    std::string name = fmt::format("{:02}-", names.size() + 1);
    for (const char c : spelt_out(plot.description)) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 0x80;
      if (plain) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (!plain && name.back() != '-') name += '-';
      if (name.size() == kLongest) break;
    }
    while (name.back() == '-') name.pop_back();
    names.push_back(std::move(name));
  }
  return names;
}

namespace {

std::vector<std::string> arguments_in(const fs::path& folder) {
  return {"-d", "-e", "cd " + gnuplot_quoted(folder.string())};
}

/// Draws the plots one by one, in a folder with their scripts and numbers, and finds those that show nothing.
void draw_each(const fs::path& folder, std::vector<DrawnPlot>& plots) {
  for (DrawnPlot& plot : plots) {
    const fs::path log = folder / "log.txt";
    std::vector<std::string> arguments = arguments_in(folder);
    arguments.push_back(plot.name + ".gp");
    const int status = run(std::move(arguments), log);
    if (!base::how_it_failed(status).empty()) plot.left_out = why_nothing(base::read_file(log));
    if (plot.left_out.empty()) check_status(status, log);
  }
}

}  // namespace

std::vector<DrawnPlot> draw_plots(std::span<const Plot> plots, std::span<const std::string> names) {
  assert(plots.size() == names.size());
  if (plots.empty()) return {};
  const base::TemporaryFolder folder("plot");
  const fs::path log = folder / "log.txt";
  std::vector<DrawnPlot> drawn;
  std::vector<std::string> arguments = arguments_in(folder.path());
  for (std::size_t i = 0; i < plots.size(); ++i) {
    drawn.push_back({names[i], {}, {}, script_of(plots[i].drawing, names[i]), csv_of(plots[i].drawing)});
    base::write_file(folder / (names[i] + ".gp"), drawn[i].script);
    base::write_file(folder / (names[i] + ".csv"), drawn[i].csv);
    arguments.push_back(names[i] + ".gp");
  }
  // All at once; gnuplot stops at the first plot that it cannot draw.
  if (!base::how_it_failed(run(std::move(arguments), log)).empty()) draw_each(folder.path(), drawn);
  for (DrawnPlot& plot : drawn) {
    if (!plot.left_out.empty()) continue;
    const fs::path svg = folder / (plot.name + ".svg"), pdf = folder / (plot.name + ".pdf");
    std::error_code missing;
    if (!fs::exists(svg, missing) || !fs::exists(pdf, missing)) {
      throw base::EnvironmentError(fmt::format("gnuplot: no plot {} written: {}", plot.name, base::read_file(log)));
    }
    plot.svg = base::read_file(svg);
    plot.pdf = without_date(base::read_file(pdf));
  }
  return drawn;
}

void check_gnuplot() {
  const base::TemporaryFolder folder("plot");
  const fs::path log = folder / "log.txt";
  check_status(run({"--version"}, log), log);
}

}  // namespace glidelab::report
