#include "report/analysis/statement_words.h"

#include <fmt/format.h>

#include <cmath>

#include "base/text/number_text.h"
#include "core/result/uphill.h"

namespace glidelab::report {
namespace {

std::string with_sd(double deg, double sd_deg) {
  return base::value_and_sd_text(deg, sd_deg) + "°";
}

}  // namespace

std::string contradiction_words(const core::InclineContradiction& of) {
  const core::StatedIncline& stated = of.stated;
  const std::string says =
      fmt::format("{} says {}", stated.by,
                  stated.sd_deg ? with_sd(stated.deg, *stated.sd_deg) : fmt::format("{:.3g}°", stated.deg + 0.0));
  if (of.beyond_gravity) {
    return fmt::format("the acceleration, {:.3g} m/s² without friction, is more than gravity_m_s2 = {:.6g}; {}",
                       *of.beyond_gravity, of.gravity_m_s2, says);
  }
  const char* bound = of.bound == 0 ? "" : of.bound < 0 ? "at most " : "at least ";
  return fmt::format("the acceleration gives an inclination of {}{}, but {}", bound, with_sd(of.deg, of.sd_deg), says);
}

std::string contradiction_causes(const core::InclineContradiction& of) {
  if (core::seems_uphill(of)) return "x seems to be positive uphill, and has to rise downhill";
  if (of.gross || !of.stated.sd_deg) return "an angle, a length, the frame rate or gravity_m_s2 is wrong";
  return "an angle or its uncertainty, a length, the frame rate or gravity_m_s2 is wrong; a wrong length also makes "
         "the terminal velocity wrong, a wrong rate K/m too";
}

std::string slow_fall_words(const core::SlowFall& fall) {
  const core::Estimate& a0 = fall.a0_m_s2;
  const double ratio = fall.gravity_m_s2 / a0.value;
  const bool known = a0.value > 3.0 * a0.sd;  // otherwise it is hardly above zero, and no factor follows
  const auto times = [&](double factor) {
    return known ? fmt::format(" ({} times)", base::number_text(factor, 2)) : std::string();
  };
  constexpr double kSlowest = 20.0;  // playback
  const std::string slow = known && std::sqrt(ratio) > kSlowest
                               ? ""
                               : "the times may be those of a slow-motion playback" + times(std::sqrt(ratio)) + ", ";
  return fmt::format(
      "the line of this fall begins with {} m/s² at v = 0, far below gravity. The body may have reached its final "
      "speed before it was seen, a hand may have held it, a liquid may carry most of its weight, {}or x may be in a "
      "larger unit than stated{}",
      base::value_and_sd_text(a0.value, a0.sd), slow, times(ratio));
}

}  // namespace glidelab::report
