/// Plots drawn by gnuplot as a child process: each as SVG and PDF, with the script and the data to draw it again.
///
/// One run draws all plots of a page. Each has a script NAME.gp that reads NAME.csv and writes NAME.svg and NAME.pdf:
/// `gnuplot NAME.gp`, run in their folder, makes the same plot. gnuplot runs with its default settings and the C
/// locale. Texts from files are quoted, so that a clip's name can never act as a command.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/html/plot.h"

namespace glidelab::report {

/// The four files of one plot.
struct DrawnPlot {
  std::string name;  ///< of the files, without extension
  std::string svg;
  std::string pdf;     ///< without the drawing date
  std::string script;  ///< NAME.gp
  std::string csv;     ///< the axis labels and the blocks of data, each below its name and column names in comments,
                       ///< two blank lines apart
  /// Why there is no plot, in gnuplot's words: its values leave nothing to show (all undefined, infinite or out of
  /// range). Then `svg` and `pdf` are empty. Empty: it is drawn.
  std::string left_out = {};
};

/// Draws the plots; names[i] is the name of the files of plots[i]. A plot whose numbers gnuplot cannot draw is left
/// out. EnvironmentError if gnuplot is missing, is ended, or rejects a script for any other reason (with its message).
std::vector<DrawnPlot> draw_plots(std::span<const Plot> plots, std::span<const std::string> names);

/// Names for the files of a page's plots, in order: "01-residuals-of-the-fitted-lines-over-v", of ASCII only.
std::vector<std::string> plot_file_names(std::span<const Plot> plots);

/// EnvironmentError if gnuplot cannot be started: to be detected before the long work, not after it.
void check_gnuplot();

/// The text in at most `most` characters, with "…" in the middle if it is longer, because both ends of a name
/// distinguish it from others. A long label would take all the room of a plot. `most` at least 3.
std::string shortened(std::string_view text, std::size_t most = 28);

/// The text as a gnuplot string in single quotes: no escapes, no commands, on one line, its apostrophes curled.
std::string gnuplot_quoted(std::string_view text);

}  // namespace glidelab::report
