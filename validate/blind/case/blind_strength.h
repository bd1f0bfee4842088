/// How strongly an effect shows in the positions of a design, and how much of the gap of held-out clips something
/// makes.
///
/// The strength is the log likelihood that the right model gains on the nominal one fitted to the same positions,
/// without noise,
///
///     gain = |d - J (J'J)^-1 J'd|² / 2,       d = (seen with - seen without)/noise,
///
/// J the derivatives by K, mu, inclinations, masses, starts and what a calibration leaves open, with what is stated of
/// them as rows of its own.
///
/// The gap is by the same fit: with e the residual of a clip's noiseless positions over the noise and H that clip's
/// block of the projector on the columns of all parameters,
///
///     excess = g² - 1 = sum over clips of e' (I - H)^-1 e / number of positions,
///
/// which is the squared residual of the clip held out, its own start fitted to it, over the covariance of the
/// prediction (noise and what the other clips leave open of the parameters). What is stated takes part in the fit and
/// is not counted.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "validate/blind/case/blind_effects.h"

namespace glidelab::validate {

struct BlindPut {
  const BlindEffect* effect = nullptr;
  double size = 0.0;
};

/// The design outlives it.
class BlindDetection {
 public:
  explicit BlindDetection(const BlindDesign& design);
  ~BlindDetection();
  double gain(const BlindEffect& effect, double size) const;
  /// With something else that acts and is in the model already, to first order in its size.
  double gain_beside(const BlindPut& mine, const BlindPut& other) const;
  /// g² - 1 of a law that has the `known` effects in it, their sizes fitted too, on positions that the `acting` ones
  /// made. Nothing where the fit does not settle, or where no position is of a glider that moves.
  std::optional<double> excess(const std::vector<BlindPut>& acting, const std::vector<BlindPut>& known) const;
  /// The same to first order in all that acts, without a fit: good for small excesses, and fast. The positions of a
  /// known effect at its size are the direction that is fitted.
  double first_order_excess(const std::vector<BlindPut>& acting, const std::vector<BlindPut>& known) const;
  /// Of each frame of each clip, nominal.
  const std::vector<std::vector<double>>& speed_m_s() const { return speed_m_s_; }

 private:
  struct Fit;
  const BlindDesign& design_;
  std::unique_ptr<Fit> fit_;
  std::vector<std::vector<double>> speed_m_s_;
};

struct BlindStrength {
  double size = 0.0, gain = 0.0;
};

/// The size at which the effect gains what is wanted; nothing where its largest size does not come near it. A gain
/// grows about as the square of the size; where it does not (whole frames that are missing), the bracket halves.
std::optional<BlindStrength> size_for(const BlindDetection& detection, const BlindEffect& effect, double wanted);

}  // namespace glidelab::validate
