#include "base/toml/toml_set.h"

#include "base/errors.h"
#include "base/toml/strict_toml.h"
#include "tests/catch.h"

using namespace glidelab;
using base::with_values;

namespace {

constexpr const char* kText = R"(
name = "a"
[camera]
rate = 200.0
place = [1.0, 2.0, 3.0]
[[group]]
name = "g1"
[[group.force]]
law = "viscous"
k = 1.0
[[group.force]]
law = "coulomb"
mu = 0.01
[[group]]
name = "g.2"
[[group.force]]
law = "viscous"
k = 2.0
)";

base::TomlFile parsed(const std::vector<base::TomlAssignment>& assignments) {
  return base::TomlFile::parse(with_values(kText, "t.toml", assignments), "t.toml");
}

std::string message(const std::string& path) {
  try {
    with_values(kText, "t.toml", {{path, 1.0}});
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("Values reach keys of tables, elements of arrays, and the tables of an array by number, text or all") {
  const base::TomlFile file = parsed({{"camera.rate", 50.0},
                                      {"camera.place[3]", 7.5},
                                      {"camera.shutter", std::string("global")},
                                      {"light.on", true},
                                      {"group[*].mass", 0.5},
                                      {"group[1].force[law=viscous].k", 3.25},
                                      {"group[name=g.2].force[1].k", 4.0}});
  const base::TomlTable root = file.root();
  CHECK(root.text("name") == "a");
  const base::TomlTable camera = root.table("camera");
  CHECK(camera.number("rate") == 50.0);
  CHECK(camera.numbers("place", 3) == std::vector<double>{1.0, 2.0, 7.5});
  CHECK(camera.text("shutter") == "global");
  CHECK(root.table("light").boolean_or("on", false));
  const auto groups = root.tables("group");
  CHECK(groups[0].number("mass") == 0.5);
  CHECK(groups[1].number("mass") == 0.5);
  CHECK(groups[0].tables("force")[0].number("k") == 3.25);
  CHECK(groups[0].tables("force")[1].number("mu") == 0.01);
  CHECK(groups[1].tables("force")[0].number("k") == 4.0);
}

TEST_CASE("Paths of any spelling reach places that are called by their numbers") {
  using Places = std::vector<std::string>;
  const auto reached = [](const std::string& path) { return base::reached_by(kText, "t.toml", path); };
  CHECK(reached("camera.rate") == Places{"camera.rate"});
  CHECK(reached("light.on") == Places{"light.on"});  // not there yet
  CHECK(reached("camera.place[3]") == Places{"camera.place[3]"});
  CHECK(reached("group[*].mass") == Places{"group[1].mass", "group[2].mass"});
  CHECK(reached("group[name=g.2].mass") == Places{"group[2].mass"});
  CHECK(reached("group[*].force[law=viscous].k") == Places{"group[1].force[1].k", "group[2].force[1].k"});
  CHECK_THROWS_AS(reached("group[3].mass"), base::InputError);
}

TEST_CASE("A key may consist of any letter, digit, underscore and hyphen") {
  for (const std::string key : {"A", "Z", "a", "z", "0", "9", "_", "-"}) {
    INFO(key);
    CHECK(base::TomlFile::parse(with_values("x = 1\n", "t.toml", {{key, 2.0}}), "t.toml").root().number(key) == 2.0);
  }
}

TEST_CASE("A whole number serves for integers and for numbers, and a fraction keeps every bit") {
  const base::TomlFile file = parsed({{"bits", 12.0}, {"x", 0.1 + 0.2}});
  CHECK(file.root().integer("bits", 0, 20) == 12);
  CHECK(file.root().number("bits") == 12.0);
  CHECK(file.root().number("x") == 0.1 + 0.2);
}

TEST_CASE("A text with a quote, a backslash, a line break or a control character reads back as it was") {
  const std::string text =
      "a\"b\\c\nd\x01\x7f"
      "e";
  base::TomlFile file = base::TomlFile::parse("name = " + base::toml_text(text), "t.toml");
  CHECK(file.root().text("name") == text);
}

TEST_CASE("A path that leads nowhere is an error that names it") {
  using Catch::Matchers::Contains;
  CHECK_THAT(message("group.name"), Contains("group.name") && Contains("of which there are 2"));
  CHECK_THAT(message("group[3].name"), Contains("number 3 of 2"));
  CHECK_THAT(message("group[*].force[law=magic].k"), Contains("nothing at this path"));
  CHECK_THAT(message("name.x"), Contains("which is not a table"));
  CHECK_THAT(message("camera..rate"), Contains("an empty part"));
  CHECK_THAT(message("camera.place[0]"), Contains("[0]"));
  CHECK_THAT(message("camera.place[9]"), Contains("number 9 of 3"));
  CHECK_THAT(message("camera.rate[1]"), Contains("no array"));
  CHECK_THAT(message("camera.\"a'b"), Contains("a path such as"));
}

TEST_CASE("A key without a value is taken out wherever it stands, and is no mistake where it does not") {
  const std::string text = with_values(kText, "t.toml",
                                       {{"camera.rate", std::nullopt},
                                        {"group[*].force[law=viscous].k", std::nullopt},
                                        {"camera.shutter", std::nullopt},
                                        {"light.on", std::nullopt}});
  const base::TomlFile file = base::TomlFile::parse(text, "t.toml");
  const base::TomlTable root = file.root();
  CHECK_FALSE(root.table("camera").has("rate"));
  CHECK(root.table("camera").has("place"));
  CHECK_FALSE(root.has("light"));
  for (const base::TomlTable& group : root.tables("group")) CHECK_FALSE(group.tables("force")[0].has("k"));
  CHECK(root.tables("group")[0].tables("force")[1].has("mu"));
  CHECK_THROWS_AS(with_values(kText, "t.toml", {{"camera.place[2]", std::nullopt}}), base::InputError);
}
