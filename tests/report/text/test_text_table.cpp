#include <string>
#include <vector>

#include "base/text/wrapped_text.h"
#include "report/text/display_text.h"
#include "tests/catch.h"

using namespace glidelab;
using report::text_table;

TEST_CASE("a table that fits a terminal has one line a row") {
  CHECK(text_table({{"name", "v (m/s)"}, {"up", "-1.2"}, {"down", "0.24"}}, 1) ==
        "name  v (m/s)\nup       -1.2\ndown     0.24\n");
}

TEST_CASE("a table that is a little too wide has its units on a second line of the head") {
  // 40 + 2 + 23 + 2 + 17 = 84 characters; with units below, 40 + 2 + 17 + 2 + 11 = 72.
  const std::string wide(40, 'a');
  CHECK(text_table({{"name", "terminal velocity (m/s)", "inclination (deg)"}, {wide, "0.24123", "4.3"}}, 1) ==
        std::string(42, ' ') + "terminal velocity  inclination\n" + "name" + std::string(50, ' ') +
            "(m/s)        (deg)\n" + wide + "            0.24123          4.3\n");
}

TEST_CASE("a table that is far too wide is printed in parts that fit, each with the names of its rows") {
  std::vector<std::vector<std::string>> rows = {{"configuration"}, {"0.335 kg, 4°"}, {"0.435 kg, 4°"}};
  for (int c = 0; c < 7; ++c) {
    rows[0].push_back(std::string("column") + static_cast<char>('A' + c));
    rows[1].push_back("0.123456 ± 0.000012");
    rows[2].push_back(std::string("value") + static_cast<char>('A' + c));
  }
  // 13 + 3 (2 + 19) = 76 characters: three columns a part, so three parts of three lines.
  const std::string text = text_table(rows, 1);
  INFO(text);
  std::size_t parts = 0;
  for (std::size_t at = text.find("0.435 kg, 4°"); at != std::string::npos; at = text.find("0.435 kg, 4°", at + 1))
    ++parts;
  CHECK(parts == 3);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    CHECK(base::characters_in(text.substr(at, end - at)) <= base::kTerminalWidth);
    at = end + 1;
  }
  for (char c = 'A'; c < 'H'; ++c) CHECK(text.find(std::string("value") + c) != std::string::npos);
}

TEST_CASE("a last column of words is wrapped below itself") {
  const std::string thirty(30, 'x');  // 1 + 2 + 30 + 1 + 30 = 64 fit, and the third does not
  CHECK(text_table({{"n", "words"}, {"1", thirty + " " + thirty + " " + thirty}, {"2", "short"}}, 2) ==
        "n  words\n1  " + thirty + " " + thirty + "\n   " + thirty + "\n2  short\n");
}

TEST_CASE("a first column of long words is wrapped, with the numbers on the first line of each row") {
  const std::string thirty(30, 'x');
  CHECK(text_table({{"of blind cases", "found"}, {thirty + " " + thirty + " " + thirty, "97 %"}, {"all", "3 %"}}, 1) ==
        "of blind cases" + std::string(49, ' ') + "found\n" + thirty + " " + thirty + "   97 %\n" + thirty + "\nall" +
            std::string(60, ' ') + "  3 %\n");
}
