/// The list of smoothers; it names each once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/motion/smoothing/smoother.h"

namespace glidelab::core {

/// In the order in which they are shown; the first is the default.
const std::vector<const Smoother*>& smoothers();
std::vector<std::string> smoother_names();
/// Null if there is none of that name.
const Smoother* find_smoother(std::string_view name);

/// The default's name, the only one that takes a bandwidth.
inline constexpr std::string_view kLocalPolynomial = "local-polynomial";

/// InputError for an unknown name, and for a bandwidth, or a rule that chooses one, with a smoother that has none.
void check_smoother(const std::string& name, bool bandwidth_asked_for);

/// The local cubic of each part with its own points alone (local_polynomial.h), as one of the smoothers.
const Smoother& cubic_smoother();

}  // namespace glidelab::core
