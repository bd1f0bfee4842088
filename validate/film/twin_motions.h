/// A twin compared with the data that it was made from: its exact motions, and the result of the data's analysis
/// applied to them with as much noise as the data have.
///
/// Exact positions: the scenario's clock but for lost frames and uneven times, which fall elsewhere in every recording;
/// of the camera a wrong scale and a wrong perspective, no more. Smoothed with each clip's own bandwidth. SI units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"

namespace glidelab::validate {

struct TwinMotion {
  std::string clip;
  std::vector<double> t_s, rest_m;              ///< measured x less the twin's
  std::vector<double> noise_m;                  ///< as much noise as the data have, at the same times
  std::vector<double> v_m_s, a_m_s2;            ///< of the data, as analysed
  std::vector<double> twin_v_m_s, twin_a_m_s2;  ///< of the twin with that noise, analysed alike
};

/// `seed` draws the noise. InputError if no scenario can be read from the twin; NumericalError if a motion cannot be
/// simulated.
std::vector<TwinMotion> twin_motions(const diagnose::Diagnosis& diagnosis, std::uint64_t seed);

}  // namespace glidelab::validate
