#include "base/files/file_io.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab::base;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& dir) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir), fs::directory_iterator{}));
}

}  // namespace

TEST_CASE("published files replace their namesakes and leave the others") {
  const glidelab::tests::TempDir temp;
  fs::create_directories(temp / "out");
  write_file(temp / "out/kept.txt", "kept");
  write_file(temp / "out/new.txt", "old");
  StagedOutput output(temp / "out");
  write_file(output.dir() / "new.txt", "new");
  output.publish_files();
  CHECK(read_file(temp / "out/new.txt") == "new");
  CHECK(read_file(temp / "out/kept.txt") == "kept");
}

TEST_CASE("a published sub-folder replaces what was made before, and keeps what is somebody's own") {
  const glidelab::tests::TempDir temp;
  const auto publish = [&](std::initializer_list<const char*> names, const char* text) {
    StagedOutput output(temp / "out");
    fs::create_directories(output.dir() / "plots/deep");
    for (const char* name : names) write_file(output.dir() / "plots" / name, text);
    output.publish_files();
  };
  publish({"a.svg", "b.svg", "deep/c.gp"}, "first");
  write_file(temp / "out/plots/own.txt", "mine");
  write_file(temp / "out/plots/deep/own.txt", "mine too");
  write_file(temp / "out/plots/deep/c.gp", "edited");
  publish({"a.svg", "deep/c.gp"}, "second");
  CHECK(read_file(temp / "out/plots/a.svg") == "second");
  CHECK_FALSE(fs::exists(temp / "out/plots/b.svg"));
  CHECK(read_file(temp / "out/plots/own.txt") == "mine");
  CHECK(read_file(temp / "out/plots/deep/own.txt") == "mine too");
  CHECK(read_file(temp / "out/plots/deep/c.gp") == "second");
  CHECK(read_file(temp / "out/plots/deep/c.gp.changed") == "edited");
  publish({"a.svg"}, "third");
  CHECK(read_file(temp / "out/plots/own.txt") == "mine");
  CHECK(read_file(temp / "out/plots/deep/c.gp.changed") == "edited");
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("what was made is told from what is somebody's own, whatever its name") {
  const glidelab::tests::TempDir temp;
  for (const char* name : {"plain", "with space", "\"quoted\"", "line\nbreak", "\xc3\xa4"})
    write_file(temp / name, "made");
  CHECK(own_files(temp.path()).size() == 5);  // no list: nobody knows
  list_made_files(temp.path());
  CHECK(own_files(temp.path()).empty());
  write_file(temp / "with space", "edit");  // of the same length
  fs::create_symlink(temp / "plain", temp / "link");
  const std::vector<OwnFile> own = own_files(temp.path());
  REQUIRE(own.size() == 2);
  CHECK((own[0].name == "link" && !own[0].changed));
  CHECK((own[1].name == "with space" && own[1].changed));
  write_file(temp / kMadeList, "something else");
  CHECK_THROWS_AS(own_files(temp.path()), InputError);
}

TEST_CASE("a whole folder replaces the one that stood there") {
  const glidelab::tests::TempDir temp;
  fs::create_directories(temp / "out");
  write_file(temp / "out/old.txt", "old");
  {
    StagedOutput output(temp / "out/");
    write_file(output.dir() / "new.txt", "new");
    output.publish_whole();
  }
  CHECK(fs::exists(temp / "out/new.txt"));
  CHECK_FALSE(fs::exists(temp / "out/old.txt"));
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("a whole folder that is taken back gives its place to the one before, or to none") {
  const glidelab::tests::TempDir temp;
  const auto publish_and_take_back = [&] {
    StagedOutput output(temp / "out");
    write_file(output.dir() / "new.txt", "new");
    output.publish_whole();
    CHECK(fs::exists(temp / "out/new.txt"));
    output.take_back();
  };
  publish_and_take_back();
  CHECK(entries(temp.path()) == 0);
  fs::create_directories(temp / "out");
  write_file(temp / "out/old.txt", "old");
  publish_and_take_back();
  CHECK(read_file(temp / "out/old.txt") == "old");
  CHECK_FALSE(fs::exists(temp / "out/new.txt"));
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("an output that is not published leaves nothing behind") {
  const glidelab::tests::TempDir temp;
  { StagedOutput output(temp / "out"); }
  CHECK(entries(temp.path()) == 0);

  // nor do the folders above it that it made, unless something else has come into them
  { StagedOutput output(temp / "runs/today/out"); }
  CHECK(entries(temp.path()) == 0);
  {
    StagedOutput output(temp / "runs/today/out");
    write_file(temp / "runs/notes.txt", "mine");
  }
  CHECK(read_file(temp / "runs/notes.txt") == "mine");
  CHECK(entries(temp / "runs") == 1);
  // nor where the folder itself cannot be made: its name is too long with what is added to it
  CHECK_THROWS_AS(StagedOutput(temp / "other/deeper" / std::string(230, 'n')), EnvironmentError);
  CHECK_FALSE(fs::exists(temp / "other"));
  fs::create_directories(temp / "empty");
  { StagedOutput output(temp / "empty/out"); }
  CHECK(fs::exists(temp / "empty"));  // made by somebody else
}

TEST_CASE("what would be read without end is refused") {
  const glidelab::tests::TempDir temp;
  const auto says = [](const fs::path& path, const char* what) {
    CHECK_THROWS_MATCHES(
        read_file(path), InputError,
        Catch::Matchers::Predicate<InputError>(
            [&](const InputError& error) { return std::string(error.what()).find(what) != std::string::npos; }, what));
  };
  REQUIRE(::mkfifo((temp / "pipe.toml").c_str(), 0600) == 0);
  says(temp / "pipe.toml", "a named pipe");
  says("/dev/zero", "a device");
  write_file(temp / "huge.toml", "");
  fs::resize_file(temp / "huge.toml", kLargestFile + 1);  // a hole: it takes no space
  says(temp / "huge.toml", "1073741825 bytes");
}

TEST_CASE("what a killed process left is cleared by the next output of that name, what a running one writes is not") {
  const glidelab::tests::TempDir temp;
  fs::create_directories(temp / "out.part-mine");
  const auto child_with_output = [&](const char* name, bool stays) {
    int ready[2];
    REQUIRE(::pipe(ready) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
      StagedOutput output(temp / name);
      write_file(output.dir() / "half.txt", "half");
      (void)!::write(ready[1], "x", 1);
      while (stays) ::pause();
      ::_exit(0);  // as a kill: no destructor runs
    }
    char byte = 0;
    REQUIRE(::read(ready[0], &byte, 1) == 1);
    ::close(ready[0]);
    ::close(ready[1]);
    if (!stays) ::waitpid(child, nullptr, 0);
    return child;
  };
  const pid_t running = child_with_output("out", true);
  child_with_output("out", false);
  child_with_output("other", false);
  CHECK(entries(temp.path()) == 4);
  { StagedOutput output(temp / "out"); }
  CHECK(entries(temp.path()) == 3);  // the folder "mine", the running one's, and the other output's
  ::kill(running, SIGKILL);
  ::waitpid(running, nullptr, 0);
  { StagedOutput output(temp / "out"); }
  CHECK(entries(temp.path()) == 2);
  CHECK(fs::exists(temp / "out.part-mine"));
}

TEST_CASE("an output whose name is taken by a file is an environment error") {
  const glidelab::tests::TempDir temp;
  write_file(temp / "out", "a file");
  CHECK_THROWS_AS(StagedOutput(temp / "out"), EnvironmentError);
  CHECK(read_file(temp / "out") == "a file");
}

TEST_CASE("a write that the system refuses is an environment error") {
  const glidelab::tests::TempDir temp;
  CHECK_THROWS_AS(write_file("/dev/full", std::string(100000, 'x')), EnvironmentError);
  CHECK_THROWS_AS(write_file(temp / "no/such/folder.txt", "x"), EnvironmentError);
}
