#include "render/camera/frame_clock.h"

#include <cmath>

#include "render/random/random_numbers.h"

namespace glidelab::render {
namespace {

PhiloxCounter words_of(std::size_t slot, std::uint64_t seed, std::uint32_t stream) {
  return random_words(RandomPurpose::frame_clock, {static_cast<std::uint32_t>(slot), 0, stream}, philox_key(seed));
}

}  // namespace

FrameClock::FrameClock(const ClockSetup& setup, double frame_rate_hz, std::uint64_t seed, std::uint32_t stream)
    : setup_(setup), rate_hz_(frame_rate_hz), seed_(seed), stream_(stream) {}

double FrameClock::jitter_s(std::size_t slot) const {
  if (slot == 0 || setup_.jitter_s == 0.0) return 0.0;
  const PhiloxCounter words = words_of(slot, seed_, stream_);
  return setup_.jitter_s * static_cast<double>(normal_pair(words[0], words[1]).z0);
}

double FrameClock::between_s(std::size_t from, std::size_t to) const {
  const double even = (static_cast<double>(to) - static_cast<double>(from)) / true_rate_hz();
  return setup_.jitter_s == 0.0 ? even : even + jitter_s(to) - jitter_s(from);
}

double FrameClock::stamp_s(std::size_t slot) const {
  const double stamp = static_cast<double>(slot) / rate_hz_ + jitter_s(slot) * (1.0 + 1e-6 * setup_.rate_error_ppm);
  return setup_.stamp_tick_s == 0.0 ? stamp : std::round(stamp / setup_.stamp_tick_s) * setup_.stamp_tick_s;
}

FrameFate FrameClock::fate(std::size_t slot) const {
  const double out_of_order = setup_.dropped_fraction + setup_.duplicated_fraction;
  if (slot == 0 || out_of_order == 0.0) return FrameFate::recorded;
  const double u = uniform_of(words_of(slot, seed_, stream_)[2]);
  return u < setup_.dropped_fraction ? FrameFate::dropped
         : u < out_of_order          ? FrameFate::duplicated
                                     : FrameFate::recorded;
}

std::size_t FrameClock::frames_of(std::size_t slots) const {
  std::size_t frames = 0;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    if (fate(slot) != FrameFate::dropped) ++frames;
  }
  return frames;
}

}  // namespace glidelab::render
