#include "report/html/plot.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/catch.h"

using namespace glidelab::report;
using namespace glidelab;

namespace {

struct Tic {
  std::string label;
  double at = 0.0;
};

/// Of the line "set xtics ('60' 60, '' 70)".
std::vector<Tic> tics_of(const std::string& script) {
  std::vector<Tic> tics;
  std::istringstream text(script.substr(script.find("set xtics (") + 11));
  for (char quote = 0; text >> quote && quote == '\'';) {
    Tic tic;
    std::getline(text, tic.label, '\'');
    text >> tic.at >> quote;
    tics.push_back(tic);
  }
  return tics;
}

}  // namespace

TEST_CASE("marks below zero are written with a minus sign, and steps are round numbers, as many as were asked for") {
  const std::vector<Tic> tics = tics_of(report::ValueAxis({-1.2, -0.8}, false).script(360.0));
  REQUIRE(tics.size() == 2);
  CHECK(tics[0].label == "−1.2");
  CHECK(tics[0].at == -1.2);
  CHECK(report::tick_step(2.3, 6) == 0.5);
  CHECK(report::tick_step(1.2, 6) == 0.2);
  CHECK(report::tick_step(3600.0, 6) == 1000.0);
}

TEST_CASE("marks of an axis have the decimals of their step, and no power of ten is written with an e") {
  CHECK(report::even_tics("x", -0.6, 0.8, 6) == "set xtics 0.5\nset format x '%.1f'\n");
  CHECK(report::even_tics("y", -8e-5, 1e-4, 8) == "set ytics 5e-05\nset format y '%.5f'\n");
  CHECK(report::even_tics("x", 0.0, 12.0, 6) == "set xtics 2\nset format x '%.0f'\n");
  CHECK(report::tic_label(-1.957e-5) == "−1.957·10⁻⁵");
  CHECK(report::tic_label(1e-6) == "10⁻⁶");
  CHECK(report::tic_label(0.0002) == "0.0002");
  CHECK(report::tic_label(10000.0) == "10000");
  CHECK(report::labelled_tics("y", {5e-5, 1e-4}) == "set ytics ('5·10⁻⁵' 5e-05, '0.0001' 0.0001)\n");
  const std::vector<Tic> tics = tics_of(report::ValueAxis({5e-6, 1.957e-5, 7.663e-5, 3e-4}, true).script(360.0));
  REQUIRE(tics.size() == 4);
  CHECK(tics[0].label == "5·10⁻⁶");
  CHECK(tics[1].label == "1.957·10⁻⁵");  // eight letters in fourteen bytes have room
  CHECK(tics[3].label == "0.0003");
}

TEST_CASE("values that were run have marks of their own, and labels only where there is room for them") {
  const report::ValueAxis axis({120.0, 60.0, 240.0, 60.0}, false);
  CHECK(axis.size() == 3);
  const std::vector<Tic> tics = tics_of(axis.script(360.0));
  REQUIRE(tics.size() == 3);
  CHECK(tics[0].label == "60");
  CHECK(tics[1].label == "120");
  CHECK(tics[2].label == "240");
  const std::vector<Tic> close = tics_of(report::ValueAxis({30, 31, 32, 33, 500}, false).script(360.0));
  REQUIRE(close.size() == 5);
  CHECK(close[0].label == "30");
  for (std::size_t i = 1; i < 4; ++i) CHECK(close[i].label.empty());
  CHECK(close[4].label == "500");
  CHECK(close[2].at == 32.0);
}

TEST_CASE("many values have a few marks at 1, 2 or 5 times a power of ten, or at multiples of these") {
  std::vector<double> even, ratio;
  for (int i = 0; i < 30; ++i) {
    even.push_back(0.013 * i);
    ratio.push_back(5e-6 * std::pow(60.0, i / 29.0));
  }
  const std::vector<Tic> multiples = tics_of(report::ValueAxis(even, false).script(360.0));  // 0 to 0.377
  REQUIRE(multiples.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(multiples[i].at - 0.1 * static_cast<double>(i)) < 1e-9);
  const std::vector<Tic> ladder = tics_of(report::ValueAxis(ratio, true).script(360.0));  // 5e-6 to 3e-4
  REQUIRE(ladder.size() == 6);
  const std::vector<double> expected = {5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4};
  for (std::size_t i = 0; i < 6; ++i) CHECK(std::abs(ladder[i].at / expected[i] - 1.0) < 1e-6);
}

TEST_CASE("what belongs to one value stands beside it, in order, and nearer to it than to the next one") {
  for (const bool logarithmic : {false, true}) {
    const report::ValueAxis axis({1.0, 1.1, 9.0}, logarithmic);
    double before = 0.0, sum = 0.0;
    constexpr std::size_t kCount = 9;
    for (std::size_t i = 0; i < kCount; ++i) {
      const double at = axis.beside(1.0, i, kCount);
      CHECK(at > before);
      CHECK(at < 1.05);
      sum += logarithmic ? std::log(at) : at - 1.0;
      before = at;
    }
    CHECK(std::abs(sum) < 1e-12);
    CHECK(std::abs(axis.beside(9.0, 4, kCount) - 9.0) < 1e-12);
  }
}

TEST_CASE("small lengths are in micrometres where none is as long as 0.2 mm, else in millimetres") {
  CHECK(std::string(report::small_length_unit(1.9e-4).name) == "µm");
  CHECK(report::small_length_unit(1.9e-4).per_m == 1e6);
  CHECK(std::string(report::small_length_unit(2e-4).name) == "mm");
  CHECK(report::small_length_unit(2e-4).per_m == 1e3);
}

TEST_CASE("an outline keeps the ends and every spike") {
  std::vector<double> y(25000);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = std::sin(0.001 * static_cast<double>(i));
  y[12345] = 50.0;
  y[777] = -50.0;
  const std::vector<std::size_t> kept = outline(y, 600);
  CHECK(kept.size() <= 602);
  CHECK(kept.front() == 0);
  CHECK(kept.back() == y.size() - 1);
  CHECK(std::is_sorted(kept.begin(), kept.end()));
  CHECK(std::adjacent_find(kept.begin(), kept.end()) == kept.end());
  CHECK(std::count(kept.begin(), kept.end(), 12345u) == 1);
  CHECK(std::count(kept.begin(), kept.end(), 777u) == 1);
}

TEST_CASE("short series are kept whole") {
  const std::vector<double> y = {1.0, 2.0, 3.0};
  CHECK(outline(y, 600) == std::vector<std::size_t>{0, 1, 2});
  CHECK(outline(std::vector<double>{}, 600).empty());
  CHECK(every_nth(3, 10) == std::vector<std::size_t>{0, 1, 2});
  CHECK(every_nth(0, 10).empty());
}

TEST_CASE("thinning a cloud keeps its ends") {
  CHECK(every_nth(101, 3) == std::vector<std::size_t>{0, 50, 100});
}
