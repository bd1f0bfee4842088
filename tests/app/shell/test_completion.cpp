/// What shells and man(1) are told of the program: completions, and the manual page.
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/command_names.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::kCommands;

TEST_CASE("the manual page's examples are README's, of files that exist and options that the commands take") {
  const auto lines_of = [](const std::string& text, const std::string& from, const std::string& to, bool roff) {
    std::vector<std::string> found;
    const std::size_t begin = text.find(from), end = text.find(to);
    REQUIRE(begin < end);
    REQUIRE(end != std::string::npos);
    std::istringstream lines(text.substr(begin, end - begin));
    for (std::string line; std::getline(lines, line);) {
      if (roff) line = std::regex_replace(line, std::regex(R"(\\-)"), "-");
      if (!line.starts_with(roff ? "glidelab " : "    glidelab ")) continue;
      line = std::regex_replace(line, std::regex(R"(^ +| *#.*$)"), "");
      found.push_back(line);
    }
    return found;
  };
  const std::filesystem::path source(tests::kSourceDir);
  const std::vector<std::string> shown =
      lines_of(tests::glidelab({"--man"}).out, ".SH EXAMPLES", ".SH EXIT STATUS", true);
  CHECK(shown ==
        lines_of(base::read_file(source / "README.md"), "## I plan an experiment", "## What to expect", false));
  CHECK(shown.size() > 10);
  for (const std::string& line : shown) {
    std::istringstream words(line);
    std::string word, command;
    words >> word >> command;
    const std::string help = tests::glidelab({command, "--help"}).out;
    INFO(line);
    CHECK_FALSE(help.empty());
    while (words >> word) {
      if (word.starts_with("-")) CHECK(help.find(word) != std::string::npos);
      if (word.starts_with("scenarios/")) CHECK(std::filesystem::exists(source / word));
    }
  }
}

TEST_CASE("the manual page and the completions name every command and its options") {
  const std::string man = tests::glidelab({"--man"}).out;
  CHECK(man.starts_with(".TH GLIDELAB 1"));
  const std::string bash = tests::glidelab({"--completion", "bash"}).out;
  const std::string zsh = tests::glidelab({"--completion", "zsh"}).out;
  CHECK(zsh.starts_with("#compdef glidelab"));
  for (const std::string& command : kCommands) {
    INFO(command);
    CHECK(man.find(".SS glidelab " + command) != std::string::npos);
    CHECK(bash.find("    " + command + ") words=\"") != std::string::npos);
    CHECK(zsh.find("    '" + command + ":") != std::string::npos);
  }
  CHECK(man.find("\\-o, \\-\\-out DIR") != std::string::npos);
  CHECK(tests::glidelab({"--completion", "fish"}).status == 2);
}

TEST_CASE("bash completes a command's name, and the options of a command") {
  const tests::TempDir temp;
  base::write_file(temp / "glidelab", tests::glidelab({"--completion", "bash"}).out);
  base::write_file(temp / "ask.sh",
                   "source ./glidelab\n"
                   "COMP_WORDS=(glidelab sim) COMP_CWORD=1; _glidelab; echo \"${COMPREPLY[*]}\"\n"
                   "COMP_WORDS=(glidelab analyze --est) COMP_CWORD=2; _glidelab; echo \"${COMPREPLY[*]}\"\n");
  const tests::ProcessResult result = tests::run({"bash", "ask.sh"}, temp.path());
  INFO(result.err);
  CHECK(result.out == "simulate\n--estimator\n");
}

TEST_CASE("bash completes the words of an option, nothing for a number, and files where a file is wanted") {
  const tests::TempDir temp;
  base::write_file(temp / "glidelab", tests::glidelab({"--completion", "bash"}).out);
  base::write_file(temp / "s.toml", "");
  base::write_file(temp / "ask.sh",
                   "source ./glidelab\n"
                   "ask() { COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1)); _glidelab; echo \"${COMPREPLY[*]}\"; }\n"
                   "ask glidelab analyze x --estimator traj\n"
                   "ask glidelab analyze x --estimator = traj\n"
                   "ask glidelab pattern --paper ''\n"
                   "ask glidelab require x --confirm c\n"
                   "ask glidelab --completion ''\n"
                   "ask glidelab analyze x --jobs ''\n"
                   "ask glidelab render s\n"
                   "ask glidelab validate x --baseline s\n"
                   "ask glidelab help rend\n"
                   "ask glidelab analyze -q\n"
                   "ask glidelab diagnose x --without quad\n"
                   "ask glidelab diagnose x --without smooth\n"
                   "ask glidelab analyze x --bandwidth g\n");
  const tests::ProcessResult result = tests::run({"bash", "ask.sh"}, temp.path());
  INFO(result.err);
  CHECK(result.out ==
        "trajectory\ntrajectory\na4 a3 letter\nclips\nbash zsh\n\ns.toml\ns.toml\nrender\n-q\n"
        "quadratic_drag\nsmoothing_bias\ngcv\n");
}

TEST_CASE("zsh takes the completion at a terminal: the words of an option, and no error for a number") {
  if (tests::run({"zsh", "--version"}).status != 0) {
    WARN("skipped: no zsh program");
    return;
  }
  const tests::TempDir temp;
  base::write_file(temp / "_glidelab", tests::glidelab({"--completion", "zsh"}).out);
  // A shell at a terminal of its own completes; Ctrl-X Ctrl-A shows the line as it then is. 30 s at the most.
  base::write_file(temp / "ask.zsh", R"(zmodload zsh/zpty
zpty shell "TERM=dumb zsh -f -i"
ask() {
  zpty -w -n shell "$1"$'\t\C-x\C-a'
  zpty -r shell out '*<END>*'
  print -r -- "$out"
}
zpty -w shell 'PS1=; fpath=($PWD $fpath); autoload -Uz compinit; compinit -u -D; show() { print -r "<LINE:$BUFFER><END>"; BUFFER=; }; zle -N show; bindkey "^X^A" show; unsetopt beep; print LO""ADED'
zpty -r shell out '*LOADED*'
ask 'glidelab analyze x --estimator traj'
ask 'glidelab analyze x --jobs '
ask 'glidelab require x --confirm cl'
ask 'glidelab rend'
ask 'glidelab --completion ba'
ask 'glidelab pattern --pap'
ask 'glidelab diagnose x --without quad'
ask 'glidelab analyze x --bandwidth gc'
)");
  const tests::ProcessResult result = tests::run({"timeout", "30", "zsh", "-f", "ask.zsh"}, temp.path());
  INFO(result.out << result.err);
  CHECK(result.status == 0);
  for (const char* line :
       {"<LINE:glidelab analyze x --estimator trajectory >", "<LINE:glidelab analyze x --jobs >",
        "<LINE:glidelab require x --confirm clips >", "<LINE:glidelab render >", "<LINE:glidelab --completion bash >",
        "<LINE:glidelab pattern --paper", "<LINE:glidelab diagnose x --without quadratic_drag >",
        "<LINE:glidelab analyze x --bandwidth gcv >"}) {
    INFO(line);
    CHECK(result.out.find(line) != std::string::npos);
  }
  for (const char* error : {"command not found", "bad pattern", "parse error"}) {
    CHECK(result.out.find(error) == std::string::npos);
  }
}
