#include "render/random/random_numbers.h"

#include <cmath>
#include <map>

#include "tests/catch.h"

using namespace glidelab::render;

TEST_CASE("purposes that would share random numbers are found, and the list has none") {
  CHECK(all_distinct(kRandomPurposes));
  CHECK_FALSE(
      all_distinct(std::array{RandomPurpose::frame_clock, RandomPurpose::fixed_pattern, RandomPurpose::frame_clock}));
  for (const RandomPurpose a : kRandomPurposes) {
    for (const RandomPurpose b : kRandomPurposes) {
      CHECK((random_words(a, {5, 0, 0}, {1, 2}) == random_words(b, {5, 0, 0}, {1, 2})) == (a == b));
    }
  }
}

TEST_CASE("the numbers of the purposes are those of all files rendered so far") {
  const PhiloxKey key = philox_key(7);
  CHECK(random_words(RandomPurpose::pixel_noise, {1, 2, 3}, key) == philox({1, 2, 3, 0}, key));
  CHECK(random_words(RandomPurpose::exact_pixel_noise, {1, 2, 3}, key) == philox({1, 2, 3, 1}, key));
  CHECK(random_words(RandomPurpose::fixed_pattern, {1, 0, 0}, key) == philox({1, 0, 0, 2}, key));
  CHECK(random_words(RandomPurpose::frame_clock, {1, 0, 3}, key) == philox({1, 0, 3, 3}, key));
  CHECK(random_words(RandomPurpose::pattern_poses, {1, 2, 0}, key) == philox({1, 2, 0, 4}, key));
}

// Known answers of Random123 (D. E. Shaw Research), tests/kat_vectors, the lines "philox4x32 10".
TEST_CASE("Philox4x32-10 gives the published known answers") {
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == PhiloxCounter{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u});
  constexpr std::uint32_t kOnes = 0xffffffffu;
  CHECK(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}) ==
        PhiloxCounter{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu});
  CHECK(philox({0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}, {0xa4093822u, 0x299f31d0u}) ==
        PhiloxCounter{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u});
}

TEST_CASE("Poisson numbers follow the distribution") {
  // Chi-square over the counts with 10 and more expected; its 99.99 % quantile for f degrees by Wilson and Hilferty:
  // f (1 - 2/(9f) + 3.72 sqrt(2/(9f)))³. Fixed seeds; five tests, so one in 2,000 such tests would fail by chance.
  const PoissonTable table(256);
  std::uint32_t stream = 0;
  for (const double mean : {0.0, 0.3, 1.0, 7.5, 100.25, 255.9}) {
    ++stream;
    constexpr int kDraws = 200'000;
    std::map<int, int> seen;
    for (std::uint32_t i = 0; i < kDraws; ++i) {
      const PhiloxCounter words = philox({i, stream, 0, 0}, {42, 0});
      ++seen[table.draw(mean, words[0], words[1])];
    }
    if (mean == 0.0) {
      CHECK(seen.size() == 1);
      CHECK(seen.begin()->first == 0);
      continue;
    }
    double chi2 = 0.0;
    int classes = 0;
    double rest_expected = kDraws;
    int rest_seen = kDraws;
    for (int k = 0; k < 600; ++k) {
      const double expected = kDraws * std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
      if (expected < 10.0) continue;
      const int count = seen.contains(k) ? seen.at(k) : 0;
      chi2 += (count - expected) * (count - expected) / expected;
      rest_expected -= expected;
      rest_seen -= count;
      ++classes;
    }
    if (rest_expected > 10.0) {
      chi2 += (rest_seen - rest_expected) * (rest_seen - rest_expected) / rest_expected;
      ++classes;
    }
    const double f = classes - 1;
    const double limit = f * std::pow(1.0 - 2.0 / (9.0 * f) + 3.72 * std::sqrt(2.0 / (9.0 * f)), 3);
    CAPTURE(mean, f);
    CHECK(chi2 < limit);
  }
}

TEST_CASE("The extreme words give the ends of the distribution, and no more") {
  const PoissonTable table(256);
  CHECK(table.draw(100.0, 0, 0) < 50);  // P(N < 50) = 5e-9, and the word stands for 1e-10
  CHECK(table.draw(100.0, 0xffffffffu, 0xffffffffu) < 180);
  CHECK(table.draw(255.999, 0xffffffffu, 0xffffffffu) < 400);
  CHECK(table.draw(0.5, 0xffffffffu, 0xffffffffu) < 20);
}
