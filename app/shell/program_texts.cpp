#include "app/shell/program_texts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cstddef>
#include <string_view>
#include <vector>

#include "app/shell/completion.h"
#include "version_of_build.h"

namespace glidelab::app {
namespace {

/// Text for roff: a backslash, a hyphen that may not be broken, and a dot or quote that would begin a request.
std::string roff(const std::string& text) {
  std::string safe = boost::replace_all_copy(text, "\\", "\\e");
  boost::replace_all(safe, "-", "\\-");
  for (const char* start : {".", "'"}) {
    if (safe.starts_with(start)) safe.insert(0, "\\&");
    boost::replace_all(safe, std::string("\n") + start, std::string("\n\\&") + start);
  }
  return safe;
}

/// "-o, --out DIR".
std::string option_head(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  std::string head = names.empty() ? option.get_name(true) : fmt::format("{}", fmt::join(names, ", "));
  if (!names.empty() && option.get_expected_max() > 0) head += " " + shown_type(option);
  return head;
}

/// What README's three readers are told to run; a test holds the two together.
struct Example {
  std::string_view reader;
  std::vector<std::string_view> commands;
};

std::string examples() {
  static const std::vector<Example> kExamples = {
      {"I plan an experiment:",
       {"glidelab require scenarios/studies/cameras.toml --target mu=0.0001 -o cameras",
        "glidelab sweep scenarios/studies/one-camera.toml -o bandwidth",
        "glidelab validate scenarios/rehearsals/raspberry-90.toml -o raspberry",
        "glidelab diagnose --plan scenarios/rehearsals/raspberry-90.toml --noise-m 1.5e-5 -o plan"}},
      {"I have recorded clips:",
       {"glidelab new my-track", "glidelab check my-track", "glidelab analyze my-track", "glidelab diagnose my-track"}},
      {"I teach:",
       {"glidelab explore -o class", "glidelab laws scenarios/laws -o laws",
        "glidelab simulate scenarios/laws/6-stribeck.toml -o stribeck"}}};
  std::string text =
      ".SH EXAMPLES\nThe scenarios are in the source folder, and once installed in share/glidelab/scenarios.\n";
  for (const Example& example : kExamples) {
    text += fmt::format(".PP\n{}\n.PP\n.nf\n.RS 4\n", example.reader);
    for (const std::string_view command : example.commands) text += roff(std::string(command)) + "\n";
    text += ".RE\n.fi\n";
  }
  return text;
}

std::string options_of(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(option_head(*option)), roff(option->get_description()));
  }
  return text;
}

}  // namespace

std::string version_text() {
  return "glidelab " GLIDELAB_VERSION "\nbuilt with " GLIDELAB_LIBRARIES;
}

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH GLIDELAB 1 \"\" \"glidelab {}\" \"User Commands\"\n"
      ".SH NAME\nglidelab \\- rehearse and analyse video experiments on friction\n"
      ".SH SYNOPSIS\n.B glidelab\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] [\\fIFILES\\fR]\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n{}.SH COMMANDS\n",
      GLIDELAB_VERSION, roff(app.get_description()), options_of(app));
  for (const CLI::App* command : app.get_subcommands({})) {
    text += fmt::format(".SS glidelab {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
    text += options_of(*command);
    if (!command->get_footer().empty()) text += ".PP\n" + roff(command->get_footer()) + "\n";
  }
  text += examples();
  text +=
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\ndone\n.TP\n.B 1\nthe input is wrong\n.TP\n.B 2\na wrong command line\n"
      ".TP\n.B 3\nthe environment failed: disk full, codec missing\n"
      ".TP\n.B 4\na requirement is not met: a baseline, a target\n.TP\n.B 130\ninterrupted\n";
  return text;
}

}  // namespace glidelab::app
