/// glidelab explore: the page for class on which the friction parameters are chosen by hand.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/files/file_io.h"
#include "report/text/json_numbers.h"
#include "teach/page/page_words.h"
#include "teach/page/teaching_pages.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct ExploreOptions {
  CommonOptions common;
  std::string language = "en";
};

void explore(const ExploreOptions& all) {
  const CommonOptions& options = all.common;
  const fs::path out = output_folder(options, "explore", "page");
  check_writable(out);
  base::StagedOutput staged(out);
  report::write_page(staged.dir(), "explore.html", teach::explorer_page(teach::explore_phases(), all.language));
  throw_if_interrupted();
  staged.publish_files();
  const std::string page = (out / "explore.html").string();
  print_result(options.json ? report::json_text({{"page", page}}) : page + "\n");
}

}  // namespace

void add_explore(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ExploreOptions>();
  CLI::App* command = app.add_subcommand(
      "explore",
      "Make a page for the classroom: sliders for the law, K/m, mu, alpha and v0; x(t), v(t) and a(v) together");
  command->add_option("--language", options->language, "Language in which the page opens; its menu offers all")
      ->check(CLI::IsMember(teach::language_codes()))
      ->capture_default_str();
  add_common_options(*command, options->common, "glidelab-out/explore-page");
  hide_options(*command, {"--jobs", "--verbose"});
  command->callback([options, &chosen] { chosen = [options] { explore(*options); }; });
}

}  // namespace glidelab::app
