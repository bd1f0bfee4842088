#include "base/text/csv.h"

#include <cmath>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab::base;

namespace {

std::string error_of(const std::string& text) {
  const glidelab::tests::TempDir temp;
  write_file(temp / "t.csv", text);
  try {
    read_csv(temp / "t.csv", {"t_s", "x_m"}, {"force_n"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a table with comments, CRLF, a byte-order mark and an optional column is read") {
  const glidelab::tests::TempDir temp;
  write_file(temp / "t.csv", "\xEF\xBB\xBF# made by hand\r\nt_s,force_n,x_m\r\n0,1,+2.5\r\n\r\n0.1,-1,3e-1\r\n");
  const CsvTable table = read_csv(temp / "t.csv", {"t_s", "x_m"}, {"force_n"});
  CHECK(table.column("x_m") == std::vector<double>{2.5, 0.3});
  CHECK(table.column("force_n") == std::vector<double>{1.0, -1.0});
  CHECK(table.line == std::vector<int>{3, 5});
}

TEST_CASE("bad fields are named by line and column") {
  CHECK(contains(error_of("t_s,x_m\n0,1\n0.1,nan\n"), "t.csv:3: column \"x_m\": found \"nan\""));
  CHECK(contains(error_of("t_s,x_m\n0,1\n0,1,0,5\n"), "decimal commas"));
  CHECK(contains(error_of("t_s;x_m\n0;1\n"), "unknown column"));
  CHECK(contains(error_of("t_s\n0\n"), "no column \"x_m\""));
  CHECK(contains(error_of("t_s,x_m\n0,\n"), "found \"\""));
  CHECK(contains(error_of(""), "no header"));
  CHECK(contains(error_of("t_s,x_m,t_s\n0,1,2\n"), "twice"));
}

TEST_CASE("a column knows what the last digit of its numbers is worth, the finest of them") {
  const glidelab::tests::TempDir temp;
  write_file(temp / "t.csv", "a,b,c,d,e\n2.310,1,-2.5e-3,1E+3,1.5e+4\n2.3,20,+1e-1,2.50e2,2E+4\n");
  const CsvTable table = read_csv(temp / "t.csv", {"a", "b", "c", "d", "e"});
  const auto is = [&](const char* column, double worth) {
    CHECK(std::abs(table.last_digit_of(column) / worth - 1.0) < 1e-12);  // a power of ten, to rounding
  };
  is("a", 1e-3);
  is("b", 1.0);
  is("c", 1e-4);
  is("d", 1.0);
  is("e", 1e3);
  write_file(temp / "t.csv", "a\n0.0e-2147483648\n0.0e-99999999999\n");  // exponents beyond any whole number
  CHECK(read_csv(temp / "t.csv", {"a"}).last_digit_of("a") == 0.0);
}

TEST_CASE("numbers written read back as the same doubles") {
  const glidelab::tests::TempDir temp;
  CsvWriter writer("t_s,x_m");
  const std::vector<double> values{0.1, 1.0 / 3.0, -1e-17, 12345678.9};
  for (const double value : values) writer.number(value).number(-value).end_row();
  write_file(temp / "t.csv", writer.str());
  CHECK(read_csv(temp / "t.csv", {"t_s", "x_m"}).column("t_s") == values);
}
