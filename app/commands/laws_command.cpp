/// glidelab laws scenarios/laws: one page on the laws of friction, for a lecture.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "report/html/gnuplot.h"
#include "report/text/json_numbers.h"
#include "teach/page/page_words.h"
#include "teach/page/teaching_pages.h"
#include "teach/page/worksheet.h"
#include "teach/study/law_study.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct LawsOptions {
  CommonOptions common;
  std::vector<std::string> scenarios;
  std::string language = "en";
  bool worksheet = false;
};

std::vector<fs::path> files_of(const std::vector<std::string>& names) {
  std::vector<fs::path> files;
  for (const std::string& name : names) {
    std::error_code ignored;
    if (!fs::is_directory(name, ignored)) {
      files.emplace_back(name);
      continue;
    }
    std::set<fs::path> found;
    for (const auto& entry : fs::directory_iterator(name)) {
      if (entry.path().extension() == ".toml") found.insert(entry.path());
    }
    if (found.empty()) throw base::InputError(base::Issue{name, 0, "", "no scenario", "a folder with scenario files"});
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

/// NAME.pdf and NAME-answers.pdf of each scenario NAME.toml.
void make_worksheets(const LawsOptions& options, const std::vector<fs::path>& files, const fs::path& out) {
  std::vector<teach::LawStudy> studies;
  std::set<std::string> names;
  for (const fs::path& file : files) {
    studies.push_back(teach::study_law(file));
    if (!names.insert(file.stem().string()).second) {
      throw base::InputError(base::Issue{file.string(), 0, "", "a second scenario of this name",
                                         "scenarios with different names: worksheets are named after them"});
    }
    if (std::ranges::none_of(studies.back().curves, [](const teach::LawCurve& c) { return !c.down_v_m_s.empty(); })) {
      throw base::InputError(base::Issue{file.string(), 0, "", "no motion downhill",
                                         "a clip with some speed downhill, for the worksheet's questions"});
    }
  }
  const std::vector<teach::Worksheet> sheets = teach::worksheets(studies, options.language);
  base::StagedOutput staged(out);
  std::string listed;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string name = files[i].stem().string();
    base::write_file(staged.dir() / (name + ".pdf"), sheets[i].pdf);
    base::write_file(staged.dir() / (name + "-answers.pdf"), sheets[i].answers);
    listed += (out / (name + ".pdf")).string() + "\n" + (out / (name + "-answers.pdf")).string() + "\n";
  }
  throw_if_interrupted();
  staged.publish_files();
  print_result(options.common.json ? report::json_text({{"worksheets", files.size()}, {"folder", out.string()}})
                                   : listed);
}

void laws(const LawsOptions& options) {
  const std::vector<fs::path> files = files_of(options.scenarios);
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "laws", options.scenarios.front());
  check_writable(out);
  if (options.worksheet) return make_worksheets(options, files, out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  std::vector<teach::LawStudy> studies;
  for (const fs::path& file : files) studies.push_back(teach::study_law(file));
  teach::LawFilmOptions filming;
  filming.jobs = options.common.jobs;
  std::vector<teach::LawFilm> films;
  for (const fs::path& file : files) {
    display.callback()("filming", static_cast<double>(films.size()) / static_cast<double>(files.size()));
    films.push_back(teach::film_law(file, filming));
    throw_if_interrupted();
  }
  base::StagedOutput staged(out);
  report::write_page(staged.dir(), "laws.html",
                     teach::laws_report(studies, films, display.callback(), options.language));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  const std::string page = (out / "laws.html").string();
  print_result(options.common.json ? report::json_text({{"laws", studies.size()}, {"page", page}}) : page + "\n");
}

}  // namespace

void add_laws(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<LawsOptions>();
  CLI::App* command = app.add_subcommand(
      "laws", "Make one page of friction laws: each with a film, x(t), and a(v) with its equilibria");
  command->add_option("SCENARIO", options->scenarios, "Scenario files, or folders of them (scenarios/laws)")
      ->type_name("PATH")
      ->required();
  command->add_flag("--worksheet", options->worksheet,
                    "Instead of the page, write for each scenario a worksheet (NAME.pdf) and its answers "
                    "(NAME-answers.pdf)");
  command
      ->add_option("--language", options->language,
                   "Language in which the page opens (its menu offers all), and of the worksheets")
      ->check(CLI::IsMember(teach::language_codes()))
      ->capture_default_str();
  add_common_options(*command, options->common, "glidelab-out/laws-<name of the first scenario>");
  command->callback([options, &chosen] { chosen = [options] { laws(*options); }; });
}

}  // namespace glidelab::app
