/// An outside estimator as given by Python: a command and its limits.
#pragma once

#include <optional>
#include <string>

#include "fit/outside/outside_estimator.h"
#include "python/binding/watched_work.h"

namespace glidelab::python {

struct GivenEstimator {
  std::string command;
  std::string name;      ///< empty: from the command
  std::string function;  ///< that the command calls; empty: none
  double seconds = 0.0;
  double megabytes = 0.0;
};

/// Empty if there is none. An interrupt of the watched work ends the estimator's program. InputError as in
/// fit::outside_estimator().
std::optional<fit::OutsideEstimator> outside_of(const std::optional<GivenEstimator>& given, const WatchedWork& watched);

/// glidelab._glidelab.EstimatorCommand.
void bind_given_estimator(pybind11::module_& module);

}  // namespace glidelab::python
