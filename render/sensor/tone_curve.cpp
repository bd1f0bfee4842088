#include "render/sensor/tone_curve.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace glidelab::render {
namespace {

// ITU-R BT.709-6, item 1.2.
constexpr double kToe = 0.018;
constexpr double kToeSlope = 4.5;
constexpr double kScale = 1.099;
constexpr double kPower = 0.45;

/// Straight lines through points whose x rise.
double between_points(std::span<const double> from, std::span<const double> to, double x) {
  const auto after = std::upper_bound(from.begin() + 1, from.end() - 1, x) - from.begin();
  const auto i = static_cast<std::size_t>(after);
  return to[i - 1] + (x - from[i - 1]) / (from[i] - from[i - 1]) * (to[i] - to[i - 1]);
}

}  // namespace

double ToneCurve::operator()(double x) const {
  x = std::clamp(x, 0.0, 1.0);
  switch (kind) {
    case Kind::linear:
      return x;
    case Kind::gamma:
      return std::pow(x, 1.0 / gamma);
    case Kind::bt709:
      return x < kToe ? kToeSlope * x : kScale * std::pow(x, kPower) - (kScale - 1.0);
    case Kind::table:
      return between_points(from, to, x);
  }
  throw std::logic_error("unknown tone curve");
}

double ToneCurve::inverse(double y) const {
  y = std::clamp(y, 0.0, 1.0);
  switch (kind) {
    case Kind::linear:
      return y;
    case Kind::gamma:
      return std::pow(y, gamma);
    case Kind::bt709:
      return y < kToeSlope * kToe ? y / kToeSlope : std::pow((y + (kScale - 1.0)) / kScale, 1.0 / kPower);
    case Kind::table:
      return between_points(to, from, y);
  }
  throw std::logic_error("unknown tone curve");
}

const char* name_of(ToneCurve::Kind kind) {
  switch (kind) {
    case ToneCurve::Kind::linear:
      return "linear";
    case ToneCurve::Kind::gamma:
      return "gamma";
    case ToneCurve::Kind::bt709:
      return "bt709";
    case ToneCurve::Kind::table:
      return "table";
  }
  throw std::logic_error("unknown tone curve");
}

}  // namespace glidelab::render
