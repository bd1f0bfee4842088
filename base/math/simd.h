/// Which vector instructions a loop uses where there is a choice.
#pragma once

namespace glidelab::base {

/// All choices give the same results to the last bit (tests of each loop compare them).
enum class Simd {
  best,      ///< the widest of this machine
  baseline,  ///< those that every machine of this architecture has
  portable   ///< none explicitly
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
