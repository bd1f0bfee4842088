/// The digits 0 to 9, independent of the locale.
#pragma once

namespace glidelab::base {

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace glidelab::base
