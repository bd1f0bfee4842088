#include "report/html/plot.h"

#include <algorithm>
#include <cmath>

#include "tests/catch.h"

using namespace glidelab::report;

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
