/// The uses of random numbers in validate/: the words that separate one use's numbers from another's with the same
/// seed.
///
/// Every engine is std::mt19937_64. It is seeded by a seed sequence of the seed's two halves and, if present, a number
/// (of the track or case) and the use's word. The draws for a given seed therefore stay the same as long as these stay
/// the same. Each use names the file that it was made for; recording_twin.h draws the noise of a twin's tracks by
/// number, and a twin's clock and scale as the clock of a replicate.
#pragma once

#include <cstdint>
#include <random>

namespace glidelab::validate {

enum class RandomUse : std::uint32_t {
  by_number = 0,                ///< no word: the noise of a track (made_tracks.h) and a clean blind case (blind_case.h)
  clock_rate = 0xC10C,          ///< no number: the clock of one replicate (interval_coverage.h)
  bootstrap = 0xB007,           ///< no user seed: resampled errors of a requirement (target.h)
  everyday_case = 0x65767279,   ///< "evry" (everyday_case.h)
  filmed_case = 0x66696C6D,     ///< "film" (blind_filmed_case.h)
  challenge = 0x63686C67,       ///< "chlg" (challenge_case.h)
  twin_remainder = 0x74777265,  ///< "twre" (recording_twin.h)
  twin_explanation = 0x74776578,  ///< "twex": no number (recording_twin.h)
};

/// {seed low, seed high, number}, followed by the use's word if it has one.
inline std::mt19937_64 random_engine(RandomUse use, std::uint64_t seed, std::uint64_t number) {
  const auto low = static_cast<std::uint32_t>(seed), high = static_cast<std::uint32_t>(seed >> 32);
  const auto which = static_cast<std::uint32_t>(number), word = static_cast<std::uint32_t>(use);
  if (use == RandomUse::by_number) {
    std::seed_seq sequence{low, high, which};
    return std::mt19937_64(sequence);
  }
  std::seed_seq sequence{low, high, which, word};
  return std::mt19937_64(sequence);
}

/// {seed low, seed high, the use's word}.
inline std::mt19937_64 random_engine(RandomUse use, std::uint64_t seed) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(use)};
  return std::mt19937_64(sequence);
}

/// The seed of replicate or film `number` of a seed: those of neighbouring seeds coincide only after a million numbers.
constexpr std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number) {
  return 1000003 * seed + number;
}

}  // namespace glidelab::validate
