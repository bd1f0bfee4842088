#include "base/text/json_text.h"

#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.h"

using namespace glidelab::base;

TEST_CASE("JSON becomes text in its own order, indented or on one line") {
  nlohmann::ordered_json document;
  document["mu"] = 0.25;
  document["K"] = {1, 2};
  CHECK(json_text(document, kOnOneLine) == R"({"mu":0.25,"K":[1,2]})");
  CHECK(json_text(document) == "{\n  \"mu\": 0.25,\n  \"K\": [\n    1,\n    2\n  ]\n}");
  CHECK(json_text(nlohmann::json(document), kOnOneLine) == R"({"K":[1,2],"mu":0.25})");
  CHECK(parsed_json(json_text(document)) == nlohmann::json(document));
}

TEST_CASE("invalid UTF-8 in JSON is refused, or replaced where that is asked for") {
  const std::string invalid = "\xff";
  CHECK_THROWS_AS(json_text(nlohmann::json(invalid)), nlohmann::json::type_error);
  CHECK(replaced_json_text(nlohmann::json(invalid)) == "\"\xef\xbf\xbd\"");
  CHECK(replaced_json_text(nlohmann::ordered_json(invalid)) == "\"\xef\xbf\xbd\"");
  CHECK_THROWS_AS(parsed_json("{"), nlohmann::json::parse_error);
  CHECK_THROWS_AS(parsed_json("1e999"), nlohmann::json::out_of_range);
}
