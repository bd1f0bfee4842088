#include "core/track/text_encoding.h"

#include "tests/catch.h"

using glidelab::core::as_utf8;
using glidelab::core::no_table_in;

TEST_CASE("text of spreadsheets becomes UTF-8, whatever its encoding") {
  using namespace std::string_literals;
  CHECK(as_utf8("\xEF\xBB\xBFt,x\n") == "t,x\n");
  CHECK(as_utf8("Posici\xC3\xB3n\n") == "Posici\xC3\xB3n\n");
  CHECK(as_utf8("Posici\xF3n (\xB5m)\n") == "Posici\xC3\xB3n (\xC2\xB5m)\n");  // Latin-1
  CHECK(as_utf8("\xC0\xAF") == "\xC3\x80\xC2\xAF");                            // an overlong form is no UTF-8
  CHECK(as_utf8("\xFF\xFEt\0\t\0x\0\n\0"s) == "t\tx\n");                       // UTF-16, low byte first
  CHECK(as_utf8("\xFE\xFF\0t\0\t\0\xE9\x20\x12\0\n"s) == "t\t\xC3\xA9\xE2\x80\x92\n");
  CHECK(as_utf8("\xFF\xFE\x3D\xD8\0\xDE"s) == "??");  // a pair of surrogates
  CHECK(as_utf8("") == "");
}

TEST_CASE("files that hold no table in text are named") {
  using namespace std::string_literals;
  CHECK(no_table_in("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1").what == "an Excel file (.xls)");
  CHECK(no_table_in("\x93NUMPY\x01\0"s).what == "an array of numpy (.npy)");
  CHECK(no_table_in("MATLAB 5.0 MAT-file, Platform").what == "a file of MATLAB (.mat)");
  CHECK(no_table_in("  \n[{\"t\": 0.0, \"x\": 0.1}]").what == "JSON");
  CHECK(no_table_in("{\"time\": [0]}").what == "JSON");
  CHECK(no_table_in("t,x\n0,1\n").what.empty());
  CHECK(no_table_in("[s],[m]\n0,1\n").what.empty());
  CHECK(no_table_in("").what.empty());
  CHECK(no_table_in("[Run 1]\n\"t\",\"x\"\n0,1\n").what.empty());  // a title
  CHECK(no_table_in("MATLAB 7.3 MAT-file, Platform").what == "a file of MATLAB (.mat)");
}
