/// One line for each direction through the points of all clips of a configuration.
#pragma once

#include <vector>

#include "core/analysis/analyze_motion.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"

namespace glidelab::core {

/// A clip of a configuration; both outlive it.
struct MemberClip {
  const ClipSetup* setup;
  const ClipResult* clip;
};

/// Whether the clips' lines keep the kernel's bias of a line that follows its own law, or have it taken off
/// (law_bias.h).
enum class LawBiasIs { kept, taken_off };

/// At most one line for each direction, v < 0 first: least squares through the points of all members. Their noise is
/// independent, and what they share (LineUncertainty) adds up signed. Lines that scatter about the joint one by more
/// than their uncertainty allows widen it.
std::vector<LineFit> join_lines(const std::vector<MemberClip>& members, LineMethod lines, LawBiasIs bias);

}  // namespace glidelab::core
