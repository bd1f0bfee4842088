#include "report/gnuplot.h"

#include <stdlib.h>

#include <filesystem>
#include <optional>

#include "base/errors.h"
#include "catch.h"
#include "temp_dir.h"

using namespace glidelab;

namespace {

/// Sets an environment variable for one test.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = ::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (old_) {
      ::setenv(name_, old_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

}  // namespace

TEST_CASE("a plot of data is an SVG of the size that was asked for") {
  const std::vector<report::PlotData> data = {{"points", {{0.0, 1.0}, {1.0, 2.0}, {}, {2.0, std::nan("")}}}};
  const std::string svg = report::gnuplot_svg("plot $points using 1:2 with lines", data, {500, 300});
  CHECK(svg.find("<svg") != std::string::npos);
  CHECK(svg.find("viewBox=\"0 0 500 300\"") != std::string::npos);
}

TEST_CASE("a script that gnuplot rejects is an environment error with gnuplot's message") {
  CHECK_THROWS_AS(report::gnuplot_svg("plot no_such_thing(", {}), base::EnvironmentError);
}

TEST_CASE("a missing gnuplot is an environment error that names it") {
  const tests::TempDir empty;
  const Environment path("PATH", empty.path().string());
  CHECK_THROWS_AS(report::check_gnuplot(), base::EnvironmentError);
  CHECK_THROWS_WITH(report::check_gnuplot(), Catch::Matchers::Contains("gnuplot"));
}

TEST_CASE("a text is quoted so that it stays one text") {
  CHECK(report::gnuplot_quoted("plain") == "'plain'");
  CHECK(report::gnuplot_quoted("it's") == "'it’s'");
  CHECK(report::gnuplot_quoted("a\nb") == "'a b'");
  const tests::TempDir temp;
  const std::string evil = "'; system 'touch " + (temp / "made").string() + "'\n!touch " + (temp / "made").string();
  report::gnuplot_svg("plot sin(x) title " + report::gnuplot_quoted(evil), {});
  CHECK_FALSE(std::filesystem::exists(temp / "made"));
}

TEST_CASE("no plot leaves a temporary folder behind") {
  const tests::TempDir temp;
  const Environment folder("TMPDIR", temp.path().string());
  report::gnuplot_svg("plot sin(x)", {});
  CHECK_THROWS(report::gnuplot_svg("no command", {}));
  CHECK(std::filesystem::is_empty(temp.path()));
}
