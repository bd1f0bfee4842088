/// Which effects an experiment will be able to tell apart, before anything is recorded.
///
/// Every effect that displaces positions in one direction (in the space of all positions, over their noise, with
/// everything that a fit may change projected out) has a size that makes one standard deviation, and a cosine with any
/// other. Only the planned motions and their noise enter, not measured residuals.
#pragma once

#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct PlannedEffect {
  std::string id;
  std::string words;
  std::string key;                 ///< of its size, with the unit
  double seen_from = 0.0;          ///< size of four standard deviations; for n and s the deviation from 1
  bool seen = false;               ///< the largest size that is considered reaches that, and a diagnosis may name it
  std::vector<std::string> alike;  ///< those whose cosine with it is kAlike or more
};

struct Plan {
  std::vector<PlannedEffect> effects;
  Isolability isolability;  ///< of those that can be seen
  double noise_m = 0.0;     ///< mean over the motions
  std::size_t clips = 0, points = 0;
  std::vector<Note> notes;
};

/// The plan for motions that were analysed: planned ones (a simulation) or recorded ones. InputError if nothing moves
/// freely.
Plan plan_of(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups);

}  // namespace glidelab::diagnose
