/// Plots drawn by gnuplot as a child process: each as SVG and as PDF, with the script and the data that draw it again.
///
/// One run draws all plots of a page. Each has a script NAME.gp that reads NAME.csv and writes NAME.svg and NAME.pdf:
/// `gnuplot NAME.gp`, run where they lie, makes the same plot. gnuplot runs with its default settings and the C locale.
/// Texts from files are quoted, so that a clip's name is never a command.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/html/plot.h"

namespace glidelab::report {

/// The four files of one plot.
struct DrawnPlot {
  std::string name;  ///< of the files, without what follows the dot
  std::string svg;
  std::string pdf;     ///< without the date at which it was drawn
  std::string script;  ///< NAME.gp
  std::string csv;     ///< what the axes show and the blocks of data, each under its name and its columns' in comments,
                       ///< two blank lines apart
  /// Why there is no plot, in gnuplot's words: its values leave nothing to show (all undefined, infinite or out of
  /// range). Then `svg` and `pdf` are empty. Empty: it is drawn.
  std::string left_out = {};
};

/// Draws the plots; names[i] is that of plots[i]'s files. A plot whose numbers gnuplot cannot draw is left out.
/// EnvironmentError if gnuplot is missing, is ended, or rejects a script for any other reason (with its message).
std::vector<DrawnPlot> draw_plots(std::span<const Plot> plots, std::span<const std::string> names);

/// Names for the files of a page's plots, in order: "01-residuals-of-the-fitted-lines-over-v", of ASCII only.
std::vector<std::string> plot_file_names(std::span<const Plot> plots);

/// EnvironmentError if gnuplot cannot be started: to be found before the long work, not after it.
void check_gnuplot();

/// The text in `most` characters or fewer, "…" in its middle where it is longer, for a name's two ends tell it from
/// others: a plot gives a long label all its room, and none to what it shows. `most` at least 3.
std::string shortened(std::string_view text, std::size_t most = 28);

/// The text as a gnuplot string in single quotes: no escapes, no commands, on one line, its apostrophes curled.
std::string gnuplot_quoted(std::string_view text);

}  // namespace glidelab::report
