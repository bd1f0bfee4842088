/// The uses of random numbers in validate/: the words that separate one use's numbers from another's with the same
/// seed.
///
/// Every engine is std::mt19937_64. It is seeded by a seed sequence of the seed's two halves and, if present, a number
/// (of the track or case) and the use's word; without a seed, by the word itself. The draws for a given seed therefore
/// stay the same as long as these stay the same. Each use names the file that draws so.
///
/// A seed sequence of by_number has as many words as that of a use without a number. So numbers of tracks and cases
/// stay below the least of the uses' words, 0xB007 = 45063: then no two sequences are equal.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "render/random/random_numbers.h"

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
  twin_noise = 0x74776E6F,        ///< "twno" (recording_twin.h)
  twin_camera = 0x74776361,       ///< "twca": no number; clock and scale of a twin (recording_twin.h)
};

inline constexpr std::array kRandomUses = {
    RandomUse::by_number,   RandomUse::clock_rate, RandomUse::bootstrap,      RandomUse::everyday_case,
    RandomUse::filmed_case, RandomUse::challenge,  RandomUse::twin_remainder, RandomUse::twin_explanation,
    RandomUse::twin_noise,  RandomUse::twin_camera};
static_assert(render::all_distinct(kRandomUses), "two uses would draw the same random numbers");

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

/// The use's word alone: the same draws for every seed.
inline std::mt19937_64 random_engine(RandomUse use) {
  return std::mt19937_64(static_cast<std::uint64_t>(use));
}

/// The seed of replicate or film `number` of a seed: those of neighbouring seeds coincide only after a million numbers.
constexpr std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number) {
  return 1000003 * seed + number;
}

}  // namespace glidelab::validate
