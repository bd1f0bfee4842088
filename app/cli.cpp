#include "app/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>
#include <string_view>

#include "app/commands.h"
#include "app/interrupt.h"
#include "base/errors.h"

namespace glidelab::app {
namespace {

constexpr int kDone = 0;
constexpr int kWrongInput = 1;
constexpr int kWrongCommandLine = 2;
constexpr int kEnvironmentFailed = 3;
constexpr int kNotMet = 4;
constexpr int kInterrupted = 130;  // as a shell says it of SIGINT

/// One line of standard error for each line of the message.
int fail(int status, std::string_view message) {
  while (!message.empty() && message.back() == '\n') message.remove_suffix(1);
  do {
    const std::size_t newline = message.find('\n');
    fmt::print(stderr, "glidelab: error: {}\n", message.substr(0, newline));
    message.remove_prefix(newline == std::string_view::npos ? message.size() : newline + 1);
  } while (!message.empty());
  return status;
}

/// Runs the command; the only place where an exception becomes a status.
int run_command(const Command& command) {
  try {
    command();
    return kDone;
  } catch (const base::Interrupted&) {
    return fail(kInterrupted, "interrupted; nothing was written");
  } catch (const std::exception&) {
    // What an interrupt tears down on its way (a child process, a read) is not the error to report.
    if (interrupted()) return fail(kInterrupted, "interrupted; nothing was written");
    try {
      throw;
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
      // OpenCV refuses pictures that no check before it has caught.
      return fail(error.code == cv::Error::StsNoMem ? kEnvironmentFailed : kWrongInput,
                  fmt::format("a picture cannot be processed: {}", error.what()));
    } catch (const std::exception& error) {
      return fail(kEnvironmentFailed, fmt::format("unexpected failure: {}", error.what()));
    }
  }
}

/// CLI11 says of a misspelt command that one is missing; this says which word it was. Empty where that is not the case.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == argv[1]) return {};
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return fmt::format("unknown command \"{}\"; the commands are {}", argv[1], names);
}

/// OpenCV and FFmpeg write their own remarks about files to standard error; ours name the file and what is wrong.
void hush_libraries() {
  constexpr int kKeepUsersChoice = 0;
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", kKeepUsersChoice);  // AV_LOG_QUIET
  if (::getenv("OPENCV_LOG_LEVEL") == nullptr) cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

}  // namespace

int run(int argc, char** argv) {
  hush_libraries();
  CLI::App app(
      "Glidelab rehearses video experiments on friction: it simulates a glider on a track, films it, analyses the film "
      "as one analyses a real one, and compares the result with the truth.",
      "glidelab");
  app.set_help_flag("-h,--help", "Show this help");
  app.set_version_flag("--version", "glidelab " GLIDELAB_VERSION, "Show the version");
  app.require_subcommand(1);
  app.footer("glidelab COMMAND --help shows the options of a command.");
  Command command;
  add_simulate(app, command);
  add_render(app, command);
  add_analyze(app, command);
  add_validate(app, command);
  add_coverage(app, command);
  add_sweep(app, command);
  add_require(app, command);
  add_laws(app, command);
  add_characterize(app, command);
  add_diagnose(app, command);
  add_blind(app, command);
  add_new(app, command);
  add_pattern(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_command(app, argc, argv);
    fail(kWrongCommandLine, unknown.empty() ? error.what() : unknown);
    fmt::print(stderr, "Run glidelab --help for the commands, glidelab COMMAND --help for the options of one.\n");
    return kWrongCommandLine;
  }
  catch_interrupts();
  return run_command(command);
}

}  // namespace glidelab::app
