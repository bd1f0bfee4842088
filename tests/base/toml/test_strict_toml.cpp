#include "base/toml/strict_toml.h"

#include <map>
#include <string>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab::base;

namespace {

std::string message_of(const TomlFile& file) {
  try {
    file.finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a file whose keys were all read passes and gives its values") {
  const TomlFile file = TomlFile::parse("a = 1\nb = 2.5\n[c]\nd = \"x\"\n[[e]]\nf=[1,2]\n[[e]]\nf=[3,4]\n", "t.toml");
  CHECK(file.root().number("a") == 1.0);
  CHECK(file.root().number("b", between(2.0, 3.0)) == 2.5);
  CHECK(file.root().table("c").word("d", {"x", "y"}) == "x");
  const auto tables = file.root().tables("e");
  REQUIRE(tables.size() == 2);
  CHECK(tables[0].numbers("f", 2) == std::vector<double>{1.0, 2.0});
  CHECK(tables[1].numbers("f", 2)[1] == 4.0);
  CHECK(message_of(file).empty());
}

TEST_CASE("a value that cannot be read is one error, whatever the caller finds wrong with what stands for it") {
  const TomlFile file = TomlFile::parse("a = [0.0, 0.0]\nb = 3\nc = [1.0, 1.0]\n", "t.toml");
  file.root().numbers("a", 0, above(0.0));
  file.root().reject("a", "nan twice", "each one once");
  file.root().texts_or_none("b");
  file.root().reject("b", "an empty list", "one or more");
  file.root().numbers("c", 0);
  file.root().reject("c", "1 twice", "each one once");
  const std::string message = message_of(file);
  CHECK(contains(message, "t.toml:1: a: found 0, expected an array of numbers"));
  CHECK(contains(message, "t.toml:2: b: found 3, expected an array of texts"));
  CHECK(contains(message, "t.toml:3: c: found 1 twice"));
  CHECK_FALSE(contains(message, "nan"));
  CHECK_FALSE(contains(message, "empty"));
}

TEST_CASE("an unknown key is named with its line and the nearest known key") {
  const TomlFile file = TomlFile::parse("[camera]\nframe_rate_hz = 200\nexposure_ms = 1\n", "t.toml");
  file.root().table("camera").number("frame_rate_hz");
  file.root().table("camera").maybe_number("exposure_s");
  const std::string message = message_of(file);
  CHECK(contains(message, "t.toml:3: camera.exposure_ms: found an unknown key"));
  CHECK(contains(message, "exposure_s"));
}

TEST_CASE("all errors of a file are reported together, in the order of lines") {
  const TomlFile file = TomlFile::parse("a = -1\nb = \"two\"\nc = nan\n[d]\n", "t.toml");
  file.root().number("a", above(0.0));
  file.root().number("b");
  file.root().number("c");
  file.root().table("d").integer("n", 1, 3);
  file.root().table("d").integer("format", 1, 1);
  file.root().table("missing").number("x");
  const std::string message = message_of(file);
  CHECK(contains(message, "t.toml:1: a: found -1, expected a number above 0"));
  CHECK(contains(message, "t.toml:2: b: found text \"two\""));
  CHECK(contains(message, "t.toml:3: c: found nan"));
  CHECK(contains(message, "t.toml:4: d.n: found nothing, expected a whole number from 1 to 3"));
  CHECK(contains(message, "t.toml:4: d.format: found nothing, expected 1"));
  CHECK_FALSE(contains(message, "from 1 to 1"));
  CHECK(contains(message, "missing: found nothing, expected a table [missing]"));
  CHECK_FALSE(contains(message, "missing.x"));
  CHECK(message.find("b: found") < message.find("c: found"));
}

TEST_CASE("errors of one line are reported in the order in which they were found") {
  const TomlFile file = TomlFile::parse("a = [\"x\", true]\n[t]\nd = 1\nc = 2\n", "t.toml");
  file.root().reject("a", "the first", "another");
  file.root().reject("a", "the second", "another");
  file.root().ignore("t");
  const std::string message = message_of(file);
  CHECK(contains(message, "the second"));
  CHECK(message.find("the first") < message.find("the second"));
}

TEST_CASE("a range says its limits: both, one or none") {
  CHECK(between(1.0, 2.5).describe() == "a number from 1 to 2.5");
  CHECK(between_open(1.0, 2.5).describe() == "a number above 1 and below 2.5");
  CHECK(at_least(1.0).describe() == "a number of at least 1");
  CHECK(above(1.0).describe() == "a number above 1");
  CHECK(Range{.high = 2.0}.describe() == "a number of at most 2");
  CHECK(any_number().describe() == "a finite number");
}

TEST_CASE("the scalars of a table are its numbers, texts and truth values, and those of the tables in it") {
  const TomlFile file = TomlFile::parse("n = 2.5\ns = \"text\"\nb = true\n[t]\ni = 3\n", "t.toml");
  const auto scalars = file.root().scalars();
  REQUIRE(scalars.size() == 4);
  std::map<std::string, TomlScalar> by_key(scalars.begin(), scalars.end());
  CHECK(by_key.at("n") == TomlScalar(2.5));
  CHECK(by_key.at("s") == TomlScalar(std::string("text")));
  CHECK(by_key.at("b") == TomlScalar(true));
  CHECK(by_key.at("t.i") == TomlScalar(3.0));
  CHECK(message_of(file).empty());
}

TEST_CASE("a file that is no TOML is an error with its line") {
  CHECK_THROWS_AS(TomlFile::parse("a = 1\nb = = 2\n", "t.toml"), InputError);
  try {
    TomlFile::parse("a = 1\nb = = 2\n", "t.toml");
  } catch (const InputError& error) {
    CHECK(contains(error.what(), "t.toml:2:"));
  }
}

TEST_CASE("a missing file is an input error that names it") {
  try {
    TomlFile::load("no/such/file.toml");
    FAIL("no error");
  } catch (const InputError& error) {
    CHECK(contains(error.what(), "no/such/file.toml"));
  }
}

TEST_CASE("the user's own table is not looked at") {
  const TomlFile file = TomlFile::parse("[extra]\nanything = [1, \"a\"]\n", "t.toml");
  file.root().ignore("extra");
  CHECK(message_of(file).empty());
}

TEST_CASE("A file takes missing keys over from another, and messages name the one that a value comes from") {
  TomlFile own = TomlFile::parse("[a]\nx = 1.0\n[c]\nz = 1.0\n", "own.toml");
  TomlFile other =
      TomlFile::parse("\n\n[a]\nx = 7.0\ny = \"text\"\nw = 3.0\n[b]\nu = 2.0\n[d]\nv = 1.0\n", "other.toml");
  own.add_missing("a", other, {"w"});
  own.add_missing("b", other, {});
  own.add_missing("c", other, {});
  CHECK(own.root().table("a").number("x") == 1.0);
  CHECK(own.root().table("b").number("u") == 2.0);
  CHECK(own.root().table("c").number("z") == 1.0);
  CHECK_FALSE(own.root().table("a").has("w"));
  CHECK_FALSE(own.root().has("d"));
  CHECK(own.root().table("a").keys() == std::vector<std::string>{"x", "y"});
  own.root().table("a").number("y");
  try {
    own.finish();
    FAIL("a text was taken for a number");
  } catch (const InputError& error) {
    REQUIRE(error.issues().size() == 1);
    CHECK(error.issues()[0].file == "other.toml");
    CHECK(error.issues()[0].line == 5);
    CHECK(error.issues()[0].key == "a.y");
  }
}

TEST_CASE("a decimal comma is named with the number as it is written with a point, other mistakes as before") {
  const auto message = [](const std::string& text) {
    try {
      TomlFile::parse(text, "t.toml");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message("a = 1\nmass_kg = 0,335  # of the glider\n").find("t.toml:2") != std::string::npos);
  CHECK(message("a = 1\nmass_kg = 0,335  # of the glider\n").find("a decimal point: mass_kg = 0.335") !=
        std::string::npos);
  CHECK(message("a = = 1\n").find("decimal") == std::string::npos);
}
