/// Plots as SVG, drawn by gnuplot as a child process.
///
/// A script and its data go into a temporary folder of their own, gnuplot runs there with its default settings and the
/// C locale, and the SVG is read back. Texts from files are quoted, so that a clip's name is never a command.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::report {

/// Columns of numbers under the name that the script calls them by: `plot $name using 1:2`. NaN breaks a line.
struct PlotData {
  std::string name;
  std::vector<std::vector<double>> rows;  ///< an empty row stands for a blank line, which breaks a line as well
};

/// Size in points of the SVG's own coordinates; the page scales it.
struct PlotSize {
  int width = 480;
  int height = 330;
};

/// Runs the script and returns the SVG. EnvironmentError where gnuplot is missing or fails (with its message).
std::string gnuplot_svg(std::string_view script, std::span<const PlotData> data, PlotSize size = {});

/// EnvironmentError where gnuplot cannot be started: to be found before the long work, not after it.
void check_gnuplot();

/// The text as a gnuplot string in single quotes: no escapes, no commands, on one line, its apostrophes curled.
std::string gnuplot_quoted(std::string_view text);

}  // namespace glidelab::report
