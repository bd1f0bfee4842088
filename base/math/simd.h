/// Which vector instructions a loop takes where there is a choice.
#pragma once

namespace glidelab::base {

/// All give the same results to the last bit (tests of each loop compare them).
enum class Simd {
  best,      ///< the widest that this machine has
  baseline,  ///< what every machine of this architecture has
  portable   ///< none by name
};

/// Whether `simd` means AVX2 on this machine.
inline bool uses_avx2([[maybe_unused]] Simd simd) {
#if defined(__x86_64__)
  return simd == Simd::best && __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace glidelab::base
