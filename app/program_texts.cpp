#include "app/program_texts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "version_of_build.h"

namespace glidelab::app {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Text for roff: a backslash, a hyphen that may not be broken, and a dot or quote that would begin a request.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  for (const char* start : {".", "'"}) {
    if (safe.starts_with(start)) safe.insert(0, "\\&");
    safe = replaced(safe, std::string("\n") + start, std::string("\n\\&") + start);
  }
  return safe;
}

/// "-o, --out DIR".
std::string option_head(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  std::string head = names.empty() ? option.get_name(true) : fmt::format("{}", fmt::join(names, ", "));
  if (!names.empty() && option.get_expected_max() > 0) head += " " + option.get_type_name();
  return head;
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
  text +=
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\ndone\n.TP\n.B 1\nthe input is wrong\n.TP\n.B 2\na wrong command line\n"
      ".TP\n.B 3\nthe environment failed: disk full, codec missing\n"
      ".TP\n.B 4\nwhat was asked to hold does not: a baseline, a target\n.TP\n.B 130\ninterrupted\n";
  return text;
}

}  // namespace glidelab::app
