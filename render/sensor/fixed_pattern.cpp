#include "render/sensor/fixed_pattern.h"

#include <algorithm>
#include <cmath>

#include "render/random/normal_pair.h"
#include "render/random/streams.h"

namespace glidelab::render {

FixedPattern make_fixed_pattern(const PixelSpread& spread, double exposure_s, std::uint64_t seed, int width,
                                int height) {
  const PhiloxKey key = philox_key(seed);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  const auto dark_e = static_cast<float>(spread.dark_signal_e_s * exposure_s);
  FixedPattern pattern{width, height, std::vector<float>(pixels), std::vector<float>(pixels, dark_e),
                       std::vector<float>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const PhiloxCounter words = random_words(RandomPurpose::fixed_pattern, {static_cast<std::uint32_t>(i), 0, 0}, key);
    const auto [z1, z2] = normal_pair(words[0], words[1]);
    pattern.response[i] = std::max(0.0f, 1.0f + static_cast<float>(spread.prnu) * z1);
    pattern.offset_e[i] = static_cast<float>(spread.dsnu_e) * z2;
    const double hot = uniform_of(words[2]);
    if (hot < spread.hot_fraction) {
      // Below the fraction the word is uniform again, so minus its logarithm is exponential of mean 1.
      const double signal_e_s = -std::log(hot / spread.hot_fraction) * spread.hot_signal_e_s;
      pattern.dark_e[i] += static_cast<float>(signal_e_s * exposure_s);
    }
    if (uniform_of(words[3]) < spread.dead_fraction) pattern.response[i] = 0.0f;
  }
  return pattern;
}

}  // namespace glidelab::render
