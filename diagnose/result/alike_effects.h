/// Effects that these data cannot tell apart, as one set: which effects are in it, and how likely it is that one of
/// them acts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// An explanation that names effects and nothing else.
struct NamedExplanation {
  std::vector<std::string> ids;
  double probability = 0.0;
};

/// Fills `alike` and `joint_probability` of each effect of a diagnosis that has its `equivalent_to`: the sum over all
/// explanations that hold it or one of those, each counted once. `words` says what an id is for a person.
void join_alike(const std::vector<NamedExplanation>& explanations,
                const std::function<std::string(const std::string& id)>& words, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
