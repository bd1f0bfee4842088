#include "base/staged_output.h"

#include <sys/resource.h>

#include <csignal>

#include "base/errors.h"
#include "catch.h"
#include "temp_dir.h"

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

TEST_CASE("an output that is not published leaves nothing behind") {
  const glidelab::tests::TempDir temp;
  { StagedOutput output(temp / "out"); }
  CHECK(entries(temp.path()) == 0);
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
