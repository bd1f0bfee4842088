/// glidelab characterize FOLDER: flat fields and dark frames in; camera.toml, characterize.json and report.html out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/files/file_io.h"
#include "core/characterize/camera_measurement.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/photon_transfer.h"
#include "report/characterize/camera_report.h"
#include "report/html/gnuplot.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct CharacterizeOptions {
  CommonOptions common;
  std::string folder;
  std::size_t most_pixels = core::kMostPixels;
};

void characterize(const CharacterizeOptions& options) {
  const fs::path out = output_folder(options.common, "characterize", options.folder);
  core::FlatFieldFolder folder = core::read_flat_field_folder(options.folder);
  folder.most_pixels = options.most_pixels;
  report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);

  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const core::CameraMeasurement camera = core::measure_camera(folder, display.callback());
  const std::string json = report::camera_json(camera);
  base::write_file(staged.dir() / "camera.toml", report::camera_toml(camera));
  base::write_file(staged.dir() / "characterize.json", json);
  report::write_page(staged.dir(), "report.html", report::camera_report(camera));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_answer(options.common.json ? json : report::camera_text(camera));
  say(options.common, fmt::format("camera file: {}", (out / "camera.toml").string()));
  if (!camera.gain_dn_per_e.value) {
    say(options.common,
        "The camera file is incomplete: these images do not determine the gain, so nothing is known in electrons.");
  }
}

}  // namespace

void add_characterize(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<CharacterizeOptions>();
  CLI::App* command = app.add_subcommand(
      "characterize", "Measure a camera from its flat fields and dark frames, and write its camera file");
  command
      ->add_option("FOLDER", options->folder,
                   "A folder with characterize.toml, dark/ and flat-…/ (docs/reference/characterize.md is the recipe)")
      ->required();
  add_max_megapixels(*command, options->most_pixels);
  add_common_options(*command, options->common, "glidelab-out/characterize-<name of the folder>");
  command->callback([options, &chosen] { chosen = [options] { characterize(*options); }; });
}

}  // namespace glidelab::app
