#include "report/html/gnuplot.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "report/html/plot.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// Sets an environment variable for one test.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = ::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (old_) {
      ::setenv(name_, old_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

const std::vector<report::PlotData> kPoints = {{"points", {{0.0, 1.0}, {1.0, 2.0}, {}, {2.0, std::nan("")}}}};

report::DrawnPlot drawn(const report::Drawing& drawing) {
  const std::vector<report::Plot> plots = {{drawing, "caption", "one plot"}};
  return report::draw_plots(plots, report::plot_file_names(plots)).front();
}

}  // namespace

TEST_CASE("a name that is too long for a plot keeps its two ends, counted in characters") {
  CHECK(report::shortened("2024-03-05 glider 335 g up") == "2024-03-05 glider 335 g up");
  CHECK(report::shortened("abcdefghij", 10) == "abcdefghij");
  CHECK(report::shortened("abcdefghijk", 10) == "abcde…hijk");
  CHECK(report::shortened("µµµµµµ", 5) == "µµ…µµ");
  CHECK(report::shortened("abcd", 3) == "a…d");
}

TEST_CASE("a plot of data is an SVG and a PDF of the size that was asked for") {
  const report::DrawnPlot plot = drawn({"plot $points using 1:2 with lines", kPoints, {500, 300}});
  CHECK(plot.svg.find("<svg") != std::string::npos);
  CHECK(plot.svg.find("viewBox=\"0 0 500 300\"") != std::string::npos);
  CHECK(plot.pdf.starts_with("%PDF-"));
  CHECK(plot.csv == "# points\n0,1\n1,2\n\n2,NaN\n");
}

TEST_CASE("the numbers beside a plot say what its axes show and what each column holds, and are drawn as without") {
  const std::string script =
      "set xlabel 'v  (m/s)'\nset ylabel 'a  (m/s²)'\nplot $first using 1:2 with lines, $last using 1:2";
  const std::vector<report::PlotData> bare = {{"first", {{0.0, 1.0}, {1.0, 2.0}}}, {"last", {{2.0, 3.0}}}};
  std::vector<report::PlotData> named = bare;
  named[0].columns = {"v (m/s)", "a (m/s²)"};
  named[1].columns = {"v (m/s)", "of a\nclip"};  // a name from a file stays within its line
  const report::DrawnPlot plot = drawn({script, named});
  CHECK(plot.csv ==
        "# x axis: v  (m/s)\n# y axis: a  (m/s²)\n# first\n# v (m/s),a (m/s²)\n0,1\n1,2\n\n\n# last\n"
        "# v (m/s),of a clip\n2,3\n");
  CHECK(plot.svg == drawn({script, bare}).svg);
}

TEST_CASE("a point with an error bar covers nothing of the bar but what the point itself covers") {
  const report::DrawnPlot plot = drawn({std::string(report::kFrame) + "plot $p using 1:2:3 with yerrorbars pt 7 ps 0.5",
                                        {{"p", {{1.0, 1.0, 0.02}, {2.0, 1.1, 0.3}}}}});
  // gnuplot clears a disc below each point: the SVG has it in white, with its size as the scale.
  double largest = 0.0, point = 0.0;
  const std::string use = "xlink:href='#gpPt6'";
  for (std::size_t at = plot.svg.find(use); at != std::string::npos; at = plot.svg.find(use, at + 1)) {
    const std::string line = plot.svg.substr(at, plot.svg.find("/>", at) - at);
    if (line.find("scale(") == std::string::npos) continue;
    const double scale = std::stod(line.substr(line.find("scale(") + 6));
    (line.find("#FFFFFF") != std::string::npos ? largest : point) = scale;
  }
  CHECK(point > 1.0);
  CHECK(largest < 0.1 * point);
}

TEST_CASE("blocks of data are found whatever blank lines stand in them") {
  // A block with blank lines at its ends and doubled ones would shift those behind it, as gnuplot counts blocks by
  // them.
  const std::vector<report::PlotData> data = {{"first", {{}, {0.0, 1.0}, {}, {}, {1.0, 2.0}, {}}},
                                              {"last", {{5.0, 7.0}, {6.0, 8.0}}}};
  const std::string only_last =
      drawn({"set xrange [0:10]\nset yrange [0:10]\nunset key\nplot $last using 1:2 title 'last'",
             {{"last", data[1].rows}}})
          .svg;
  CHECK(drawn({"set xrange [0:10]\nset yrange [0:10]\nunset key\nplot $last using 1:2 title 'last'", data}).svg ==
        only_last);
}

TEST_CASE("the script and the numbers beside a plot draw the very same plot again") {
  const report::DrawnPlot plot =
      drawn({"set xlabel 'a } b { # $points'\nplot $points using 1:2 with lines title 'seen'", kPoints});
  const tests::TempDir temp;
  base::write_file(temp / (plot.name + ".gp"), plot.script);
  base::write_file(temp / (plot.name + ".csv"), plot.csv);
  const std::string command =
      "cd '" + temp.path().string() + "' && LC_ALL=C.UTF-8 gnuplot '" + plot.name + ".gp' 2>log";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(base::read_file(temp / (plot.name + ".svg")) == plot.svg);
  CHECK(base::read_file(temp / (plot.name + ".pdf")).size() == plot.pdf.size());  // but for its date
}

TEST_CASE("plots that are drawn twice are the same bytes") {
  CHECK(drawn({"plot $points using 1:2", kPoints}).pdf == drawn({"plot $points using 1:2", kPoints}).pdf);
}

TEST_CASE("a plot's files are named by place and what it shows, in plain characters") {
  const std::vector<report::Plot> plots = {{{}, "", "a(v) of ../<b>/É"}, {{}, "", std::string(300, 'x')}, {{}, "", ""}};
  const std::vector<std::string> names = report::plot_file_names(plots);
  CHECK(names[0] == "01-a-v-of-b");
  CHECK(names[1].size() == 60);
  CHECK(names[2] == "03");
}

TEST_CASE("a script that gnuplot rejects is an environment error with gnuplot's message") {
  CHECK_THROWS_AS(drawn({"plot no_such_thing(", {}}), base::EnvironmentError);
  CHECK_THROWS_AS(drawn({"plot $no_such_block using 1:2", {}}), base::EnvironmentError);
}

TEST_CASE("a missing gnuplot is an environment error that names it") {
  const tests::TempDir empty;
  const Environment path("PATH", empty.path().string());
  CHECK_THROWS_AS(report::check_gnuplot(), base::EnvironmentError);
  CHECK_THROWS_WITH(report::check_gnuplot(), Catch::Matchers::Contains("gnuplot"));
}

TEST_CASE("a text is quoted so that it stays one text") {
  CHECK(report::gnuplot_quoted("plain") == "'plain'");
  CHECK(report::gnuplot_quoted("it's") == "'it’s'");
  CHECK(report::gnuplot_quoted("a\nb") == "'a b'");
  const tests::TempDir temp;
  const std::string evil = "'; system 'touch " + (temp / "made").string() + "'\n!touch " + (temp / "made").string();
  drawn({"plot sin(x) title " + report::gnuplot_quoted(evil), {}});
  CHECK_FALSE(std::filesystem::exists(temp / "made"));
}

TEST_CASE("no plot leaves a temporary folder behind") {
  const tests::TempDir temp;
  const Environment folder("TMPDIR", temp.path().string());
  drawn({"plot sin(x)", {}});
  CHECK_THROWS(drawn({"no command", {}}));
  CHECK(std::filesystem::is_empty(temp.path()));
}

TEST_CASE(
    "a plot whose numbers leave nothing to show is left out with gnuplot's reason, and those beside it are drawn") {
  const double nan = std::nan(""), infinite = HUGE_VAL;
  const auto data = [](std::vector<std::vector<double>> rows) {
    return std::vector<report::PlotData>{{"points", std::move(rows)}};
  };
  const std::string plot = "plot $points using 1:2 with lines";
  const std::vector<report::Plot> plots = {
      {{plot, kPoints}, "", "some numbers"},
      {{plot, data({{nan, nan}})}, "", "no number"},
      {{plot, data({{0.0, infinite}, {1.0, infinite}})}, "", "infinite values"},
      {{plot, data({{0.0, 1e308}, {1.0, -1e308}})}, "", "a span that overflows"},
      {{"set yrange [0.3:0.3]\n" + plot, kPoints}, "", "an empty range"},
      {{fmt::format("set xrange [{}:1]\n", infinite) + plot, kPoints}, "", "an infinite range"},
      {{fmt::format("set yrange [0:{}]\n", nan) + plot, kPoints}, "", "no range"},
      {{fmt::format("set ytics ('a' {})\n", -infinite) + plot, kPoints}, "", "an infinite mark"},
      {{"set ytics 0\n" + plot, kPoints}, "", "marks without a step"},
      {{"set logscale y\n" + plot, data({{0.0, 0.0}, {1.0, -1.0}})}, "", "no logarithm"},
      {{plot, kPoints}, "", "some numbers again"}};
  const std::vector<report::DrawnPlot> drawn = report::draw_plots(plots, report::plot_file_names(plots));
  REQUIRE(drawn.size() == plots.size());
  for (const std::size_t i : {std::size_t{0}, drawn.size() - 1}) {
    CHECK(drawn[i].left_out.empty());
    CHECK(drawn[i].svg.find("</svg>") != std::string::npos);
  }
  for (std::size_t i = 1; i + 1 < drawn.size(); ++i) {
    CAPTURE(plots[i].description);
    CHECK_FALSE(drawn[i].left_out.empty());
    CHECK(drawn[i].svg.empty());
    CHECK(drawn[i].pdf.empty());
    CHECK_FALSE(drawn[i].csv.empty());
  }
  CHECK(drawn[4].left_out == "Can't plot with an empty y range!");
}
