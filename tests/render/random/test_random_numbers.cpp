#include "render/random/random_numbers.h"

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
