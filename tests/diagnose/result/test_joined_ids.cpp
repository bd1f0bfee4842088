#include "diagnose/result/joined_ids.h"

#include "tests/catch.h"

using namespace glidelab;
using Ids = std::vector<std::string>;

TEST_CASE("the ids of an explanation are joined to one text and read back from it, however many they are") {
  for (const Ids& ids : {Ids{"none"}, Ids{"quadratic_drag", "unknown"}, Ids{"a", "b", "c"}}) {
    CHECK(diagnose::split_ids(diagnose::joined_ids(ids)) == ids);
  }
  CHECK(diagnose::joined_ids({"a", "b", "c"}) == "a + b + c");
  CHECK(diagnose::split_ids("a+b") == Ids{"a+b"});
  CHECK(diagnose::split_ids("") == Ids{""});
  CHECK(diagnose::split_ids("a + ") == Ids{"a", ""});
}
