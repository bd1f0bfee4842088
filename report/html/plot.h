/// A plot before it is drawn: columns of numbers, and the commands of gnuplot that draw them.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace glidelab::report {

/// Columns of numbers under the name that the script calls them by: `plot $name using 1:2`. NaN breaks a line.
struct PlotData {
  std::string name;
  std::vector<std::vector<double>> rows;  ///< an empty row stands for a blank line, which breaks a line as well
  std::vector<std::string> columns = {};  ///< what each holds, with its unit: "v (m/s)"; for who reads the file
};

/// gnuplot takes a block without rows for an error; one row of NaN, as wide as `columns`, draws nothing.
inline PlotData never_empty(PlotData data) {
  if (data.rows.empty()) {
    data.rows.push_back(std::vector<double>(data.columns.size(), std::numeric_limits<double>::quiet_NaN()));
  }
  return data;
}

/// Size in points of the plot's own coordinates; a page scales it.
struct PlotSize {
  int width = 480;
  int height = 330;
};

struct Drawing {
  std::string script;
  std::vector<PlotData> data;
  PlotSize size = {};
};

/// A plot as it stands on a page, with a text for who cannot see it.
struct Plot {
  Drawing drawing;
  std::string caption;      ///< HTML-free text under the plot
  std::string description;  ///< for the alt attribute; the plot's files are named after it
};

}  // namespace glidelab::report
