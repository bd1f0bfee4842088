/// What version 1 of the challenge means: numbers of its cases, made once and kept here. Whoever changes them changes
/// the version (kChallengeVersion), for an answer to one set of cases says nothing about another.
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "base/math/angles.h"
#include "base/text/csv.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/challenge/challenge_case.h"

using namespace glidelab;
using namespace glidelab::validate;
namespace fs = std::filesystem;

namespace {

// Truths are rounded to ten digits, positions of easy and hard are written with all digits, and those of everyday to
// 10 nm: other machines round the last digits of a motion and of its noise differently, some 1e-12 of it, and a sum of
// hundreds of positions of order 1 m less than 1e-9.
constexpr double kToRounding = 1e-9;
constexpr double kGravity_m_s2 = 9.80665;

struct Clip {
  std::string name;
  std::size_t positions = 0;
  double first_m = 0.0, sum_m = 0.0, moment_m_s = 0.0;  ///< x of the first; sums of x and of t x
};

struct Known {
  double k_over_m_1_s = 0.0, mu = 0.0, alpha_deg = 0.0;
  std::optional<double> v_lim_m_s;
  std::vector<Clip> clips;
};

struct Series {
  std::vector<double> t_s, x_m;
};

Series positions(const fs::path& folder, const std::string& clip) {
  const base::CsvTable table = base::read_csv(folder / "tracks" / (clip + ".csv"), {"t_s", "x_m"});
  return {table.column("t_s"), table.column("x_m")};
}

bool same(double value, double known) {
  return std::abs(value - known) <= kToRounding * std::abs(known);
}

void check_case(ChallengeLevel level, const std::vector<Known>& known) {
  const tests::TempDir temp;
  const fs::path folder = temp / "case";
  const std::vector<ChallengeConfiguration> truth = make_challenge_case(level, 1, 0, folder);
  REQUIRE(truth.size() == known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    CHECK(same(truth[i].k_over_m_1_s.value(), known[i].k_over_m_1_s));
    CHECK(same(truth[i].mu.value(), known[i].mu));
    CHECK(same(truth[i].alpha_deg.value(), known[i].alpha_deg));
    REQUIRE(truth[i].v_lim_m_s.has_value() == known[i].v_lim_m_s.has_value());
    if (known[i].v_lim_m_s) CHECK(same(*truth[i].v_lim_m_s, *known[i].v_lim_m_s));
    REQUIRE(truth[i].clips.size() == known[i].clips.size());
    for (std::size_t c = 0; c < known[i].clips.size(); ++c) {
      const Clip& clip = known[i].clips[c];
      INFO(clip.name);
      CHECK(truth[i].clips[c] == clip.name);
      const Series read = positions(folder, clip.name);
      REQUIRE(read.x_m.size() == clip.positions);
      CHECK(same(read.x_m.front(), clip.first_m));
      CHECK(same(std::accumulate(read.x_m.begin(), read.x_m.end(), 0.0), clip.sum_m));
      CHECK(same(std::inner_product(read.x_m.begin(), read.x_m.end(), read.t_s.begin(), 0.0), clip.moment_m_s));
    }
  }
}

const Known kEasy = {1.823744316,
                     0.009405899488,
                     3.442322799,
                     0.2723813281,
                     {{"up-1", 500, 0.8246865558786647, 247.58789591964617, 316.6680336621979},
                      {"down-1", 500, -1.0592636896267928, -273.11276486013446, -252.19139263770035},
                      {"up-2", 500, 0.40683804871189017, 164.206241339153, 236.1891064493167},
                      {"down-2", 500, -1.0077334850659465, -155.40297340688818, -86.6829774381284}}};
const Known kHard = {0.5981704822,
                     0.02881808859,
                     3.143283954,
                     0.4272121126,
                     {{"up-1", 58, 0.41917161641036066, -11.118018170134404, -16.142991401076287},
                      {"down-1", 60, -0.8185214920517792, -11.320750881072293, 0.9200808050941846}}};
const std::vector<Known> kEveryday = {{0.5111854692,
                                       0.02334341048,
                                       -0.1045530436,
                                       std::nullopt,
                                       {{"level-m1-up", 300, 0.52285158, 64.16770038999998, 24.181615977431715},
                                        {"level-m1-down", 300, -0.5660115, -102.05286010999995, -52.74031297532887}}},
                                      {0.3477310524,
                                       0.02277798863,
                                       -0.1045530436,
                                       std::nullopt,
                                       {{"level-m2-up", 300, 0.38412327, 46.90681586999999, 17.568021282166313},
                                        {"level-m2-down", 300, -0.60177258, -35.28508299, 4.378211476989616}}}};

}  // namespace

TEST_CASE("version 1 of the challenge has these cases") {
  REQUIRE(kChallengeVersion == 1);
  check_case(ChallengeLevel::easy, {kEasy});
  check_case(ChallengeLevel::hard, {kHard});
  check_case(ChallengeLevel::everyday, kEveryday);
}

TEST_CASE("the numbers that are kept of the challenge are those of its law") {
  for (const Known& one : {kEasy, kHard}) {
    // v' = 0 downhill. The truths have ten digits, and the difference of the two terms loses less than one.
    const double alpha = one.alpha_deg * base::kRadPerDegree;
    const double v_lim = kGravity_m_s2 * (std::sin(alpha) - one.mu * std::cos(alpha)) / one.k_over_m_1_s;
    CHECK(std::abs(v_lim - one.v_lim_m_s.value()) < 1e-8 * v_lim);
  }
  // One glider with two masses on it: K is one. Masses as stated, which this case has right.
  CHECK(std::abs(kEveryday[0].k_over_m_1_s * 0.334 - kEveryday[1].k_over_m_1_s * 0.491) < 1e-9);

  // A motion downhill is x0 + v_lim t + (v0 - v_lim) (1 - exp(-kt))/k. With the truth known, its positions are off the
  // line through (1 - exp(-kt))/k by the level's 0.02 mm: 500 of them give that within 3.2 %, taken five times.
  const tests::TempDir temp;
  make_challenge_case(ChallengeLevel::easy, 1, 0, temp / "case");
  for (const std::string clip : {"down-1", "down-2"}) {
    const Series read = positions(temp / "case", clip);
    double n = 0.0, s = 0.0, y = 0.0, ss = 0.0, sy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < read.t_s.size(); ++i) {
      const double along = (1.0 - std::exp(-kEasy.k_over_m_1_s * read.t_s[i])) / kEasy.k_over_m_1_s;
      const double left = read.x_m[i] - kEasy.v_lim_m_s.value() * read.t_s[i];
      n += 1.0;
      s += along;
      y += left;
      ss += along * along;
      sy += along * left;
      yy += left * left;
    }
    const double slope = (n * sy - s * y) / (n * ss - s * s);
    const double rms = std::sqrt((yy - y * y / n - slope * (sy - s * y / n)) / (n - 2.0));
    INFO(clip);
    CHECK(std::abs(rms / 2e-5 - 1.0) < 0.16);
  }
}

TEST_CASE("version 1 of the challenge has this film", "[slow]") {
  const tests::TempDir temp;
  const std::vector<ChallengeConfiguration> truth = make_challenge_case(ChallengeLevel::camera, 2, 0, temp / "case");
  REQUIRE(truth.size() == 1);
  CHECK(same(truth[0].k_over_m_1_s.value(), 2.499579504));
  CHECK(same(truth[0].mu.value(), 0.007661851974));
  CHECK(same(truth[0].alpha_deg.value(), 2.807368652));
  CHECK(same(truth[0].v_lim_m_s.value(), 0.1621334173));
  const Series up = positions(temp / "case", "up-1");
  REQUIRE(up.x_m.size() == 300);
  // Measured in images whose grey values another machine may round differently, one in many thousands of them: a
  // marker of some hundred pixels moves by less than a thousandth of its noise, which is some 0.02 mm.
  CHECK(std::abs(up.x_m.front() - 0.44139731702183793) < 1e-6);
  // Here, and again, they are the same bits.
  make_challenge_case(ChallengeLevel::camera, 2, 0, temp / "again");
  for (const char* clip : {"up-1", "down-1"}) {
    CHECK(positions(temp / "again", clip).x_m == positions(temp / "case", clip).x_m);
  }
}
