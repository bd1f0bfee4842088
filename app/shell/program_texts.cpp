#include "app/shell/program_texts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string_view>
#include <vector>

#include "app/shell/build_version.h"
#include "base/text/nearest_word.h"

namespace glidelab::app {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> all;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> names = names_of(*option);
    all.insert(all.end(), names.begin(), names.end());
  }
  return all;
}

bool takes_value(const CLI::Option& option) {
  return option.get_expected_max() > 0;
}

/// "N" of "N:INT in [1 - 1024]": CLI11 appends its check to the name.
std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

bool takes_file(const CLI::Option& option) {
  const std::string name = value_name(option);
  return name == "FILE" || name == "DIR" || name == "PATH" || name == "DIR|FILE" || name.ends_with(".toml");
}

std::string command_names(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) names += command->get_name() + " ";
  return names + "help";
}

/// Completions after an option: "words" are offered, or nothing if "nothing" is set, or files.
std::string bash_values(const CLI::App& app, const std::string& indent) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> names = names_of(*option);
    if (names.empty() || !takes_value(*option)) continue;
    const std::vector<std::string> words = words_of(*option);
    const std::string offer = !words.empty()        ? fmt::format("values=\"{}\"", fmt::join(words, " "))
                              : takes_file(*option) ? "files=1"
                                                    : "nothing=1";
    text += fmt::format("{}{}) {} ;;\n", indent, fmt::join(names, "|"), offer);
  }
  return text;
}

std::string bash_script(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    cases += fmt::format("    {}) words=\"{}\"\n      case \"$previous\" in\n{}      esac ;;\n", command->get_name(),
                         fmt::join(option_names(*command), " "), bash_values(*command, "        "));
  }
  return fmt::format(R"(# bash completion for glidelab
_glidelab() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}"
  local words="" values="" files="" nothing=""
  # --name=value comes as three words
  if [ "$current" = "=" ]; then current=""
  elif [ "$previous" = "=" ]; then previous="${{COMP_WORDS[COMP_CWORD-2]}}"
  fi
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{0} {1}" -- "$current"))
    return
  fi
  case "${{COMP_WORDS[1]}}" in
    help) values="{0}" ;;
    -*)
      case "$previous" in
{2}        *) nothing=1 ;;
      esac ;;
{3}  esac
  COMPREPLY=()
  if [ -n "$values" ]; then
    COMPREPLY=($(compgen -W "$values" -- "$current"))
  elif [ -n "$nothing" ]; then
    return
  elif [ -z "$files" ] && [[ "$current" == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    compopt -o filenames 2>/dev/null
    local IFS=$'\n'
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}}
complete -F _glidelab glidelab
)",
                     command_names(app), fmt::join(option_names(app), " "), bash_values(app, "        "), cases);
}

/// The first line of an option's description, between single quotes and brackets.
std::string between_brackets(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  boost::replace_all(line, "\\", "\\\\");
  boost::replace_all(line, "'", "'\\''");
  boost::replace_all(line, "[", "(");
  boost::replace_all(line, "]", ")");
  return line;
}

/// One specification of _arguments for each name of each option. The action behind the second colon is zsh code: a list
/// in parentheses, a function, or nothing to offer.
std::string zsh_arguments(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> words = words_of(*option);
    const std::string action = !words.empty()        ? fmt::format("({})", fmt::join(words, " "))
                               : takes_file(*option) ? "_files"
                                                     : " ";
    const std::string value = takes_value(*option) ? fmt::format(":{}:{}", value_name(*option), action) : "";
    const char* many = option->get_items_expected_max() > 1 ? "*" : "";
    for (const std::string& name : names_of(*option)) {
      const char* joined = takes_value(*option) && name.starts_with("--") ? "=" : "";
      text += fmt::format(" \\\n        '{}{}{}[{}]{}'", many, name, joined,
                          between_brackets(option->get_description()), value);
    }
  }
  return text;
}

std::string zsh_script(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands += fmt::format("    '{}:{}'\n", command->get_name(), between_brackets(command->get_description()));
    cases += fmt::format("    {})\n      _arguments{} \\\n        '*:file:_files'\n      ;;\n", command->get_name(),
                         zsh_arguments(*command));
  }
  return fmt::format(R"(#compdef glidelab
# zsh completion for glidelab
local -a commands
commands=(
{}    'help:Show the help of a command'
)
if [[ $words[2] == -* ]]; then
  _arguments{}
elif (( CURRENT == 2 )) || [[ $words[2] == help ]]; then
  _describe 'command' commands
else
  local command=${{words[2]}}
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
fi
)",
                     commands, zsh_arguments(app), cases);
}

}  // namespace

std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  std::vector<std::string> words;
  if (open == std::string::npos || close == std::string::npos) return words;
  std::istringstream list(type.substr(open + 1, close - open - 1));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](std::string& value) {
        if (std::find(words.begin(), words.end(), value) != words.end()) return std::string();
        return fmt::format("found \"{}\", expected one of {}{}", value, fmt::join(words, ", "),
                           base::did_you_mean(value, words));
      },
      fmt::format("{{{}}}", fmt::join(words, ",")));
}

std::string shown_type(const CLI::Option& option) {
  constexpr std::size_t kMostWords = 6;  // more are listed in the description, or where it points to
  const std::string type = option.get_type_name();
  return words_of(option).size() > kMostWords ? type.substr(0, type.find(":{")) : type;
}

std::string completion_script(const CLI::App& app, const std::string& shell) {
  return shell == "zsh" ? zsh_script(app) : bash_script(app);
}

namespace {

/// Text for roff: a backslash, a non-breaking hyphen, and a dot or quote that would begin a request.
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

/// The commands that README suggests to its three kinds of reader; a test keeps the two consistent.
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
       {"glidelab check my-track", "glidelab analyze my-track", "glidelab certify my-track",
        "glidelab diagnose my-track"}},
      {"I teach:",
       {"glidelab explore -o class", "glidelab laws scenarios/laws -o laws",
        "glidelab laws scenarios/laws --worksheet -o sheets",
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

std::string man_page(const CLI::App& app) {
  std::string text = fmt::format(
      ".TH GLIDELAB 1 \"\" \"glidelab {}\" \"User Commands\"\n"
      ".SH NAME\nglidelab \\- rehearse and analyse video experiments on friction\n"
      ".SH SYNOPSIS\n.B glidelab\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] [\\fIFILES\\fR]\n"
      ".SH DESCRIPTION\n{}\n.SH OPTIONS\n{}.SH COMMANDS\n",
      build_version(), roff(app.get_description()), options_of(app));
  for (const CLI::App* command : app.get_subcommands({})) {
    text += fmt::format(".SS glidelab {}\n{}\n", roff(command->get_name()), roff(command->get_description()));
    text += options_of(*command);
    if (!command->get_footer().empty()) text += ".PP\n" + roff(command->get_footer()) + "\n";
  }
  text += examples();
  text +=
      ".SH EXIT STATUS\n"
      ".TP\n.B 0\ndone\n.TP\n.B 1\nthe input is wrong\n.TP\n.B 2\nthe command line is wrong\n"
      ".TP\n.B 3\nthe environment failed: disk full, codec missing\n"
      ".TP\n.B 4\na requirement is not met (a baseline, a target, a usable recording, a twin that a "
      "scenario cannot express, intervals that do not hold, flat fields that give no gain)\n.TP\n.B 130\ninterrupted\n";
  return text;
}

}  // namespace glidelab::app
