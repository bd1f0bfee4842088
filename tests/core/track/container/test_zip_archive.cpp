#include "core/track/container/zip_archive.h"

#include <algorithm>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/core/made_project.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

TEST_CASE("an archive gives its entries' names and bytes") {
  const tests::TempDir folder;
  const core::ZipArchive archive(tests::write_zip(folder / "a.zip", {{"one.txt", "first"}, {"b/two.txt", "second"}}));
  REQUIRE(archive.entries().size() == 2);
  CHECK(archive.entries()[1].name == "b/two.txt");
  CHECK(archive.read(archive.entries()[0], 5) == "first");
  CHECK(archive.read(archive.entries()[1], 100) == "second");
}

TEST_CASE("no more of an entry is unpacked than is allowed, whatever the archive says of its size") {
  const tests::TempDir folder;
  const std::string zeros(std::size_t{8} << 20, '\0');  // packs to some kilobytes
  const auto file = tests::write_zip(folder / "bomb.zip", {{"x.trk", zeros}});
  std::string bytes = base::read_file(file);
  REQUIRE(bytes.size() < 20'000);
  CHECK_THROWS_WITH(core::ZipArchive(file).read({"x.trk", 0}, 1 << 20),
                    Contains("x.trk: found more than 1048576 bytes"));
  // The size that both headers state, 8 MiB in four bytes, least first, becomes 16.
  const std::string stated("\x00\x00\x80\x00", 4), claimed("\x10\x00\x00\x00", 4);
  int changed = 0;
  for (auto at = bytes.find(stated, 14); at != std::string::npos; at = bytes.find(stated, at + 4), ++changed) {
    bytes.replace(at, 4, claimed);
  }
  REQUIRE(changed >= 1);
  base::write_file(file, bytes);
  CHECK_THROWS_WITH(core::ZipArchive(file).read({"x.trk", 0}, 1 << 20), Contains("x.trk: found"));
}

TEST_CASE("an archive that breaks off, and an entry whose bytes changed, are refused") {
  const tests::TempDir folder;
  const auto file = tests::write_zip(folder / "a.zip", {{"one.txt", "some text that is stored as it stands"}});
  const std::string whole = base::read_file(file);
  base::write_file(file, whole.substr(0, whole.size() / 2));
  CHECK_THROWS_WITH(core::ZipArchive(file), Contains("a.zip: found a zip archive that cannot be read"));
  std::string changed = whole;
  changed[40] = static_cast<char>(changed[40] ^ 0x55);
  base::write_file(file, changed);
  const core::ZipArchive archive(file);
  CHECK_THROWS_AS(archive.read(archive.entries().at(0), 1000), base::InputError);
}

TEST_CASE("a name that is shown has no control characters") {
  const tests::TempDir folder;
  const core::ZipArchive archive(tests::write_zip(folder / "a.zip", {{"x\x1b[31m.trk", "1"}}));
  const std::string& name = archive.entries().at(0).name;
  CHECK(name.ends_with("[31m.trk"));
  CHECK(std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20; }));
}
