#include "report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "base/errors.h"
#include "base/staged_output.h"
#include "base/temporary_folder.h"

namespace glidelab::report {
namespace {

namespace fs = std::filesystem;

/// The process environment with another locale, so that numbers have a decimal point and texts are UTF-8.
std::vector<std::string> plot_environment() {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    if (text.starts_with("LC_") || text.starts_with("LANG=") || text.starts_with("LANGUAGE=")) continue;
    variables.emplace_back(text);
  }
  variables.emplace_back("LC_ALL=C.UTF-8");
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  std::transform(texts.begin(), texts.end(), std::back_inserter(list), [](std::string& text) { return text.data(); });
  list.push_back(nullptr);
  return list;
}

/// Runs gnuplot to its end with standard input closed and both outputs in `log`; returns what waitpid tells.
int run(std::vector<std::string> arguments, const fs::path& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // In a process group of its own, so that an interrupt at the terminal reaches this program alone, which then decides.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<std::string> environment = plot_environment();
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, "gnuplot", &actions, &attributes, pointers(arguments).data(),
                                   pointers(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw base::EnvironmentError(
        fmt::format("gnuplot, which draws the plots, cannot be started: {} (Debian's package is gnuplot-nox)",
                    std::strerror(error)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw base::EnvironmentError(fmt::format("gnuplot: waiting for it: {}", std::strerror(errno)));
  }
  return status;
}

void check_status(int status, const fs::path& log) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("failed with status {}", WEXITSTATUS(status));
  throw base::EnvironmentError(fmt::format("gnuplot {}: {}", how, base::read_file(log)));
}

std::string data_block(const PlotData& data) {
  std::string text = fmt::format("${} << END_OF_DATA\n", data.name);
  for (const std::vector<double>& row : data.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ' ';
      text += std::isfinite(row[i]) ? fmt::format("{:.7g}", row[i]) : "NaN";  // 7 digits: far below a pixel
    }
    text += '\n';
  }
  return text + "END_OF_DATA\n";
}

}  // namespace

std::string gnuplot_quoted(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "’";  // gnuplot 5.4 reads a doubled quote at the start of a text as its end
    } else {
      quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return quoted + "'";
}

std::string gnuplot_svg(std::string_view script, std::span<const PlotData> data, PlotSize size) {
  const base::TemporaryFolder folder("plot");
  const fs::path svg = folder / "plot.svg";
  const fs::path log = folder / "log.txt";
  // At the font size 15 text is still 11 pixels high where the page shows the plot 350 pixels wide.
  std::string text = fmt::format(
      "set terminal svg noenhanced size {},{} dynamic font 'sans-serif,15' background '#ffffff'\n"
      "set output {}\nset encoding utf8\n",
      size.width, size.height, gnuplot_quoted(svg.string()));
  for (const PlotData& block : data) text += data_block(block);
  text += script;
  text += "\nunset output\n";
  base::write_file(folder / "plot.gp", text);
  check_status(run({"gnuplot", "-d", (folder / "plot.gp").string()}, log), log);
  std::error_code missing;
  if (!fs::exists(svg, missing)) throw base::EnvironmentError("gnuplot: no plot written: " + base::read_file(log));
  return base::read_file(svg);
}

void check_gnuplot() {
  const base::TemporaryFolder folder("plot");
  const fs::path log = folder / "log.txt";
  check_status(run({"gnuplot", "--version"}, log), log);
}

}  // namespace glidelab::report
