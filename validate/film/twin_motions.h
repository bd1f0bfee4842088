/// A twin compared with the data from which it was made: its exact motions, and the result of the data's analysis
/// applied to them with the same noise as the data.
///
/// Exact positions use the scenario's clock, except for lost frames and uneven times, which differ in every recording;
/// of the camera they include only a wrong scale and a wrong perspective. Smoothed with each clip's own bandwidth. SI
/// units.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"

namespace glidelab::validate {

struct TwinMotion {
  std::string clip;
  std::vector<double> t_s, rest_m;              ///< measured x minus the twin's
  std::vector<double> noise_m;                  ///< the same noise as the data, at the same times
  std::vector<double> v_m_s, a_m_s2;            ///< of the data, as analysed
  std::vector<double> twin_v_m_s, twin_a_m_s2;  ///< of the twin with that noise, analysed in the same way
};

/// `seed` draws the noise. InputError if no scenario can be read from the twin; NumericalError if a motion cannot be
/// simulated.
std::vector<TwinMotion> twin_motions(const diagnose::Diagnosis& diagnosis, std::uint64_t seed);

}  // namespace glidelab::validate
