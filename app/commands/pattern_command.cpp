/// glidelab pattern: a chessboard and a sheet of markers, as PDF and SVG to print to scale.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "report/print/print_sheet.h"
#include "report/text/json_numbers.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 0.001;  // m

struct PatternOptions {
  CommonOptions common;
  std::string paper = "a4";
  std::string corners = "9x6";
  double square_mm = 0.0;  // 0: the largest that fits
  std::vector<double> markers_mm = {8.0, 12.0, 16.0, 24.0};
};

/// "9x6", or "6x9": the same board.
std::pair<int, int> corners_of(const std::string& text) {
  int first = 0;
  int second = 0;
  const char* end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, first);
  if (error == std::errc{} && middle != end && *middle == 'x') {
    const auto [last, second_error] = std::from_chars(middle + 1, end, second);
    // From 3 to 100, as accepted by experiment.toml.
    const bool counts = std::min(first, second) >= 3 && std::max(first, second) <= 100;
    if (second_error == std::errc{} && last == end && counts) return {std::max(first, second), std::min(first, second)};
  }
  throw base::InputError(
      base::Issue{"", 0, "--corners", text, "two numbers of inner corners from 3 to 100, such as 9x6"});
}

void pattern(const PatternOptions& options) {
  const report::Paper& paper = report::paper_of(options.paper);
  const auto [columns, rows] = of_command_line([&] { return corners_of(options.corners); });
  const double square_m =
      options.square_mm > 0.0 ? options.square_mm * kMillimetre : report::largest_square_m(paper, columns, rows);
  const report::BoardSheet board{paper, columns, rows, square_m};
  report::MarkerSheet markers{paper, {}};
  for (const double diameter : options.markers_mm) markers.diameters_m.push_back(diameter * kMillimetre);
  of_command_line([&] {
    report::validate(board);
    report::validate(markers);
  });

  const fs::path out = output_folder(options.common, "pattern", paper.name);
  check_writable(out);
  base::StagedOutput staged(out);
  using report::SheetFormat;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"chessboard.pdf", report::board_page(board, SheetFormat::pdf)},
      {"chessboard.svg", report::board_page(board, SheetFormat::svg)},
      {"markers.pdf", report::marker_page(markers, SheetFormat::pdf)},
      {"markers.svg", report::marker_page(markers, SheetFormat::svg)}};
  report::Json names = report::Json::array();
  for (const auto& [name, bytes] : files) {
    base::write_file(staged.dir() / name, bytes);
    names.push_back((out / name).string());
  }
  throw_if_interrupted();
  staged.publish_files();
  if (options.common.json) {
    print_result(report::json_text({{"paper", paper.name},
                                    {"inner_corners", {columns, rows}},
                                    {"square_m", square_m},
                                    {"marker_diameters_m", markers.diameters_m},
                                    {"files", names}}));
    return;
  }
  print_result(fmt::format("{}\n{}\n", (out / "chessboard.pdf").string(), (out / "markers.pdf").string()));
  say(options.common,
      fmt::format("Print at 100 %, measure the ruler line, and say in experiment.toml: inner_corners = [{}, {}], "
                  "square_m = {:.6g} (as measured).",
                  columns, rows, square_m));
}

}  // namespace

void add_pattern(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<PatternOptions>();
  CLI::App* command =
      app.add_subcommand("pattern", "Draw a chessboard and a sheet of markers, PDF and SVG, to print to scale");
  std::vector<std::string> names;
  for (const report::Paper& paper : report::papers()) names.push_back(paper.name);
  command->add_option("--paper", options->paper, "Paper size, in landscape format")
      ->type_name("NAME")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command
      ->add_option("--corners", options->corners,
                   "Number of inner corners, where four squares meet: odd in the longer row, even in the shorter")
      ->type_name("NxM")
      ->capture_default_str();
  command->add_option("--square-mm", options->square_mm, "Side of a square; default: the largest whole one that fits")
      ->type_name("MM")
      ->check(check_above_0);
  command->add_option("--marker-mm", options->markers_mm, "Diameters of the markers, one row each")
      ->type_name("MM")
      ->check(check_above_0)
      ->delimiter(',')
      ->default_str("8,12,16,24");
  add_common_options(*command, options->common, "glidelab-out/pattern-<paper>");
  hide_options(*command, {"--jobs", "--verbose"});
  command->callback([options, &chosen] { chosen = [options] { pattern(*options); }; });
}

}  // namespace glidelab::app
