/// From linear light to the codes of a video: what a camera does to the converter's codes before it writes them.
///
///     linear   y = x
///     gamma    y = x^(1 / gamma)
///     bt709    y = 4.5 x below 0.018, else 1.099 x^0.45 - 0.099       (ITU-R BT.709, the transfer of HD video)
///     table    straight lines between points that rise from (0, 0) to (1, 1)
///
/// x is the code above black over that of white, y likewise, both from 0 to 1.
#pragma once

#include <vector>

namespace glidelab::render {

struct ToneCurve {
  enum class Kind { linear, gamma, bt709, table };
  Kind kind = Kind::linear;
  double gamma = 2.2;             ///< of Kind::gamma
  std::vector<double> from = {};  ///< of Kind::table: x, rising from 0 to 1,
  std::vector<double> to = {};    ///< and y

  /// y of x; x is limited to 0 … 1.
  double operator()(double x) const;
  /// x of y; y is limited to 0 … 1.
  double inverse(double y) const;
};

const char* name_of(ToneCurve::Kind kind);

}  // namespace glidelab::render
