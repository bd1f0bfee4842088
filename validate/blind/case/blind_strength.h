/// How strongly an effect shows in the positions of a design: the log likelihood that the right model gains on the
/// nominal one fitted to the same positions, without noise,
///
///     gain = |d - J (J'J)^-1 J'd|² / 2,       d = (seen with - seen without)/noise,
///
/// J the derivatives by K, mu, inclinations, masses, starts and what a calibration leaves open, with what is stated of
/// them as rows of its own.
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
