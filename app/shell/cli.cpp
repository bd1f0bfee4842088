#include "app/shell/cli.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/shell/build_version.h"
#include "app/shell/common_options.h"
#include "app/shell/program_texts.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "base/text/wrapped_text.h"

namespace glidelab::app {
namespace {

/// CLI11's formatter, except for the words of an option that takes one of many, and for lines that fit a terminal.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = CLI::Formatter::make_option_opts(option);
    const std::string type = option->get_type_name();
    const std::size_t at = text.find(type);
    return type.empty() || at == std::string::npos ? text : text.replace(at, type.size(), shown_type(*option));
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return base::wrapped(CLI::Formatter::make_option_desc(option), base::kTerminalWidth - get_column_width());
  }
  std::string make_description(const CLI::App* app) const override {
    return base::wrapped(CLI::Formatter::make_description(app), base::kTerminalWidth);
  }
  std::string make_footer(const CLI::App* app) const override {
    return base::wrapped(CLI::Formatter::make_footer(app), base::kTerminalWidth);
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream text;
    CLI::detail::format_help(text, command->get_name(),
                             base::wrapped(command->get_description(), base::kTerminalWidth - kCommandWidth),
                             kCommandWidth);
    return text.str();
  }

 private:
  static constexpr std::size_t kCommandWidth = 15;  // the longest name, with two spaces on both sides
};

constexpr int kDone = 0;
constexpr int kWrongInput = 1;
constexpr int kWrongCommandLine = 2;
constexpr int kEnvironmentFailed = 3;
constexpr int kNotMet = 4;
constexpr int kInterrupted = kInterruptedStatus;

/// Colours are for people: on a terminal that supports them, and if NO_COLOR (no-color.org) is not set.
bool in_colour() {
  const char* const refused = ::getenv("NO_COLOR");
  const char* const terminal = ::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && (refused == nullptr || *refused == '\0') &&
         (terminal == nullptr || std::string_view(terminal) != "dumb");
}

/// One line of standard error for each line of the message. An answer that is no is not an error.
int fail(int status, std::string_view message) {
  const char* const head = status == kNotMet ? "glidelab:"
                           : in_colour()     ? "\033[1;31mglidelab: error:\033[0m"
                                             : "glidelab: error:";
  while (!message.empty() && message.back() == '\n') message.remove_suffix(1);
  do {
    const std::size_t newline = message.find('\n');
    tell(fmt::format("{} {}\n", head, message.substr(0, newline)));
    message.remove_prefix(newline == std::string_view::npos ? message.size() : newline + 1);
  } while (!message.empty());
  return status;
}

/// Runs the command; the only place where an exception becomes a status.
int run_command(const Command& command) {
  try {
    throw_if_interrupted();  // if a signal came since the program began
    command();
    return kDone;
  } catch (const ReaderGone&) {
    end_without_reader();
  } catch (const InterruptedKeeping& interrupt) {
    return fail(kInterrupted, interrupt.what());
  } catch (const base::Interrupted&) {
    return fail(kInterrupted, "interrupted; nothing was written");
  } catch (const std::exception&) {
    // An error caused by the interrupt (of a child process, a read) is not the one to report.
    if (interrupted()) return fail(kInterrupted, "interrupted; nothing was written");
    try {
      throw;
    } catch (const CommandLineError& error) {
      return fail(kWrongCommandLine, error.what());
    } catch (const base::InputError& error) {
      return fail(kWrongInput, error.what());
    } catch (const base::NumericalError& error) {
      return fail(kWrongInput, error.what());
    } catch (const base::NotMet& error) {
      return fail(kNotMet, error.what());
    } catch (const base::EnvironmentError& error) {
      return fail(kEnvironmentFailed, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      return fail(kEnvironmentFailed, error.what());
    } catch (const std::bad_alloc&) {
      return fail(kEnvironmentFailed, "out of memory");
    } catch (const cv::Exception& error) {
      // OpenCV may refuse images that passed all earlier checks.
      return fail(error.code == cv::Error::StsNoMem ? kEnvironmentFailed : kWrongInput,
                  fmt::format("an image cannot be processed: {}", error.what()));
    } catch (const std::exception& error) {
      return fail(kEnvironmentFailed, fmt::format("unexpected failure: {}", error.what()));
    }
  }
}

/// An option's value that is not one of its words, with the word that may have been meant; empty if there is none.
/// Options that take a number or a word ("SECONDS|RULE") report this themselves.
std::string misspelt_value(const CLI::App& command, const std::vector<std::string>& arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].find('=');
    const std::string name = arguments[i].substr(0, equals);
    const CLI::Option* const option = name.starts_with("--") ? command.get_option_no_throw(name) : nullptr;
    const std::vector<std::string> words = option == nullptr ? std::vector<std::string>() : words_of(*option);
    const bool or_else = option != nullptr && option->get_type_name().find("|") != std::string::npos;
    if (words.empty() || or_else || (equals == std::string::npos && i + 1 == arguments.size())) continue;
    const std::string value = equals == std::string::npos ? arguments[i + 1] : arguments[i].substr(equals + 1);
    if (std::find(words.begin(), words.end(), value) != words.end()) continue;
    return fmt::format("{}: found \"{}\", expected one of {}{}", name, value, fmt::join(words, ", "),
                       base::did_you_mean(value, words));
  }
  return {};
}

/// The error if there is no command where one is expected: an option that only commands take, or nothing; empty for the
/// program's own options, or for a word that may be misspelt.
std::string before_command(const CLI::App& app, const std::string& word) {
  if (app.get_option_no_throw(word) != nullptr) return {};
  const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
  const bool of_a_command = std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) {
    return command->get_option_no_throw(word) != nullptr;
  });
  const char* version = word == "-v" ? "; --version shows the version" : "";
  if (of_a_command) return fmt::format("option \"{0}\" without a command: glidelab COMMAND {0}{1}", word, version);
  return word.starts_with("--") ? std::string()
                                : fmt::format("unknown option \"{}\"; glidelab --help lists them", word);
}

/// For a misspelt command CLI11 says that one is missing, for a misspelt option that it was not expected; this names
/// the word and the one that was meant. Empty if it is neither of these nor an option's value.
std::string misspelt(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (arguments.empty()) return {};
  const std::string& first = arguments.front();
  std::vector<std::string> names;
  const CLI::App* chosen = first.starts_with("-") ? &app : nullptr;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    if (command->get_name() == first) chosen = command;
  }
  if (chosen == nullptr) {
    const std::string meant = base::did_you_mean(first, names);
    return fmt::format("unknown command \"{}\"{}{} the commands are {}", first, meant, meant.empty() ? ";" : "",
                       fmt::join(names, ", "));
  }
  if (chosen == &app) {
    const std::string meant_of_command = before_command(app, first.substr(0, first.find('=')));
    if (!meant_of_command.empty()) return meant_of_command;
  }
  std::vector<std::string> options;
  for (const CLI::Option* option : chosen->get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  for (const std::string& argument : arguments) {
    const std::string word = argument.substr(0, argument.find('='));
    if (word == "--") break;
    if (!word.starts_with("--") || std::find(options.begin(), options.end(), word) != options.end()) continue;
    const std::string meant = base::did_you_mean(word, options);
    return fmt::format("unknown option \"{}\"{}{} glidelab {}--help lists them", word, meant, meant.empty() ? ";" : "",
                       chosen == &app ? "" : chosen->get_name() + " ");
  }
  return misspelt_value(*chosen, arguments);
}

/// Headings of the commands in the help.
void group_commands(CLI::App& app) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> groups = {
      {"A recording", {"new", "pattern", "check", "analyze", "certify", "diagnose", "characterize"}},
      {"Planning and rehearsal", {"simulate", "render", "validate", "sweep", "require"}},
      {"For the classroom", {"laws", "explore"}},
      {"Tests of the methods", {"coverage", "blind", "challenge"}}};
  for (const auto& [title, names] : groups) {
    for (const char* const name : names) app.get_subcommand(name)->group(title);
  }
}

/// "help COMMAND" is "COMMAND --help", and "help" alone "--help".
std::vector<std::string> words_given(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.emplace_back("--help");
  return words;
}

/// OpenCV and FFmpeg write their own remarks about files to standard error; ours name the file and what is wrong.
void hush_libraries() {
  constexpr int kKeepUsersChoice = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", kKeepUsersChoice);  // AV_LOG_QUIET
  if (::getenv("OPENCV_LOG_LEVEL") == nullptr) cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

/// Reads the command line and runs the command that it names.
int run_words(int argc, char** argv) {
  hush_libraries();
  CLI::App app(
      "Glidelab plans, analyses and diagnoses video experiments on friction: it simulates and films a glider, analyses "
      "real and synthetic clips alike, and finds what the simple law leaves out.",
      "glidelab");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Show this help");
  app.set_version_flag("--version", version_text(), "Show the version, and the libraries it was built with");
  std::string text;  // instead of a command's result
  const auto print_and_leave = [&](const std::string& wanted) {
    text = wanted;
    throw CLI::Success();
  };
  app.add_flag_callback(
      "--man", [&] { print_and_leave(man_page(app)); }, "Print the manual page (roff)");
  app.add_option_function<std::string>(
         "--completion", [&](const std::string& shell) { print_and_leave(completion_script(app, shell)); },
         "Print the completion script for a shell: bash or zsh")
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh"}));
  app.require_subcommand(1);
  app.footer("glidelab COMMAND --help, or glidelab help COMMAND, shows the options of a command.");
  Command command;
  add_new(app, command);
  add_pattern(app, command);
  add_check(app, command);
  add_analyze(app, command);
  add_certify(app, command);
  add_diagnose(app, command);
  add_characterize(app, command);
  add_simulate(app, command);
  add_render(app, command);
  add_validate(app, command);
  add_coverage(app, command);
  add_sweep(app, command);
  add_require(app, command);
  add_laws(app, command);
  add_explore(app, command);
  add_blind(app, command);
  add_challenge(app, command);
  group_commands(app);
  const std::vector<std::string> words = words_given(argc, argv);
  if (words.empty()) {
    tell(app.help());
    return kWrongCommandLine;
  }
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::Success& help_or_version) {
    const std::vector<CLI::App*> commands = app.get_subcommands({});
    const bool is_command = std::any_of(commands.begin(), commands.end(),
                                        [&](const CLI::App* one) { return one->get_name() == words.front(); });
    if (!words.front().starts_with("-") && !is_command) {
      return fail(kWrongCommandLine, misspelt(app, words));  // help COMMAND
    }
    std::ostringstream shown;
    app.exit(help_or_version, shown, shown);
    return run_command([&] { print_result(text + shown.str()); });
  } catch (const CLI::ParseError& error) {
    const std::string unknown = misspelt(app, words);
    fail(kWrongCommandLine, unknown.empty() ? error.what() : unknown);
    tell("Run glidelab --help for the commands, glidelab COMMAND --help for the options of one.\n");
    return kWrongCommandLine;
  }
  return run_command(command);
}

}  // namespace

int run(int argc, char** argv) {
  try {
    hold_standard_streams();
    catch_interrupts();  // from here on every command ends in the same way
    report_lost_memory(kEnvironmentFailed);
    return run_words(argc, argv);
  } catch (const std::bad_alloc&) {  // before a command runs; run_command() reports those of a command
    std::fputs("glidelab: error: out of memory\n", stderr);
    return kEnvironmentFailed;
  }
}

}  // namespace glidelab::app
