/// What every command has in common: help, version, and the exit status of a wrong command line.
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <regex>
#include <set>
#include <sstream>

#include "base/files/file_io.h"
#include "base/text/wrapped_text.h"
#include "test_paths.h"
#include "tests/app/command_names.h"
#include "tests/app/made_track.h"
#include "tests/app/run_process.h"
#include "tests/app/tiny_scenario.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::kCommands;

namespace {

/// Commands that make something out of nothing but their options.
bool takes_an_input(const std::string& command) {
  return command != "blind" && command != "new" && command != "pattern" && command != "explore";
}

}  // namespace

TEST_CASE("help lists the commands that exist and no others") {
  const tests::ProcessResult result = tests::glidelab({"--help"});
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  const std::size_t first = result.out.find("\nA recording:\n");
  REQUIRE(first != std::string::npos);
  const std::string list = result.out.substr(first);
  CHECK(list.find("\nPlanning and rehearsal:\n") < list.find("\nFor the classroom:\n"));
  CHECK(list.find("\nTests of the methods:\n") != std::string::npos);
  static const std::regex kCommand(R"(^  ([a-z-]+) )", std::regex::multiline);
  std::set<std::string> listed;
  for (auto match = std::sregex_iterator(list.begin(), list.end(), kCommand); match != std::sregex_iterator();
       ++match) {
    listed.insert((*match)[1]);
  }
  CHECK(listed == std::set<std::string>(kCommands.begin(), kCommands.end()));
}

TEST_CASE("every command's help names the options that every command takes, and --seed where it has an effect") {
  for (const std::string& command : kCommands) {
    const tests::ProcessResult result = tests::glidelab({command, "--help"});
    INFO(command);
    CHECK(result.status == 0);
    for (const char* option : {"--help", "--json", "-q,--quiet"}) {
      INFO(option);
      CHECK(result.out.find(option) != std::string::npos);
    }
    static const std::set<std::string> kInstant = {"new", "pattern", "explore"};
    for (const char* option : {"--jobs N", "-v,--verbose"}) {
      INFO(option);
      CHECK((result.out.find(option) != std::string::npos) != kInstant.contains(command));
    }
    CHECK((result.out.find("-o,--out DIR") != std::string::npos) == (command != "new"));
    static const std::set<std::string> kDrawNothing = {"new",     "pattern", "check",        "simulate",
                                                       "analyze", "explore", "characterize", "laws"};
    CHECK((result.out.find("--seed N") != std::string::npos) != kDrawNothing.contains(command));
    if (command != "new") CHECK(result.out.find("glidelab-out/" + command) != std::string::npos);
  }
}

TEST_CASE("no help says that an option excludes nothing") {
  for (const std::string& command : kCommands) {
    const std::string help = tests::glidelab({command, "--help"}).out;
    INFO(help);
    CHECK_FALSE(std::regex_search(help, std::regex("Excludes: *(\n|  )")));
  }
}

TEST_CASE("help fits a terminal: only an option's own form may be longer than its lines") {
  std::vector<std::vector<std::string>> all = {{"--help"}};
  for (const std::string& command : kCommands) all.push_back({command, "--help"});
  for (const std::vector<std::string>& words : all) {
    std::istringstream lines(tests::glidelab(words).out);
    for (std::string line; std::getline(lines, line);) {
      INFO(words.front() << ": " << line);
      CHECK((base::characters_in(line) <= base::kTerminalWidth || line.starts_with("  -")));
    }
  }
}

TEST_CASE("on a terminal an answer is wrapped between words, in a pipe it is one line") {
  const tests::TempDir temp;
  base::write_file(temp / "scenario.toml", tests::tiny_scenario());
  const std::vector<std::string> words = {"diagnose",
                                          "--plan",
                                          (temp / "scenario.toml").string(),
                                          "--noise-m",
                                          "1e-5",
                                          "-q",
                                          "-o",
                                          (temp / "out").string()};
  const std::string piped = tests::glidelab(words).out;
  CHECK(base::characters_in(piped.substr(0, piped.find('\n'))) > 90);
  const winsize window = {24, 60, 0, 0};
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &window);
  REQUIRE(child >= 0);
  if (child == 0) {
    std::vector<char*> arguments = {const_cast<char*>(tests::kBinary)};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments.front(), arguments.data());
    ::_exit(127);
  }
  std::string shown;
  std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = ::read(terminal, bytes.data(), bytes.size())) > 0;) {
    shown.append(bytes.data(), static_cast<std::size_t>(count));
  }
  ::close(terminal);
  int status = -1;
  CHECK(::waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  std::erase(shown, '\r');
  INFO(shown);
  CHECK(shown.substr(0, shown.find("\n\n")) == base::wrapped(piped.substr(0, piped.find("\n\n")), window.ws_col));
}

TEST_CASE("the version is printed and nothing else is done") {
  const tests::ProcessResult result = tests::glidelab({"--version"});
  CHECK(result.status == 0);
  CHECK(result.out.starts_with("glidelab "));
  // Two builds of one version differ in the commit that they are of.
  const bool checkout = std::filesystem::exists(tests::kSourceDir + std::string("/.git"));
  CHECK((result.out.find(" (") < result.out.find("\n")) == checkout);
}

TEST_CASE("a wrong command line is status 2, one message, and nothing on standard output") {
  const std::vector<std::vector<std::string>> wrong = {
      {"blind", "x.toml"},
      {"--no-such-option"},
      {"analyze"},
      {"render"},
      {"validate", "a.toml", "b.toml"},
      {"analyze", "folder", "--jobs", "0"},
      {"analyze", "folder", "--jobs", "many"},
      {"analyze", "folder", "--seed", "-1"},
      {"analyze", "folder", "--bandwidth", "0"},
      {"analyze", "folder", "--bandwidth", "nan"},
      {"analyze", "folder", "--bandwidth", "inf"},
      {"analyze", "folder", "--bandwidth", "silverman"},
      {"analyze", "folder", "--estimator", "magic"},
      {"analyze", "folder", "--out", ""},
      {"analyze", "folder", "--out", "--json"},
      {"diagnose", "folder", "--twin", "-o", "there"},
      {"simulate", "a.toml", "--rate", "-200"},
      {"render", "a.toml", "--no-such-option"},
      {"diagnose", "folder", "--without", "quadratic_darg"},
      {"analyze", "folder", "--robust"},
      {"analyze", "track.csv", "--mass", "nan"},
      {"analyze", "track.csv", "--mass", "0"},
      {"analyze", "track.csv", "--incline", "nan"},
      {"pattern", "--square-mm", "nan"},
      {"pattern", "--square-mm", "0"},
      {"pattern", "--marker-mm", "8,nan"},
      {"require", "a.toml", "--target", "mu=1", "--confirm", "tracks", "--runs", "20"},
      {"diagnose", "folder", "--noise-m", "1e-5"},
      {"diagnose", "--plan", "folder", "--without", "stribeck"},
      {"diagnose", "--plan", "folder", "--twin", "twin.toml"},
      {"diagnose", "--plan", "a.toml", "--noise-m", "nan"},
      {"diagnose", "--plan", "a.toml", "--noise-m", "-1"},
      {"require", "a.toml", "--target", "mu"},
      {"new"},
      {"new", "a", "-o", "b"},
      {"-v"},
      {"-x"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    const tests::ProcessResult result = tests::glidelab(arguments);
    INFO((arguments.empty() ? "no argument" : arguments.front() + " " + arguments.back()));
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(result.out.empty());
    CHECK(result.err.starts_with("glidelab: error: "));
  }
}

TEST_CASE("an unknown command is named together with those that exist") {
  const tests::ProcessResult result = tests::glidelab({"guess", "folder"});
  CHECK(result.err.find("unknown command \"guess\"") != std::string::npos);
  CHECK(result.err.find("new, pattern, check, analyze, certify, diagnose, characterize, simulate, render, validate, "
                        "coverage, sweep, require, laws, explore, blind, challenge") != std::string::npos);
}

TEST_CASE("an input that is not there is status 1 and names the file, whatever the command") {
  const tests::TempDir temp;
  const auto name = GENERATE(std::string("nothing.toml"), std::string(300, 'n'));  // or that no file can be called
  for (const std::string& command : kCommands) {
    if (!takes_an_input(command)) continue;
    std::vector<std::string> arguments = {command, (temp / name).string()};
    if (command == "challenge") arguments = {command, "score", (temp / name).string(), "answers"};
    if (command == "coverage") arguments.insert(arguments.end(), {"--noise-m", "1e-5"});
    if (command == "require") arguments.insert(arguments.end(), {"--target", "mu=0.001"});
    const tests::ProcessResult result = tests::glidelab(arguments, temp.path());
    INFO(command << ": " << result.err);
    CHECK(result.status == 1);
    CHECK(result.err.starts_with("glidelab: error: "));
    CHECK(result.err.find(name) != std::string::npos);
    CHECK(result.out.empty());
    CHECK_FALSE(std::filesystem::exists(temp / "glidelab-out"));
  }
}

TEST_CASE("a file that is not there is told as that, whatever is stated of it") {
  const tests::TempDir temp;
  for (const char* const command : {"check", "analyze", "diagnose"}) {
    const tests::ProcessResult result =
        tests::glidelab({command, (temp / "nofile.csv").string(), "--mass", "0.01"}, temp.path());
    INFO(command << ": " << result.err);
    CHECK(result.status == 1);
    CHECK(result.err.find("nofile.csv: found no file or folder of this name") != std::string::npos);
  }
}

TEST_CASE("a misspelt command or option is answered with the one that was meant") {
  CHECK(tests::glidelab({"analyse", "folder"}).err.find("did you mean \"analyze\"?") != std::string::npos);
  const tests::ProcessResult result = tests::glidelab({"analyze", "folder", "--bandwith", "0.04"});
  CHECK(result.status == 2);
  CHECK(result.err.find("unknown option \"--bandwith\"; did you mean \"--bandwidth\"?") != std::string::npos);
  CHECK(tests::glidelab({"--versoin"}).err.find("did you mean \"--version\"?") != std::string::npos);
}

TEST_CASE("blind films its cases under both names of the option, and not everyday tracks") {
  for (const char* name : {"--films", "--pictures"}) {
    INFO(name);
    const tests::ProcessResult result = tests::glidelab({"blind", "--cases", "1", name, "--everyday"});
    CHECK(result.status == 2);
    CHECK(result.err.find("excludes") != std::string::npos);
  }
}

TEST_CASE("the version names the libraries that it was built with") {
  const std::string text = tests::glidelab({"--version"}).out;
  for (const char* library : {"Eigen 3", "SUNDIALS 6", "OpenCV 4", "SQLite 3", "OSMesa ", "libavcodec "}) {
    INFO(library);
    CHECK(text.find(library) != std::string::npos);
  }
}

TEST_CASE("with --verbose each stage's time is said, and --quiet with it is a contradiction") {
  CHECK(tests::glidelab({"analyze", "folder", "-v", "-q"}).status == 2);
  const tests::TempDir temp;
  base::write_file(temp / "tiny.toml", tests::tiny_scenario());
  const tests::ProcessResult result = tests::glidelab({"simulate", "tiny.toml", "-v"}, temp.path());
  INFO(result.err);
  CHECK(result.status == 0);
  static const std::regex kTook(R"(simulating: took [0-9]+\.[0-9]{2} s, [0-9]+\.[0-9]{3} s of processor time)");
  CHECK(std::regex_search(result.err, kTook));
}

TEST_CASE("without a word the help is shown, and help takes a command's name") {
  const std::string help = tests::glidelab({"--help"}).out;
  const tests::ProcessResult bare = tests::glidelab({});
  CHECK(bare.status == 2);
  CHECK(bare.out.empty());
  CHECK(bare.err == help);
  CHECK(tests::glidelab({"help"}).out == help);
  CHECK(tests::glidelab({"help", "render"}).out == tests::glidelab({"render", "--help"}).out);
  const tests::ProcessResult unknown = tests::glidelab({"help", "rendr"});
  CHECK(unknown.status == 2);
  CHECK(unknown.err.find("unknown command \"rendr\"; did you mean \"render\"?") != std::string::npos);
}

TEST_CASE("a misspelt value of an option is answered with the one that was meant") {
  const tests::ProcessResult estimator = tests::glidelab({"analyze", "folder", "--estimator", "trajectry"});
  CHECK(estimator.status == 2);
  CHECK(estimator.err.find("--estimator: found \"trajectry\", expected one of phase-diagram, phase-diagram-gls, "
                           "trajectory; did you mean \"trajectory\"?") != std::string::npos);
  CHECK(tests::glidelab({"pattern", "--paper=a5"}).err.find("did you mean \"a4\"?") != std::string::npos);
  const tests::ProcessResult target = tests::glidelab({"require", "x.toml", "--target", "mue=0.001"});
  CHECK(target.status == 2);
  CHECK(target.err.find("did you mean \"mu\"?") != std::string::npos);
  // The second of two as well, and before a folder is looked at.
  const tests::ProcessResult without =
      tests::glidelab({"diagnose", "folder", "--without", "stribeck", "quadratic_darg"});
  CHECK(without.status == 2);
  CHECK(without.err.find("did you mean \"quadratic_drag\"?") != std::string::npos);
  CHECK(tests::glidelab({"diagnose", "folder", "--without", "smoothing_bias"}).status == 1);  // no such folder
  const tests::ProcessResult rule = tests::glidelab({"analyze", "folder", "--bandwidth", "gvc"});
  CHECK(rule.status == 2);
  CHECK(rule.err.find("did you mean \"gcv\"?") != std::string::npos);
  // A number beside another option's wrong word is none itself.
  CHECK(tests::glidelab({"analyze", "folder", "--bandwidth", "0.02", "--estimator", "trajectry"})
            .err.find("--estimator: found") != std::string::npos);
  const tests::TempDir temp;
  std::string scenario = tests::tiny_scenario();
  const std::size_t at = scenario.find("launched = \"up\"");
  REQUIRE(at != std::string::npos);
  base::write_file(temp / "s.toml", scenario.replace(at, 15, "launched = \"upp\""));
  CHECK(tests::glidelab({"simulate", "s.toml"}, temp.path()).err.find("did you mean \"up\"?") != std::string::npos);
}

TEST_CASE("help shows the words of an option where they are few, and not twenty names of effects") {
  const std::string diagnose = tests::glidelab({"diagnose", "--help"}).out;
  CHECK(diagnose.find("--without EFFECT ...") != std::string::npos);
  CHECK(diagnose.find("{") == std::string::npos);
  CHECK(diagnose.find("--recorded-by sensor|camera ") != std::string::npos);
  CHECK(tests::glidelab({"diagnose", "x.csv", "--recorded-by", "sonar"}).err.find("neither sensor nor camera") !=
        std::string::npos);
  CHECK(tests::glidelab({"analyze", "--help"}).out.find("--bandwidth SECONDS|RULE=lines") != std::string::npos);
  CHECK(tests::glidelab({"pattern", "--help"}).out.find("NAME:{a4,a3,letter}=a4") != std::string::npos);
  CHECK(tests::glidelab({"--man"}).out.find("quadratic_drag") == std::string::npos);
}

TEST_CASE("an option of commands that stands alone is told its place") {
  const tests::ProcessResult short_one = tests::glidelab({"-v"});
  CHECK(short_one.status == 2);
  CHECK(short_one.err.find("option \"-v\" without a command") != std::string::npos);
  CHECK(short_one.err.find("--version") != std::string::npos);
  CHECK(tests::glidelab({"--json", "check"}).err.find("option \"--json\" without a command") != std::string::npos);
  CHECK(tests::glidelab({"-x"}).err.find("unknown option \"-x\"") != std::string::npos);
}

TEST_CASE("a scenario, a sweep or a folder where another is wanted is called what it is") {
  const tests::TempDir temp;
  base::write_file(temp / "tiny.toml", tests::tiny_scenario());
  base::write_file(temp / "sweep.toml", "scenario = \"tiny.toml\"\n[[vary]]\nkey = \"seed\"\nvalues = [1, 2]\n");
  for (const char* command : {"analyze", "diagnose", "check"}) {
    const tests::ProcessResult scenario = tests::glidelab({command, "tiny.toml"}, temp.path());
    INFO(command << ": " << scenario.err);
    CHECK(scenario.status == 1);
    CHECK(scenario.err.find("tiny.toml: found a scenario, expected a recording") != std::string::npos);
    const tests::ProcessResult sweep = tests::glidelab({command, "sweep.toml"}, temp.path());
    CHECK(sweep.status == 1);
    CHECK(sweep.err.find("sweep.toml: found a sweep") != std::string::npos);
  }
  const tests::ProcessResult folder = tests::glidelab({"render", "."}, temp.path());
  CHECK(folder.status == 1);
  CHECK(folder.err.find("found a folder, expected a scenario") != std::string::npos);
  base::write_file(temp / "experiment.toml", "");
  CHECK(tests::glidelab({"render", "."}, temp.path()).err.find("a recording, expected a scenario") !=
        std::string::npos);
  CHECK_FALSE(std::filesystem::exists(temp / "glidelab-out"));
}

TEST_CASE("a plan of a scenario wants its noise on the command line") {
  const tests::TempDir temp;
  base::write_file(temp / "tiny.toml", tests::tiny_scenario());
  const tests::ProcessResult result = tests::glidelab({"diagnose", "--plan", "tiny.toml"}, temp.path());
  CHECK(result.status == 2);
  CHECK(result.err.find("tiny.toml: --noise-m is missing") != std::string::npos);
}

TEST_CASE("a plan takes one scenario, or recordings without a noise of the command line") {
  const tests::TempDir temp;
  base::write_file(temp / "tiny.toml", tests::tiny_scenario());
  const tests::ProcessResult two =
      tests::glidelab({"diagnose", "--plan", "tiny.toml", "other.toml", "--noise-m", "1e-5", "--no-page"}, temp.path());
  INFO(two.err);
  CHECK(two.status == 2);
  CHECK(two.err.find("EXPERIMENT: found 2 of them, the first a file") != std::string::npos);
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult noise =
      tests::glidelab({"diagnose", "--plan", "made", "--noise-m", "1e-5", "--no-page"}, temp.path());
  INFO(noise.err);
  CHECK(noise.status == 2);
  CHECK(noise.err.find("--noise-m: found a noise with a recording") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(temp / "glidelab-out"));
}

TEST_CASE("an output folder that is a dangling link is called one, and so is what it would lie in") {
  const tests::TempDir temp;
  base::write_file(temp / "tiny.toml", tests::tiny_scenario());
  std::filesystem::create_symlink("gone", temp / "link");
  for (const char* out : {"link", "link/inside"}) {
    const tests::ProcessResult result = tests::glidelab({"simulate", "tiny.toml", "-o", out}, temp.path());
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(result.err.find("link: is a dangling link (gone does not exist)") != std::string::npos);
  }
  std::filesystem::create_directory(temp / "gone");
  CHECK(tests::glidelab({"simulate", "tiny.toml", "-o", "link"}, temp.path()).status == 0);
}

TEST_CASE("a terminal without colours gets none") {
  if (tests::run({"script", "--version"}).status != 0) {
    WARN("skipped: no script program");
    return;
  }
  const auto said = [](const std::string& settings) {
    const std::string command = settings + " '" + tests::kBinary + "' simulate nothing.toml";
    return tests::run({"script", "-qec", command, "/dev/null"}).out;
  };
  CHECK(said("env -u NO_COLOR TERM=xterm").find("\033[") != std::string::npos);
  CHECK(said("env -u NO_COLOR TERM=dumb").find("\033[") == std::string::npos);
}
